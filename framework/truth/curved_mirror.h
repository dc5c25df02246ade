// Where a camera sees a point in a mirror of any shape.
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

    /// From the near plane on, through a position of the image.
    SceneRay ray(glm::dvec2 at_px) const;
    /// The first surface on that ray that the frame draws: no backs of materials that are not double-sided.
    SceneHit first_drawn(glm::dvec2 at_px) const;
    /// Of a point (w = 1) or a direction (w = 0). Empty unless it lies in front of the eye.
    std::optional<glm::dvec2> project(glm::dvec4 at_ws) const;

    const SceneBvh& bvh() const { return bvh_; }

private:
    const SceneBvh& bvh_;
    View            view_;
    glm::dmat4      view_to_world_;
};

/// The position at which the mirror, draw `mirror`, shows the point (w = 1) or the direction (w = 0) `reflected_ws`. Empty unless the
/// starts that lead to an answer, one at least, all lead to the same.
std::optional<glm::dvec2> curved_reflection(const Sight& sight, uint32_t mirror, glm::dvec4 reflected_ws,
                                            std::span<const glm::dvec2> starts_px);

} // namespace ssrlab
