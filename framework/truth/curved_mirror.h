// Where a camera sees a reflected point in a mirror of any shape.
#pragma once

#include "core/view.h"
#include "truth/scene_bvh.h"

#include <optional>
#include <span>

namespace ssrlab {

/// Rays from a camera into a scene. Keeps a reference to the hierarchy.
class Sight {
public:
    Sight(const SceneBvh& bvh, const View& view);

    /// Returns the ray from the near plane through a position of the image.
    SceneRay ray(glm::dvec2 at_px) const;
    /// Returns the first surface on that ray that the frame draws, so no back faces of single-sided materials.
    SceneHit first_drawn(glm::dvec2 at_px) const;
    /// Projects a point (w = 1) or a direction (w = 0). Returns nullopt unless it lies in front of the eye.
    std::optional<glm::dvec2> project(glm::dvec4 at_ws) const;

    const SceneBvh& bvh() const { return bvh_; }

private:
    const SceneBvh& bvh_;
    View            view_;
    glm::dmat4      view_to_world_;
};

/// Returns the position at which the mirror (draw `mirror`) shows `reflected_ws`, a point (w = 1) or a direction (w =
/// 0). Returns nullopt if no start converges, or if starts converge to different answers.
std::optional<glm::dvec2> curved_reflection(const Sight& sight, uint32_t mirror, glm::dvec4 reflected_ws,
                                            std::span<const glm::dvec2> starts_px);

} // namespace ssrlab
