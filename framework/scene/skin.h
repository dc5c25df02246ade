// Meshes that joints bend: each vertex follows several of them by weight (linear blend skinning).
#pragma once

#include "scene/scene.h"

namespace ssrlab {

/// The mean of what the joints do, by weight. The identity without joints.
glm::dmat4 blended(const Influences& influences, const std::vector<glm::dmat4>& joints);

/// Moves a vertex with its normal and tangent; a normal that a flattening matrix takes to nothing becomes 0.
void move_vertex(const glm::dmat4& matrix, glm::dvec3& position_ws, Vertex& vertex);

/// From world space in frame 0 to that in `frame`; the last frame stays. Identity where frame 0 flattens the vertex.
glm::dmat4 pose(const Influences& influences, const JointPoses& joints, int frame);

} // namespace ssrlab
