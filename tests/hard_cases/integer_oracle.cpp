#include "hard_cases/integer_oracle.h"

#include "core/pixel_index.h"
#include "hard_cases/random_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace ssrlab::test {
namespace {

__extension__ using Wide = __int128;

/// n / d of the way along the ray; d > 0, or 0 for never.
struct Crossing {
    int64_t n = 0, d = 0;
};

bool before_or_with(Crossing a, Crossing b) { return a.d != 0 && (b.d == 0 || Wide(a.n) * b.d <= Wide(b.n) * a.d); }
bool beyond_end(Crossing a) { return a.d == 0 || a.n >= a.d; }

struct Axis {
    int64_t origin, delta; // in 1/256 px

    Crossing of_border(int64_t border) const
    {
        if (delta == 0) return {};
        const int64_t way = border * px_steps - origin;
        return delta > 0 ? Crossing{way, delta} : Crossing{-way, -delta};
    }
    int      step() const { return delta > 0 ? 1 : delta < 0 ? -1 : 0; }
    Crossing leaves(int pixel) const { return of_border(delta > 0 ? pixel + 1 : pixel); }
};

int64_t exact(double value, int steps)
{
    const double scaled = value * steps;
    if (scaled != std::round(scaled)) throw std::logic_error("integer_oracle: a number is not a multiple of its step");
    return static_cast<int64_t>(scaled);
}

/// z(n/d) * d in depth steps.
Wide depth_times_d(int64_t origin, int64_t delta, Crossing at) { return Wide(origin) * at.d + Wide(delta) * at.n; }

} // namespace

OracleAnswer integer_oracle(const GBufferImage& gbuffer, const RayInput& ray)
{
    const std::array<Axis, 2> axes = {
        Axis{exact(ray.origin_px_depth.x, px_steps), exact(ray.delta_px_depth.x, px_steps)},
        Axis{exact(ray.origin_px_depth.y, px_steps), exact(ray.delta_px_depth.y, px_steps)}};
    const int64_t origin_z = exact(ray.origin_px_depth.z, depth_steps),
                  delta_z  = exact(ray.delta_px_depth.z, depth_steps);
    const glm::ivec2 size  = gbuffer.view.size_px;
    glm::ivec2       pixel = glm::min(glm::ivec2(axes[0].origin / px_steps, axes[1].origin / px_steps), size - 1);

    Crossing x = axes[0].leaves(pixel.x), y = axes[1].leaves(pixel.y);
    Crossing at = before_or_with(x, y) ? x : y;
    while (!beyond_end(at)) {
        if (before_or_with(x, at)) pixel.x += axes[0].step();
        if (before_or_with(y, at)) pixel.y += axes[1].step();
        if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y) break;
        x            = axes[0].leaves(pixel.x);
        y            = axes[1].leaves(pixel.y);
        Crossing out = before_or_with(x, y) ? x : y;
        if (beyond_end(out)) out = {1, 1};
        const auto front = static_cast<int64_t>(gbuffer.depth[pixel_index(pixel, size)] * depth_steps);
        if (front > 0) {
            const Wide z_in = depth_times_d(origin_z, delta_z, at), z_out = depth_times_d(origin_z, delta_z, out);
            const bool in_front_of_back = 2 * z_in >= Wide(front) * at.d || 2 * z_out >= Wide(front) * out.d;
            const bool behind_front     = z_in <= Wide(front) * at.d || z_out <= Wide(front) * out.d;
            if (in_front_of_back && behind_front) return {true, pixel};
        }
        at = out;
    }
    return {};
}

bool passes_through_a_corner(const RayInput& ray, glm::ivec2 pixel)
{
    const Axis x{exact(ray.origin_px_depth.x, px_steps), exact(ray.delta_px_depth.x, px_steps)},
        y{exact(ray.origin_px_depth.y, px_steps), exact(ray.delta_px_depth.y, px_steps)};
    for (const int right : {0, 1})
        for (const int below : {0, 1})
            if (Wide((pixel.x + right) * int64_t(px_steps) - x.origin) * y.delta ==
                Wide((pixel.y + below) * int64_t(px_steps) - y.origin) * x.delta)
                return true;
    return false;
}

} // namespace ssrlab::test
