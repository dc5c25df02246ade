// Where reflected rays end and what they see. Scene truth follows one ray per pixel, glossy truth many.
#pragma once

#include "core/gbuffer_image.h"
#include "core/truth_class.h"
#include "truth/scene_bvh.h"

#include <span>
#include <vector>

namespace ssrlab {

inline constexpr double self_hit_share       = 1e-4;
inline constexpr double visibility_tolerance = 2e-4;

struct RayEnd {
    TruthClass cls        = TruthClass::not_traced;
    double     distance_m = 0; // infinite for sky
    glm::dvec3 point_vs{0};    // 0 for sky
    glm::dvec2 point_px{0};    // 0 if there is none
    glm::vec3  radiance{0};    // linear
    SceneHit   hit;            // undefined for sky
};

/// Keeps references to its arguments. scene_truth.h defines the classes and the radiance.
class ReflectedRays {
public:
    ReflectedRays(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer, double max_distance_m);

    /// Returns the ray from the pixel's point; `direction_vs` is a unit vector.
    SceneRay            ray_from(glm::ivec2 pixel, glm::dvec3 direction_vs) const;
    std::vector<RayEnd> follow(std::span<const SceneRay> rays) const;

    /// Counts the pixels whose depth lies on no drawn surface. Their rays would begin inside objects.
    size_t count_off_surface(std::span<const size_t> pixels) const;

private:
    glm::dvec3 point_to_ws(glm::dvec3 point_vs) const;
    glm::dvec3 direction_to_ws(glm::dvec3 direction_vs) const;
    glm::dvec3 eye_vs(glm::dvec3 point_vs) const;
    SceneRay   sight_ray(glm::dvec3 point_vs) const;
    RayEnd     classify(const SceneRay& ray, const SceneHit& hit) const;
    bool       pixel_shows(glm::ivec2 pixel, const SceneHit& hit, glm::dvec3 point_vs) const;
    glm::vec3  radiance(const SceneRay& ray, const SceneHit& hit, const RayEnd& end) const;

    const SceneBvh&     bvh_;
    const Scene&        scene_;
    const GBufferImage& gbuffer_;
    double              max_distance_m_;
    glm::dmat4          view_to_world_;
};

/// Throws Failure unless the G-buffer covers its image with all that the rays need.
void require_radiance(const GBufferImage& gbuffer);

} // namespace ssrlab
