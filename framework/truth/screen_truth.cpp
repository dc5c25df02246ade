#include "truth/screen_truth.h"

#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "truth/pixel_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Border crossings along one axis: T(border) = (border - origin) * inverse.
struct Axis {
    double origin;
    double inverse = 0;
    double step    = 0; // -1, 0 or 1
    double border  = 0; // the next one
    double t_next  = infinity;
    double t_exit  = infinity; // where the ray crosses the image's border

    Axis(double origin_px, double delta_px, int start_pixel, int size_px) : origin(origin_px)
    {
        // A component so small that its inverse overflows crosses nothing either.
        if (delta_px == 0 || !std::isfinite(1.0 / delta_px)) return;
        inverse = 1.0 / delta_px;
        step    = delta_px > 0 ? 1 : -1;
        border  = delta_px > 0 ? start_pixel + 1 : start_pixel;
        t_next  = (border - origin) * inverse;
        t_exit  = ((delta_px > 0 ? size_px : 0) - origin) * inverse;
    }
};

void store(const WalkResult& found, size_t i, TraceImage& result)
{
    result.status[i]       = found.status;
    result.steps[i]        = found.pixels;
    result.hit_pixel[i]    = found.hit_pixel;
    result.hit_layer[i]    = static_cast<uint8_t>(found.hit_layer);
    result.hit_px_depth[i] = found.hit_px_depth;
    result.hit_t[i]        = found.hit_t;
}

/// The depths that a pixel's surface can be met at, rounded outward: [nearest, farthest].
std::pair<double, double> depth_range(const PixelSurface& surface)
{
    // A ray's position may leave the pixel by its rounding.
    const double reach = (0.5 + 1e-9) * (std::abs(surface.gradient.x) + std::abs(surface.gradient.y));
    double       back  = std::min(surface.back - reach, surface.solid_back);
    if (surface.far_side) {
        const glm::dvec2 gradient = glm::abs(surface.far_side->gradient);
        back                      = std::min(back, surface.far_side->depth - (0.5 + 1e-9) * (gradient.x + gradient.y));
    }
    return {surface.front + reach, back};
}

} // namespace

ScreenWalk::ScreenWalk(const GBufferImage& gbuffer, const TraceSettings& settings)
    : gbuffer_(gbuffer), settings_(settings), cells_(gbuffer.depth.size())
{
    require_complete(gbuffer);
    require_surface(gbuffer, settings);
    constexpr float infinite = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < cells_.size(); ++i) {
        cells_[i] = {-infinite, infinite};
        for (int layer = 0; layer < layer_count(gbuffer, settings); ++layer) {
            const auto surface = pixel_surface(gbuffer, layer, i, settings);
            if (!surface) continue;
            const auto [nearest, farthest] = depth_range(*surface);
            cells_[i].front                = std::max(cells_[i].front, std::nextafter(float(nearest), infinite));
            cells_[i].back                 = std::min(cells_[i].back, std::nextafter(float(farthest), -infinite));
        }
    }
}

/// What the ray meets there, and how it ends if it ends there. False: it goes on.
bool ScreenWalk::ends_at(size_t index, const RayPart& part, glm::dvec3 direction_vs, WalkResult& found) const
{
    Meeting first{.t = infinity};
    for (int layer = 0; layer < layer_count(gbuffer_, settings_); ++layer) {
        const GBufferImage& image   = layer_of(gbuffer_, layer);
        const auto          surface = pixel_surface(gbuffer_, layer, index, settings_);
        if (!surface) continue;
        const Meeting meeting = meet(*surface, part, glm::dot(glm::dvec3(image.normal_vs[index]), direction_vs));
        const bool    passes  = meeting.from_behind && settings_.behind == Behind::pass;
        if (meeting.meets && passes) found.status = TraceStatus::facing_away;
        if (!meeting.meets || passes || meeting.t >= first.t) continue;
        first           = meeting;
        found.hit_layer = layer;
    }
    if (!first.meets) return false;
    const bool stops   = first.from_behind && settings_.behind == Behind::stop;
    found.status       = stops ? TraceStatus::stopped : TraceStatus::hit;
    found.hit_pixel    = pixel_at(index, gbuffer_.view.size_px);
    found.hit_t        = first.t;
    found.hit_px_depth = part.at(first.t);
    const glm::dvec2 low(found.hit_pixel);
    found.hit_px_depth.x = std::clamp(found.hit_px_depth.x, low.x, low.x + 1);
    found.hit_px_depth.y = std::clamp(found.hit_px_depth.y, low.y, low.y + 1);
    return true;
}

WalkResult ScreenWalk::walk(const ScreenRay& ray) const
{
    WalkResult found;
    found.status = ray.end_status;
    if (!ray.traced) return found;

    const glm::ivec2 size = gbuffer_.view.size_px;
    Axis             x(ray.origin_px_depth.x, ray.delta_px_depth.x, ray.start_pixel.x, size.x);
    Axis             y(ray.origin_px_depth.y, ray.delta_px_depth.y, ray.start_pixel.y, size.y);
    const double     t_end  = std::min({1.0, x.t_exit, y.t_exit});
    const double     z0     = ray.origin_px_depth.z;
    const double     dz     = ray.delta_px_depth.z;
    const ptrdiff_t  x_jump = ptrdiff_t(x.step);
    const ptrdiff_t  y_jump = ptrdiff_t(y.step) * size.x;

    ptrdiff_t index = ptrdiff_t(ray.start_pixel.y) * size.x + ray.start_pixel.x;
    double    t_in  = std::min(x.t_next, y.t_next);
    double    z_in  = z0 + t_in * dz;
    while (t_in < t_end) {
        // Both axes step at an exact corner. Arithmetic instead of branches: which border is next is unpredictable.
        const bool cross_x = x.t_next <= t_in;
        const bool cross_y = y.t_next <= t_in;
        index += (cross_x ? x_jump : 0) + (cross_y ? y_jump : 0);
        x.border += cross_x ? x.step : 0;
        y.border += cross_y ? y.step : 0;
        x.t_next = x.step != 0 ? (x.border - x.origin) * x.inverse : infinity;
        y.t_next = y.step != 0 ? (y.border - y.origin) * y.inverse : infinity;

        const double t_out = std::min({x.t_next, y.t_next, 1.0});
        const double z_out = z0 + t_out * dz;
        const Cell   cell  = cells_[size_t(index)];
        ++found.pixels;
        if (std::min(z_in, z_out) <= double(cell.front) && std::max(z_in, z_out) >= double(cell.back) &&
            ends_at(size_t(index), {ray.origin_px_depth, ray.delta_px_depth, t_in, t_out}, ray.direction_vs, found))
            return found;
        t_in = t_out;
        z_in = z_out;
    }
    return found;
}

TraceImage screen_truth(const GBufferImage& gbuffer, const TraceSettings& settings, unsigned threads)
{
    const ScreenWalk walk(gbuffer, settings);
    const glm::ivec2 size   = gbuffer.view.size_px;
    TraceImage       result = make_trace_image(size, false);
    parallel_rows(size.y, threads, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            store(walk.walk(make_screen_ray(gbuffer, {x, y}, settings)), pixel_index({x, y}, size), result);
        }
    });
    return result;
}

} // namespace ssrlab
