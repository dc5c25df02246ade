#include "contract/disputed_rays.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "test.h"
#include "truth/screen_truth.h"

namespace ssrlab::test {
namespace {

/// Where the ray is inside a pixel's square; t_in > t_out: it passes outside.
struct Overlap {
    double t_in = 0, t_out = 1;
};

Overlap overlap(const ScreenRay& ray, glm::ivec2 pixel)
{
    Overlap inside;
    for (int axis : {0, 1}) {
        const double origin = ray.origin_px_depth[axis], delta = ray.delta_px_depth[axis];
        if (delta == 0) continue;
        const double a = (pixel[axis] - origin) / delta, b = (pixel[axis] + 1 - origin) / delta;
        inside.t_in  = std::max(inside.t_in, std::min(a, b));
        inside.t_out = std::min(inside.t_out, std::max(a, b));
    }
    return inside;
}

/// How far the pixel's square may shrink until the ray no longer meets it; negative: how far it must grow to be met.
double depth_inside_px(const ScreenRay& ray, glm::ivec2 pixel)
{
    // The distance to the nearest side is concave along the ray.
    const auto inside = [&](double t) {
        const glm::dvec2 p = glm::dvec2(ray.origin_px_depth) + t * glm::dvec2(ray.delta_px_depth) - glm::dvec2(pixel);
        return std::min({p.x, p.y, 1 - p.x, 1 - p.y});
    };
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        (inside(a) < inside(b) ? low : high) = inside(a) < inside(b) ? a : b;
    }
    return inside(0.5 * (low + high));
}

/// The last place of a float of this size.
double ulp(double value)
{
    const auto rounded = static_cast<float>(std::abs(value));
    return static_cast<double>(std::nextafter(rounded, std::numeric_limits<float>::infinity()) - rounded);
}

/// The pixel that one of the two takes and the other passes: the first of their hits; where the ray reaches both at a corner, the one that it
/// barely touches.
glm::ivec2 disputed_pixel(const ScreenRay& ray, const Answer& truth, const Answer& found, double rounding_px)
{
    if (truth.status != TraceStatus::hit) return found.hit_pixel;
    if (found.status != TraceStatus::hit) return truth.hit_pixel;
    const glm::ivec2 a = truth.hit_pixel, b = found.hit_pixel;
    const double apart = (overlap(ray, a).t_in - overlap(ray, b).t_in) * glm::length(glm::dvec2(ray.delta_px_depth));
    const bool   at_corner = std::abs(apart) <= rounding_px;
    return (at_corner ? depth_inside_px(ray, a) < depth_inside_px(ray, b) : apart < 0) ? a : b;
}

} // namespace

Dispute explain_dispute(const GBufferImage& gbuffer, const TraceSettings& settings, const ScreenRay& ray,
                        const Answer& truth, const Answer& found)
{
    const glm::ivec2 size      = gbuffer.view.size_px;
    const double     length_px = glm::length(glm::dvec2(ray.delta_px_depth));
    Dispute          dispute;
    const bool       truth_hits = truth.status == TraceStatus::hit, found_hits = found.status == TraceStatus::hit;
    dispute.missed     = truth_hits && !found_hits;
    dispute.allowed_px = 8 * ulp(std::max(size.x, size.y));
    if (!truth_hits && !found_hits) {
        // Neither hits: they disagree on which limit ends the ray, so its end must lie on the image's border.
        const glm::dvec2 end  = glm::dvec2(ray.origin_px_depth) + glm::dvec2(ray.delta_px_depth),
                         rest = glm::dvec2(size) - end;
        dispute.corner_px     = std::min({end.x, end.y, rest.x, rest.y});
        dispute.face          = std::numeric_limits<double>::infinity();
    } else {
        const glm::ivec2 pixel  = disputed_pixel(ray, truth, found, dispute.allowed_px);
        const Overlap    inside = overlap(ray, pixel);
        const double     depth  = static_cast<double>(gbuffer.depth[pixel_index(pixel, size)]);
        const double     z_in   = ray.origin_px_depth.z + inside.t_in * ray.delta_px_depth.z,
                     z_out      = ray.origin_px_depth.z + inside.t_out * ray.delta_px_depth.z;
        dispute.corner_px       = depth_inside_px(ray, pixel);
        dispute.face            = std::min(std::abs(depth - std::min(z_in, z_out)),
                                           std::abs(std::max(z_in, z_out) - slab_back(gbuffer.view, depth, settings)));
        dispute.allowed_face    = 8 * ulp(std::max({ray.origin_px_depth.z, z_in, z_out, depth})) +
                               dispute.allowed_px * std::abs(ray.delta_px_depth.z) / length_px;
    }
    dispute.text =
        fmt::format("ray of pixel ({}, {}): {} in double, {} in single precision; {:.3g} px into the "
                    "disputed pixel (rounding: {:.3g}), {:.3g} from its slab's face (rounding: {:.3g})",
                    ray.start_pixel.x, ray.start_pixel.y, trace_status_names[static_cast<size_t>(truth.status)],
                    trace_status_names[static_cast<size_t>(found.status)], dispute.corner_px, dispute.allowed_px,
                    dispute.face, dispute.allowed_face);
    return dispute;
}

} // namespace ssrlab::test
