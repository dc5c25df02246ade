#include "truth/screen_ray.h"

#include "core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

size_t pixel_index(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    return size_t(pixel.y) * size_t(gbuffer.view.size_px.x) + size_t(pixel.x);
}

/// The half space a0 + s * a1 >= 0 along the ray; a0 >= 0 for every point in the view.
double distance_to_plane_m(double a0, double a1) { return a1 < 0 ? std::max(a0, 0.0) / -a1 : infinity; }

enum class Limit { max_distance, near_plane, left, right, top, bottom };

struct Clip {
    double length_m;
    Limit  limit;
};

/// Border planes are homogeneous: px >= 0 <=> centre.x * w + focal.x * X >= 0 with w = distance, or 1 in an orthographic view.
Clip clip_ray(const View& view, glm::dvec3 point_vs, glm::dvec3 direction_vs, double max_distance_m)
{
    const bool       perspective = view.projection == Projection::perspective;
    const double     w0          = perspective ? -point_vs.z : 1.0;
    const double     w1          = perspective ? -direction_vs.z : 0.0;
    const glm::dvec2 rest_px     = glm::dvec2(view.size_px) - view.centre_px;
    const glm::dvec2 p0          = view.focal_px * glm::dvec2(point_vs.x, -point_vs.y);
    const glm::dvec2 p1          = view.focal_px * glm::dvec2(direction_vs.x, -direction_vs.y);

    Clip       clip{max_distance_m, Limit::max_distance};
    const auto limit_by = [&](Limit limit, double a0, double a1) {
        const double s = distance_to_plane_m(a0, a1);
        if (s < clip.length_m) clip = {s, limit};
    };
    limit_by(Limit::near_plane, -point_vs.z - view.near_m, -direction_vs.z);
    if (!perspective) limit_by(Limit::max_distance, view.far_m + point_vs.z, direction_vs.z);
    limit_by(Limit::left, view.centre_px.x * w0 + p0.x, view.centre_px.x * w1 + p1.x);
    limit_by(Limit::right, rest_px.x * w0 - p0.x, rest_px.x * w1 - p1.x);
    limit_by(Limit::top, view.centre_px.y * w0 + p0.y, view.centre_px.y * w1 + p1.y);
    limit_by(Limit::bottom, rest_px.y * w0 - p0.y, rest_px.y * w1 - p1.y);
    return clip;
}

/// project(point + length * direction) - project(point) with the common terms cancelled by hand: no difference of two
/// projected points is taken, length = +inf needs no special case, and mirrored rays have exactly mirrored deltas.
glm::dvec3 screen_delta(const View& view, glm::dvec3 point_vs, glm::dvec3 direction_vs, double length_m)
{
    if (view.projection == Projection::orthographic) {
        // Only a ray exactly along the axis is unlimited here; it never leaves its start pixel.
        if (length_m == infinity) return glm::dvec3(0);
        return length_m * glm::dvec3(view.focal_px.x * direction_vs.x, -view.focal_px.y * direction_vs.y,
                                     direction_vs.z / (view.far_m - view.near_m));
    }
    const double     distance_m = -point_vs.z;
    const double     scale      = 1.0 / ((distance_m / length_m - direction_vs.z) * distance_m);
    const glm::dvec2 slope      = glm::dvec2(direction_vs) * distance_m + glm::dvec2(point_vs) * direction_vs.z;
    return scale * glm::dvec3(view.focal_px.x * slope.x, -view.focal_px.y * slope.y, view.near_m * direction_vs.z);
}

/// Puts the end exactly on the border that limits the ray, and inside the image on the other axis.
void snap_end(const View& view, Limit limit, glm::dvec3 origin, glm::dvec3& delta)
{
    const glm::dvec2 size = view.size_px;
    for (int axis : {0, 1}) delta[axis] = std::clamp(delta[axis], -origin[axis], size[axis] - origin[axis]);
    if (limit == Limit::left) delta.x = -origin.x;
    if (limit == Limit::right) delta.x = size.x - origin.x;
    if (limit == Limit::top) delta.y = -origin.y;
    if (limit == Limit::bottom) delta.y = size.y - origin.y;
}

} // namespace

void require_complete(const GBufferImage& gbuffer)
{
    const glm::ivec2 size  = gbuffer.view.size_px;
    const size_t     count = size_t(std::max(size.x, 0)) * size_t(std::max(size.y, 0));
    if (gbuffer.depth.size() != count || gbuffer.normal_vs.size() != count || gbuffer.metallic.size() != count) {
        throw_failure("G-buffer of view '{}': expected {} values of depth, normal_vs and metallic, found {}, {} and {}",
                      gbuffer.view.name, count, gbuffer.depth.size(), gbuffer.normal_vs.size(),
                      gbuffer.metallic.size());
    }
}

bool reflects(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    const size_t    i      = pixel_index(gbuffer, pixel);
    const glm::vec3 normal = gbuffer.normal_vs[i];
    return gbuffer.depth[i] > 0 && std::isfinite(gbuffer.depth[i]) && gbuffer.metallic[i] > 0 &&
           std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z) && normal != glm::vec3(0);
}

glm::dvec3 pixel_point_vs(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    return px_to_vs(gbuffer.view, glm::dvec2(pixel) + 0.5, double(gbuffer.depth[pixel_index(gbuffer, pixel)]));
}

glm::dvec3 mirror_direction_vs(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    const glm::dvec3 to_point_vs = gbuffer.view.projection == Projection::perspective
                                       ? glm::normalize(pixel_point_vs(gbuffer, pixel))
                                       : glm::dvec3(0, 0, -1);
    const glm::dvec3 raw(gbuffer.normal_vs[pixel_index(gbuffer, pixel)]);
    // Divided by its largest component first, so that no square over- or underflows.
    const double     largest   = std::max({std::abs(raw.x), std::abs(raw.y), std::abs(raw.z)});
    const glm::dvec3 normal_vs = glm::normalize(raw / largest);
    return glm::normalize(to_point_vs - 2.0 * glm::dot(normal_vs, to_point_vs) * normal_vs);
}

ScreenRay make_screen_ray(const GBufferImage& gbuffer, glm::ivec2 pixel, const TraceSettings& settings)
{
    if (!reflects(gbuffer, pixel)) return {};
    return make_screen_ray(gbuffer, pixel, mirror_direction_vs(gbuffer, pixel), settings);
}

ScreenRay make_screen_ray(const GBufferImage& gbuffer, glm::ivec2 pixel, glm::dvec3 direction_vs,
                          const TraceSettings& settings)
{
    ScreenRay        ray;
    const View&      view     = gbuffer.view;
    const glm::dvec3 point_vs = pixel_point_vs(gbuffer, pixel);
    ray.traced                = true;
    ray.direction_vs          = direction_vs;
    ray.start_pixel           = pixel;
    ray.origin_px_depth       = {glm::dvec2(pixel) + 0.5, double(gbuffer.depth[pixel_index(gbuffer, pixel)])};

    const Clip clip = clip_ray(view, point_vs, ray.direction_vs, std::max(settings.max_distance_m, 0.0));
    ray.length_m    = clip.length_m;
    ray.end_status  = clip.limit == Limit::max_distance ? TraceStatus::past_max_distance : TraceStatus::left_screen;

    const double offset_m = std::max(settings.ray_offset_m, 0.0);
    if (offset_m >= clip.length_m) return ray;
    glm::dvec3 start_vs = point_vs;
    if (offset_m > 0) {
        const glm::dvec2 size = view.size_px;
        start_vs              = point_vs + offset_m * ray.direction_vs;
        ray.origin_px_depth   = vs_to_px(view, start_vs);
        for (int axis : {0, 1}) {
            ray.origin_px_depth[axis] = std::clamp(ray.origin_px_depth[axis], 0.0, size[axis]);
            ray.start_pixel[axis]     = std::min(int(ray.origin_px_depth[axis]), view.size_px[axis] - 1);
        }
    }
    ray.delta_px_depth = screen_delta(view, start_vs, ray.direction_vs, clip.length_m - offset_m);
    snap_end(view, clip.limit, ray.origin_px_depth, ray.delta_px_depth);
    return ray;
}

} // namespace ssrlab
