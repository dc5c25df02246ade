#include "world/triangle_tree.h"

#include "core/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

namespace ssrlab {
namespace {

constexpr unsigned most_leaf_triangles = 4;

/// What rtcBuildBVH() builds, by its callbacks.
struct BuiltNode {
    RTCBounds  bounds[2]{};
    BuiltNode* children[2]{};
    // Of a leaf:
    uint32_t triangles[most_leaf_triangles]{};
    uint32_t count = 0;
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned /*children*/, void* /*user*/)
{
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
}

void set_children(void* node, void** children, unsigned count, void* /*user*/)
{
    for (unsigned i = 0; i < count; ++i)
        static_cast<BuiltNode*>(node)->children[i] = static_cast<BuiltNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void* /*user*/)
{
    for (unsigned i = 0; i < count; ++i) static_cast<BuiltNode*>(node)->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void* /*user*/)
{
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BuiltNode), alignof(BuiltNode))) BuiltNode;
    for (size_t i = 0; i < count; ++i) leaf->triangles[leaf->count++] = primitives[i].primID;
    return leaf;
}

std::vector<TreeTriangle> all_triangles(const Scene& scene)
{
    std::vector<TreeTriangle> triangles;
    for (uint32_t d = 0; d < scene.draws.size(); ++d) {
        const Draw& draw = scene.draws[d];
        if (draw.index_count % 3 != 0 || size_t(draw.first_index) + draw.index_count > scene.indices.size() ||
            draw.material >= scene.materials.size())
            throw_failure("scene '{}': draw '{}' reaches outside the scene's indices or materials", scene.name,
                          draw.name);
        const uint32_t material = draw.material | (scene.materials[draw.material].alpha_mask ? masked_bit : 0);
        for (uint32_t t = 0; t < draw.index_count / 3; ++t) {
            const uint32_t* index = &scene.indices[draw.first_index + 3 * t];
            for (int corner : {0, 1, 2})
                if (index[corner] >= scene.vertices.size())
                    throw_failure("scene '{}': index {} of {} vertices", scene.name, index[corner],
                                  scene.vertices.size());
            const auto      corner = [&](int i) { return scene.vertices[index[i]].position_ws; };
            const glm::vec3 sum    = corner(0) + corner(1) + corner(2);
            // No ray meets a corner that is nowhere, and a builder cannot sort it.
            if (std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z))
                triangles.push_back({corner(0), d, corner(1), draw.first_index + 3 * t, corner(2), material});
        }
    }
    return triangles;
}

RTCBuildPrimitive bounds_of(const TreeTriangle& triangle, uint32_t index)
{
    const glm::vec3 low  = glm::min(glm::min(triangle.a_ws, triangle.b_ws), triangle.c_ws),
                    high = glm::max(glm::max(triangle.a_ws, triangle.b_ws), triangle.c_ws);
    return {low.x, low.y, low.z, 0, high.x, high.y, high.z, index};
}

/// Depth first, so that what is walked together lies together.
struct Flattening {
    const std::vector<TreeTriangle>& source;
    TriangleTree&                    tree;

    /// The child as its parent names it: first and count.
    std::pair<uint32_t, uint32_t> add(const BuiltNode& built, uint32_t depth)
    {
        if (built.count > 0) {
            const auto first = static_cast<uint32_t>(tree.triangles.size());
            for (uint32_t i = 0; i < built.count; ++i) tree.triangles.push_back(source[built.triangles[i]]);
            return {first, built.count};
        }
        const auto index = static_cast<uint32_t>(tree.nodes.size());
        tree.nodes.emplace_back();
        tree.depth = std::max(tree.depth, depth + 1);
        std::pair<uint32_t, uint32_t> child[2];
        for (int i : {0, 1})
            child[i] = built.children[i] != nullptr ? add(*built.children[i], depth + 1) : std::pair(0U, 0U);
        const RTCBounds &left = built.bounds[0], &right = built.bounds[1];
        tree.nodes[index] = {{left.lower_x, left.lower_y, left.lower_z},    child[0].first,
                             {left.upper_x, left.upper_y, left.upper_z},    child[0].second,
                             {right.lower_x, right.lower_y, right.lower_z}, child[1].first,
                             {right.upper_x, right.upper_y, right.upper_z}, child[1].second};
        return {index, 0};
    }
};

/// A tree of one leaf: its other child is empty, and infinitely far away, where no ray meets it.
void add_root_of_leaf(const BuiltNode& leaf, const RTCBuildPrimitive& bounds, Flattening& flattening)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    flattening.tree.nodes.emplace_back();
    const auto [first, count] = flattening.add(leaf, 0);
    flattening.tree.depth     = 1;
    flattening.tree.nodes[0]  = {{bounds.lower_x, bounds.lower_y, bounds.lower_z},
                                 first,
                                 {bounds.upper_x, bounds.upper_y, bounds.upper_z},
                                 count,
                                 glm::vec3(infinity),
                                 0,
                                 glm::vec3(infinity),
                                 0};
}

/// The bounds of a child: of its triangles, or of both children of the node. The empty child of a root is left alone.
void fit(const TriangleTree& tree, uint32_t first, uint32_t count, glm::vec3& min_ws, glm::vec3& max_ws)
{
    if (count == 0 && first == 0) return;
    if (count == 0) {
        const TreeNode& node = tree.nodes[first];
        min_ws               = glm::min(node.left_min_ws, node.right_min_ws);
        max_ws               = glm::max(node.left_max_ws, node.right_max_ws);
        return;
    }
    min_ws = max_ws = tree.triangles[first].a_ws;
    for (uint32_t i = first; i < first + count; ++i) {
        const TreeTriangle& triangle = tree.triangles[i];
        for (const glm::vec3& corner : {triangle.a_ws, triangle.b_ws, triangle.c_ws}) {
            min_ws = glm::min(min_ws, corner);
            max_ws = glm::max(max_ws, corner);
        }
    }
}

} // namespace

TriangleTree build_triangle_tree(const Scene& scene)
{
    const std::vector<TreeTriangle> source = all_triangles(scene);
    TriangleTree                    tree;
    if (source.empty()) return tree;
    std::vector<RTCBuildPrimitive> primitives;
    RTCBuildPrimitive              whole = bounds_of(source[0], 0);
    for (uint32_t i = 0; i < source.size(); ++i) {
        const RTCBuildPrimitive& added = primitives.emplace_back(bounds_of(source[i], i));
        whole = {std::min(whole.lower_x, added.lower_x), std::min(whole.lower_y, added.lower_y),
                 std::min(whole.lower_z, added.lower_z), 0,
                 std::max(whole.upper_x, added.upper_x), std::max(whole.upper_y, added.upper_y),
                 std::max(whole.upper_z, added.upper_z), 0};
    }
    const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice("threads=1,set_affinity=0"),
                                                                           rtcReleaseDevice);
    const std::unique_ptr<RTCBVHTy, decltype(&rtcReleaseBVH)>       built(rtcNewBVH(device.get()), rtcReleaseBVH);
    RTCBuildArguments                                               arguments = rtcDefaultBuildArguments();
    arguments.maxDepth       = most_tree_depth - 8; // Embree adds levels where it splits leaves that are too large
    arguments.maxLeafSize    = most_leaf_triangles;
    arguments.bvh            = built.get();
    arguments.primitives     = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode             = create_node;
    arguments.setNodeChildren        = set_children;
    arguments.setNodeBounds          = set_bounds;
    arguments.createLeaf             = create_leaf;
    const auto* root                 = static_cast<const BuiltNode*>(rtcBuildBVH(&arguments));
    if (root == nullptr)
        throw_failure("scene '{}': Embree could not build the hierarchy of its triangles (error {})", scene.name,
                      int(rtcGetDeviceError(device.get())));
    Flattening flattening{source, tree};
    if (root->count > 0)
        add_root_of_leaf(*root, whole, flattening);
    else
        flattening.add(*root, 0);
    if (tree.depth > most_tree_depth)
        throw_failure("scene '{}': its hierarchy of triangles has {} levels, expected at most {}", scene.name,
                      tree.depth, most_tree_depth);
    return tree;
}

void refit(TriangleTree& tree, const Scene& moved)
{
    for (TreeTriangle& triangle : tree.triangles) {
        const auto corner = [&](uint32_t i) {
            return moved.vertices[moved.indices[triangle.first_index + i]].position_ws;
        };
        triangle.a_ws = corner(0);
        triangle.b_ws = corner(1);
        triangle.c_ws = corner(2);
    }
    // Nodes lie behind their parents.
    for (auto node = tree.nodes.rbegin(); node != tree.nodes.rend(); ++node) {
        fit(tree, node->left_first, node->left_count, node->left_min_ws, node->left_max_ws);
        fit(tree, node->right_first, node->right_count, node->right_min_ws, node->right_max_ws);
    }
}

} // namespace ssrlab
