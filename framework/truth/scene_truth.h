// Scene truth: the true reflected point of every pixel, from the scene's triangles, and whether this frame shows it.
//
// The reflected ray starts at the G-buffer's point P (pixel centre and depth) and follows the contract's mirror
// direction, both in double. Hits nearer than self_hit_share * distance(eye, P) are the reflecting surface itself and
// do not count, because depth is a rounded float. TraceSettings::ray_offset_m does not matter.
//
// The class is the first of these that applies:
//   sky            the ray meets nothing
//   beyond         the point is farther along the ray than max_distance_m
//   behind_camera  its distance is less than the near plane's
//   off_screen     it projects outside the image
//   facing_away    the frame does not draw the side that the ray sees: the camera looks at the other one, or along the
//                  surface, or it is the back of a material that is not double-sided
//   hidden         an occlusion ray from the eye (orthographic: along the view axis) is blocked beyond the near plane
//                  and before (1 - visibility_tolerance) of the way by something that the frame draws
//   visible        everything else: a tracer could find it
// Both sides of every triangle stop the reflected ray, also of materials that are not double-sided.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"
#include "core/truth_class.h"
#include "truth/reflected_rays.h"
#include "truth/scene_bvh.h"

#include <optional>
#include <string>

namespace ssrlab {

/// Returns whether both settings have the same truths: equal maximum distance and materials that reflect.
bool same_scene_truth(const TraceSettings& a, const TraceSettings& b);

/// Returns a truth in which no pixel is traced.
SceneTruth empty_scene_truth(glm::ivec2 size_px);

/// Returns the truth of every reflecting pixel. A visible point has the radiance of the G-buffer pixel that it falls
/// into (the view-independent part), if that pixel shows the same surface: beyond an edge its centre may show another
/// one. Other points are shaded by shade_point(), and the sky by sky_radiance(). threads = 0: all cores.
SceneTruth scene_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                       const TraceSettings& settings, unsigned threads = 0);

/// Returns off_surface_share(SceneTruth) without following the reflected rays.
std::optional<double> off_surface_share(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                                        const TraceSettings& settings);

/// Returns why a truth with this share is unusable, or an empty text. A driver that rounds corners of triangles
/// coarsely draws other depths, so reflected rays begin inside objects.
std::string drawn_elsewhere(std::optional<double> off_surface_share);

/// A surface point that lights shine on.
struct LitPoint {
    glm::dvec3 point_ws{0};
    glm::dvec3 lifted_ws{0}; // where shadow rays begin
    glm::dvec3 normal_ws{0}; // unit
    double     offset_m = 0; // what lies nearer than this casts no shadow
};
/// Returns the irradiance of the scene's lights, with shadow rays.
glm::vec3 direct_irradiance(const SceneBvh& bvh, const Scene& scene, const LitPoint& lit);

/// Returns Lambertian radiance with shadow rays; its bounces are those that vertices have:
/// base ((1 - metallic) sum(irradiance cos shadow) / pi + ambient + bounced) + emissive.
/// On a metal, ambient and bounced light stand in for what it reflects.
glm::vec3 shade_point(const SceneBvh& bvh, const Scene& scene, const SceneHit& hit, glm::dvec3 point_ws,
                      glm::dvec3 direction_ws);

/// Returns the GGX highlights at this roughness, with shadow rays, as seen against `direction_ws`.
glm::vec3 shade_highlight(const SceneBvh& bvh, const Scene& scene, const SceneHit& hit, glm::dvec3 point_ws,
                          glm::dvec3 direction_ws, double roughness);

/// Returns the shading normal on the side that a ray in this direction sees.
glm::dvec3 seen_normal_ws(const SurfaceMaterial& material, const SceneHit& hit, glm::dvec3 direction_ws);

} // namespace ssrlab
