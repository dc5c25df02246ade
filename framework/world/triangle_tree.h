// A scene's triangles in a bounding-volume hierarchy, flattened into arrays that a shader walks
// (shaders/world/walk.comp). Built by Embree's rtcBuildBVH; alpha masks and textures lie beside it as words.
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace ssrlab {

/// Both children of an inner node with their bounds. A child is a node, or a run of triangles: then `count` is above 0.
/// World space, metres; bounds are widened to hold their triangles in float.
struct TreeNode {
    glm::vec3 left_min_ws{0};
    uint32_t  left_first = 0; // node, or first triangle
    glm::vec3 left_max_ws{0};
    uint32_t  left_count = 0; // triangles; 0: a node
    glm::vec3 right_min_ws{0};
    uint32_t  right_first = 0;
    glm::vec3 right_max_ws{0};
    uint32_t  right_count = 0;
};
static_assert(sizeof(TreeNode) == 64);

/// A triangle in the order of the leaves.
struct TreeTriangle {
    glm::vec3 a_ws{0};
    uint32_t  draw = 0; // index into Scene::draws
    glm::vec3 b_ws{0};
    uint32_t  first_index = 0; // of its three in Scene::indices
    glm::vec3 c_ws{0};
    uint32_t  material = 0; // with masked_bit where the material has an alpha mask
};
static_assert(sizeof(TreeTriangle) == 48);
inline constexpr uint32_t masked_bit = 1U << 31;

struct TriangleTree {
    std::vector<TreeNode>     nodes; // nodes[0] is the root; empty where the scene has no triangle
    std::vector<TreeTriangle> triangles;
    uint32_t depth = 0; // levels of nodes below and including the root: so many entries a walk's stack needs
};

/// Deepest hierarchy that is built: what the shader's stack holds.
inline constexpr uint32_t most_tree_depth = 48;

/// The same tree for the same scene. Throws Failure where an index, a draw or a material is out of range, or Embree
/// fails.
TriangleTree build_triangle_tree(const Scene& scene);
/// Puts the triangles where the scene now has its vertices, and fits the bounds to them. The hierarchy stays as it was
/// built: of a scene that moves, any frame comes to the same tree, whichever frame came before.
void refit(TriangleTree& tree, const Scene& moved);

} // namespace ssrlab
