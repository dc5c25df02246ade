#include "truth/screen_truth.h"

#include "core/parallel_rows.h"
#include "core/pixel_index.h"

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

void store(const WalkResult& found, size_t i, TraceResult& result)
{
    result.status[i]       = found.status;
    result.steps[i]        = found.pixels;
    result.hit_pixel[i]    = found.hit_pixel;
    result.hit_px_depth[i] = found.hit_px_depth;
    result.hit_t[i]        = found.hit_t;
}

/// Where the ray, entering the pixel at t_in, first meets the slab.
double first_contact_t(const ScreenRay& ray, double t_in, double t_out, double front, double back)
{
    const double z0   = ray.origin_px_depth.z;
    const double dz   = ray.delta_px_depth.z;
    const double z_in = z0 + t_in * dz;
    if (z_in <= front && z_in >= back) return t_in;
    const double face = z_in > front ? front : back;
    return dz == 0 ? t_in : std::clamp((face - z0) / dz, t_in, t_out);
}

} // namespace

double slab_back(const View& view, double depth, const TraceSettings& settings)
{
    const double thickness = settings.thickness_m;
    // Written as depth / (1 + ...) because that is exactly `depth` when the thickness is 0.
    if (view.projection == Projection::perspective) {
        return depth / (1.0 + (settings.thickness_relative ? thickness : thickness * depth / view.near_m));
    }
    const double thickness_m = settings.thickness_relative ? thickness * depth_to_distance(view, depth) : thickness;
    return depth - thickness_m / (view.far_m - view.near_m);
}

ScreenWalk::ScreenWalk(const GBufferImage& gbuffer, const TraceSettings& settings)
    : gbuffer_(gbuffer), settings_(settings), cells_(gbuffer.depth.size())
{
    require_complete(gbuffer);
    for (size_t i = 0; i < cells_.size(); ++i) {
        const float depth = gbuffer.depth[i];
        if (!(depth > 0) || !std::isfinite(depth)) {
            cells_[i] = {-std::numeric_limits<float>::infinity(), 0};
        } else {
            const auto back = float(exact_back(i));
            cells_[i]       = {depth, std::nextafter(back, -std::numeric_limits<float>::infinity())};
        }
    }
}

double ScreenWalk::exact_back(size_t index) const
{
    return slab_back(gbuffer_.view, double(gbuffer_.depth[index]), settings_);
}

bool ScreenWalk::faces_ray(size_t index, glm::dvec3 direction_vs) const
{
    return glm::dot(glm::dvec3(gbuffer_.normal_vs[index]), direction_vs) < 0;
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
        if (std::min(z_in, z_out) <= double(cell.front) && std::max(z_in, z_out) >= double(cell.back)) {
            const double back = exact_back(size_t(index));
            if (std::max(z_in, z_out) >= back) {
                if (settings_.behind == Behind::hit || faces_ray(size_t(index), ray.direction_vs)) {
                    found.status       = TraceStatus::hit;
                    found.hit_pixel    = pixel_at(size_t(index), size);
                    found.hit_t        = first_contact_t(ray, t_in, t_out, double(cell.front), back);
                    found.hit_px_depth = ray.origin_px_depth + found.hit_t * ray.delta_px_depth;
                    const glm::dvec2 low(found.hit_pixel);
                    found.hit_px_depth.x = std::clamp(found.hit_px_depth.x, low.x, low.x + 1);
                    found.hit_px_depth.y = std::clamp(found.hit_px_depth.y, low.y, low.y + 1);
                    return found;
                }
                found.status = settings_.behind == Behind::pass ? TraceStatus::facing_away : TraceStatus::stopped;
                if (settings_.behind == Behind::stop) return found;
            }
        }
        t_in = t_out;
        z_in = z_out;
    }
    return found;
}

TraceResult screen_truth(const GBufferImage& gbuffer, const TraceSettings& settings, unsigned threads)
{
    const ScreenWalk walk(gbuffer, settings);
    const glm::ivec2 size   = gbuffer.view.size_px;
    TraceResult      result = make_trace_result(size, false);
    parallel_rows(size.y, threads, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            store(walk.walk(make_screen_ray(gbuffer, {x, y}, settings)), pixel_index({x, y}, size), result);
        }
    });
    return result;
}

} // namespace ssrlab
