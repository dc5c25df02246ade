#include "truth/screen_ray.h"

#include "core/error.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

enum class Limit { max_distance, far_plane, near_plane, left, right, top, bottom };

/// The ray stands at origin + k * rate on screen; the limit that ends it is met at k = distance / rate.
struct End {
    double k     = infinity;
    Limit  limit = Limit::max_distance;
};

/// The direction (x, y, -1) of the view ray through a pixel's centre, or the view axis.
glm::dvec3 view_direction_vs(const View& view, glm::ivec2 pixel)
{
    if (view.projection == Projection::orthographic) return {0, 0, -1};
    const glm::dvec2 slope = (glm::dvec2(pixel) + 0.5 - view.centre_px) / view.focal_px;
    return {slope.x, -slope.y, -1};
}

/// How the point that is seen along `to_point_vs` at a depth moves on screen, in (x_px, y_px, depth) per unit of k, when it moves along `direction_vs`. After
/// lambda times that direction k is 1 / (distance / lambda - direction.z), in an orthographic view lambda.
glm::dvec3 screen_rate(const View& view, double depth, glm::dvec3 to_point_vs, glm::dvec3 direction_vs)
{
    if (view.projection == Projection::orthographic)
        return {view.focal_px.x * direction_vs.x, -(view.focal_px.y * direction_vs.y),
                direction_vs.z / (view.far_m - view.near_m)};
    return {view.focal_px.x * (direction_vs.x + to_point_vs.x * direction_vs.z),
            -(view.focal_px.y * (direction_vs.y + to_point_vs.y * direction_vs.z)), depth * direction_vs.z};
}

double k_at_distance(const View& view, double metres, double depth, glm::dvec3 direction_vs)
{
    const double size = glm::length(direction_vs);
    if (view.projection == Projection::orthographic) return metres / size;
    // By the larger of the two lengths, so that 0 and infinity are lengths like any other.
    const double distance_m = depth_to_distance(view, depth);
    const bool   far        = metres > distance_m;
    const double distance   = far ? 1 : metres / distance_m,
                 rate       = size * (far ? distance_m / metres : 1) - distance * direction_vs.z;
    return rate > 0 ? distance / rate : infinity;
}

End end_of_ray(const View& view, glm::dvec3 origin, glm::dvec3 rate, double max_distance_k)
{
    End        end{max_distance_k, Limit::max_distance};
    const auto limit_by = [&](Limit limit, double distance, double speed) {
        const double k = speed > 0 ? std::max(distance, 0.0) / speed : infinity;
        if (k < end.k) end = {k, limit};
    };
    limit_by(Limit::near_plane, 1 - origin.z, rate.z);
    if (view.projection == Projection::orthographic) limit_by(Limit::far_plane, origin.z, -rate.z);
    limit_by(Limit::left, origin.x, -rate.x);
    limit_by(Limit::right, view.size_px.x - origin.x, rate.x);
    limit_by(Limit::top, origin.y, -rate.y);
    limit_by(Limit::bottom, view.size_px.y - origin.y, rate.y);
    return end;
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

bool reflects(const GBufferImage& gbuffer, glm::ivec2 pixel, const TraceSettings& settings)
{
    const size_t    i         = pixel_index(pixel, gbuffer.view.size_px);
    const glm::vec3 normal    = gbuffer.normal_vs[i];
    const float     roughness = gbuffer.roughness.empty() ? 0 : gbuffer.roughness[i];
    return gbuffer.depth[i] > 0 && std::isfinite(gbuffer.depth[i]) &&
           settings.material_reflects(gbuffer.metallic[i], dielectric_f0_at(gbuffer, i), roughness) &&
           std::isfinite(normal.x) && std::isfinite(normal.y) && std::isfinite(normal.z) && normal != glm::vec3(0);
}

glm::dvec3 pixel_point_vs(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    return px_to_vs(gbuffer.view, glm::dvec2(pixel) + 0.5,
                    double(gbuffer.depth[pixel_index(pixel, gbuffer.view.size_px)]));
}

namespace {

/// |normal|^2 times as long as the direction to the pixel.
glm::dvec3 mirrored_vs(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    const glm::dvec3 to_point_vs = view_direction_vs(gbuffer.view, pixel);
    const glm::dvec3 raw(gbuffer.normal_vs[pixel_index(pixel, gbuffer.view.size_px)]);
    // By a power of two, so that no square over- or underflows.
    const double     largest   = std::max({std::abs(raw.x), std::abs(raw.y), std::abs(raw.z)});
    const glm::dvec3 normal_vs = raw * std::ldexp(1.0, -std::ilogb(largest));
    return glm::dot(normal_vs, normal_vs) * to_point_vs + (-2.0 * glm::dot(normal_vs, to_point_vs)) * normal_vs;
}

} // namespace

glm::dvec3 mirror_direction_vs(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    return glm::normalize(mirrored_vs(gbuffer, pixel));
}

ScreenRay make_screen_ray(const GBufferImage& gbuffer, glm::ivec2 pixel, const TraceSettings& settings)
{
    if (!reflects(gbuffer, pixel, settings)) return {};
    return make_screen_ray(gbuffer, pixel, mirrored_vs(gbuffer, pixel), settings);
}

ScreenRay make_screen_ray(const GBufferImage& gbuffer, glm::ivec2 pixel, glm::dvec3 direction_vs,
                          const TraceSettings& settings)
{
    ScreenRay        ray;
    const View&      view = gbuffer.view;
    const double     depth(gbuffer.depth[pixel_index(pixel, gbuffer.view.size_px)]);
    const glm::dvec3 rate = screen_rate(view, depth, view_direction_vs(view, pixel), direction_vs);
    ray.traced            = true;
    ray.direction_vs      = glm::normalize(direction_vs);
    ray.start_pixel       = pixel;
    ray.origin_px_depth   = {glm::dvec2(pixel) + 0.5, depth};

    const double max_distance_m = std::max(settings.max_distance_m, 0.0);
    const End    end =
        end_of_ray(view, ray.origin_px_depth, rate, k_at_distance(view, max_distance_m, depth, direction_vs));
    ray.end_status = end.limit <= Limit::far_plane ? TraceStatus::past_max_distance : TraceStatus::left_screen;
    if (end.k <= 0 || end.k == infinity) return ray;
    glm::dvec3 delta = end.k * rate;
    double     far_m = glm::length(direction_vs) * end.k;
    if (view.projection == Projection::perspective) far_m = far_m * view.near_m / (depth + delta.z);
    ray.length_m = end.limit == Limit::max_distance ? max_distance_m : far_m;

    const double offset_m = std::max(settings.ray_offset_m, 0.0);
    if (ray.length_m <= offset_m) return ray;
    if (offset_m > 0) {
        const double     start_k = k_at_distance(view, offset_m, depth, direction_vs);
        const glm::dvec2 size    = view.size_px;
        ray.origin_px_depth += start_k * rate;
        for (int axis : {0, 1}) {
            ray.origin_px_depth[axis] = std::clamp(ray.origin_px_depth[axis], 0.0, size[axis]);
            ray.start_pixel[axis]     = std::min(int(ray.origin_px_depth[axis]), view.size_px[axis] - 1);
        }
        delta = (end.k - start_k) * rate;
    }
    ray.delta_px_depth = delta;
    snap_end(view, end.limit, ray.origin_px_depth, ray.delta_px_depth);
    return ray;
}

} // namespace ssrlab
