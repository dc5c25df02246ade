#include "truth/reflected_rays.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "truth/scene_truth.h"
#include "truth/screen_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// In a plane through the camera the frame draws nothing, and which of its sides is seen would be a matter of rounding.
constexpr double edge_on_cosine = 1e-6;

bool inside_image(const View& view, glm::dvec2 point_px)
{
    return point_px.x >= 0 && point_px.y >= 0 && point_px.x < view.size_px.x && point_px.y < view.size_px.y;
}

} // namespace

ReflectedRays::ReflectedRays(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                             double max_distance_m)
    : bvh_(bvh), scene_(scene), gbuffer_(gbuffer), max_distance_m_(max_distance_m),
      view_to_world_(glm::inverse(gbuffer.view.world_to_view))
{
}

glm::dvec3 ReflectedRays::point_to_ws(glm::dvec3 point_vs) const
{
    return glm::dvec3(view_to_world_ * glm::dvec4(point_vs, 1));
}

glm::dvec3 ReflectedRays::direction_to_ws(glm::dvec3 direction_vs) const
{
    return glm::dmat3(view_to_world_) * direction_vs;
}

/// From where the camera looks at a point.
glm::dvec3 ReflectedRays::eye_vs(glm::dvec3 point_vs) const
{
    return gbuffer_.view.projection == Projection::perspective ? glm::dvec3(0) : glm::dvec3(point_vs.x, point_vs.y, 0);
}

/// t = 1 is the point.
SceneRay ReflectedRays::sight_ray(glm::dvec3 point_vs) const
{
    const glm::dvec3 origin_vs = eye_vs(point_vs);
    return {point_to_ws(origin_vs), direction_to_ws(point_vs - origin_vs), gbuffer_.view.near_m / -point_vs.z,
            1 - visibility_tolerance};
}

SceneRay ReflectedRays::ray_from(glm::ivec2 pixel, glm::dvec3 direction_vs) const
{
    const glm::dvec3 point_vs = pixel_point_vs(gbuffer_, pixel);
    const double     start_m  = self_hit_share * glm::length(point_vs - eye_vs(point_vs));
    return {point_to_ws(point_vs), direction_to_ws(direction_vs), start_m, infinity};
}

/// Everything but the occlusion ray, which is sent only for what comes back as visible.
RayEnd ReflectedRays::classify(const SceneRay& ray, const SceneHit& hit) const
{
    RayEnd     end;
    const auto with = [&](TruthClass cls) {
        end.cls = cls;
        return end;
    };
    end.distance_m = hit.met ? hit.t : infinity;
    if (!hit.met) return with(TruthClass::sky);

    const View& view    = gbuffer_.view;
    end.point_vs        = glm::dvec3(view.world_to_view * glm::dvec4(ray.origin_ws + hit.t * ray.direction_ws, 1));
    const bool in_front = -end.point_vs.z >= view.near_m;
    if (in_front) end.point_px = glm::dvec2(vs_to_px(view, end.point_vs));
    if (hit.t > max_distance_m_) return with(TruthClass::beyond);
    if (!in_front) return with(TruthClass::behind_camera);
    if (!inside_image(view, end.point_px)) return with(TruthClass::off_screen);
    const glm::dvec3 sight_ws = direction_to_ws(end.point_vs - eye_vs(end.point_vs));
    const double     towards  = glm::dot(hit.normal_ws, sight_ws);
    const bool       edge_on = std::abs(towards) <= edge_on_cosine * glm::length(hit.normal_ws) * glm::length(sight_ws);
    const bool       camera_front = towards < 0;
    const bool       ray_front    = glm::dot(hit.normal_ws, ray.direction_ws) < 0;
    const bool       drawn        = ray_front || scene_.materials[scene_.draws[hit.surface.draw].material].double_sided;
    return with(!edge_on && camera_front == ray_front && drawn ? TruthClass::visible : TruthClass::facing_away);
}

/// Whether the pixel into which a hit falls shows the same surface: at an edge its centre may lie on another one, of another colour.
bool ReflectedRays::pixel_shows(glm::ivec2 pixel, const SceneHit& hit, glm::dvec3 point_vs) const
{
    constexpr double flat_px = 0.05; // off the triangle's plane, in widths of the pixel there
    const size_t     i       = pixel_index(pixel, gbuffer_.view.size_px);
    if (!(gbuffer_.depth[i] > 0)) return false;
    const uint32_t object = gbuffer_.object_id.empty() ? 0 : gbuffer_.object_id[i];
    if (object != 0 && object != hit.surface.draw + 1) return false;
    const double width_m =
        (gbuffer_.view.projection == Projection::perspective ? -point_vs.z : 1) / gbuffer_.view.focal_px.y;
    const glm::dvec3 way_ws = direction_to_ws(pixel_point_vs(gbuffer_, pixel) - point_vs);
    return std::abs(glm::dot(glm::normalize(hit.normal_ws), way_ws)) <= flat_px * width_m;
}

glm::vec3 ReflectedRays::radiance(const SceneRay& ray, const SceneHit& hit, const RayEnd& end) const
{
    if (end.cls == TruthClass::sky) return sky_radiance(scene_, ray.direction_ws);
    if (end.cls == TruthClass::visible) {
        const glm::ivec2 pixel(end.point_px);
        if (pixel_shows(pixel, hit, end.point_vs)) return gbuffer_.radiance[pixel_index(pixel, gbuffer_.view.size_px)];
    }
    return shade_point(bvh_, scene_, hit, ray.origin_ws + hit.t * ray.direction_ws, ray.direction_ws);
}

std::vector<RayEnd> ReflectedRays::follow(std::span<const SceneRay> rays) const
{
    std::vector<SceneHit> hits(rays.size());
    std::vector<RayEnd>   ends(rays.size());
    bvh_.intersect(rays, hits);
    std::vector<size_t>   candidates;
    std::vector<SceneRay> sight_rays;
    for (size_t k = 0; k < rays.size(); ++k) {
        ends[k] = classify(rays[k], hits[k]);
        if (ends[k].cls != TruthClass::visible) continue;
        candidates.push_back(k);
        sight_rays.push_back(sight_ray(ends[k].point_vs));
    }
    std::vector<uint8_t> blocked(sight_rays.size());
    bvh_.occluded(sight_rays, Sides::as_rasterised, blocked);
    for (size_t c = 0; c < candidates.size(); ++c)
        if (blocked[c] != 0) ends[candidates[c]].cls = TruthClass::hidden;
    for (size_t k = 0; k < rays.size(); ++k) {
        ends[k].radiance = radiance(rays[k], hits[k], ends[k]);
        ends[k].hit      = hits[k];
    }
    return ends;
}

size_t ReflectedRays::count_off_surface(std::span<const size_t> pixels) const
{
    std::vector<SceneRay> rays;
    for (const size_t pixel : pixels) {
        rays.push_back(sight_ray(pixel_point_vs(gbuffer_, pixel_at(pixel, gbuffer_.view.size_px))));
        rays.back().t_min = 1 - self_hit_share;
        rays.back().t_max = 1 + self_hit_share;
    }
    std::vector<uint8_t> met(rays.size());
    bvh_.occluded(rays, Sides::as_rasterised, met);
    return static_cast<size_t>(std::ranges::count(met, 0));
}

void require_radiance(const GBufferImage& gbuffer)
{
    require_complete(gbuffer);
    if (gbuffer.radiance.size() != gbuffer.depth.size())
        throw_failure("G-buffer of view '{}': expected {} values of radiance, found {}", gbuffer.view.name,
                      gbuffer.depth.size(), gbuffer.radiance.size());
}

} // namespace ssrlab
