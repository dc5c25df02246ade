// Rays against a scene's triangles (Embree), with alpha masks.
#pragma once

#include "truth/scene_surface.h"

#include <memory>
#include <span>

namespace ssrlab {

struct SceneRay {
    glm::dvec3 origin_ws{0};
    glm::dvec3 direction_ws{0};
    double     t_min = 0;
    double     t_max = 0; // may be +inf
};

/// `t` in units of the ray's direction; the rest is undefined unless met.
struct SceneHit {
    bool         met = false;
    double       t   = 0;
    SurfacePoint surface;
    glm::dvec3   normal_ws{0}; // of the triangle's front (counter-clockwise) side; not unit length
};

/// Which sides of a triangle stop a ray: as_rasterised lets it pass the back of a material that is not double-sided.
enum class Sides { both, as_rasterised };

/// Keeps a reference to the scene.
class SceneBvh {
public:
    /// Throws Failure when an index, a draw or a material is out of range.
    explicit SceneBvh(const Scene& scene);
    SceneBvh(SceneBvh&&) noexcept;
    ~SceneBvh();

    /// Finds the first hit of each ray, on either side: the triangle in float, then `t` exactly on its plane in double.
    /// A ray with a value that is not finite, or without direction, meets nothing.
    void intersect(std::span<const SceneRay> rays, std::span<SceneHit> hits) const;

    const Scene& scene() const { return *scene_; }

    /// Sets occluded[i] = 1 if anything lies inside [t_min, t_max].
    void occluded(std::span<const SceneRay> rays, Sides sides, std::span<uint8_t> occluded) const;

private:
    struct Embree;
    const Scene*            scene_;
    std::unique_ptr<Embree> embree_;
};

} // namespace ssrlab
