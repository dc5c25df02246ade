// The hierarchy of a scene's triangles: each in one leaf, inside the bounds above it.
#include "world/triangle_tree.h"
#include "unit/truth_scenes.h"

#include "core/error.h"

namespace ssrlab::test {
namespace {

struct Walked {
    std::set<std::pair<uint32_t, uint32_t>> found; // draw, first index
    uint32_t                                depth = 0;
};

void walk(const TriangleTree& tree, uint32_t first, uint32_t count, glm::vec3 low, glm::vec3 high, uint32_t depth,
          Walked& walked)
{
    walked.depth = std::max(walked.depth, depth);
    for (uint32_t i = first; i < first + count; ++i) {
        const TreeTriangle& triangle = tree.triangles.at(i);
        EXPECT_TRUE(walked.found.emplace(triangle.draw, triangle.first_index).second) << "twice: triangle " << i;
        for (const glm::vec3& corner : {triangle.a_ws, triangle.b_ws, triangle.c_ws})
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(corner, low)) && glm::all(glm::lessThanEqual(corner, high)));
    }
    if (count > 0) return;
    const TreeNode node = tree.nodes.at(first);
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(node.left_min_ws, low)) &&
                glm::all(glm::lessThanEqual(node.left_max_ws, high)));
    walk(tree, node.left_first, node.left_count, node.left_min_ws, node.left_max_ws, depth + 1, walked);
    if (std::isfinite(node.right_min_ws.x)) // else there is none
        walk(tree, node.right_first, node.right_count, node.right_min_ws, node.right_max_ws, depth + 1, walked);
}

Walked walk(const TriangleTree& tree)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Walked          walked;
    walk(tree, 0, 0, glm::vec3(-infinity), glm::vec3(infinity), 0, walked);
    return walked;
}

TEST(TriangleTree, HoldsEveryTriangleOnce)
{
    Scene          scene;
    const uint32_t grey = add_material(scene, {0.5, 0.5, 0.5}, 0);
    add_quad(scene, grey, {-9, 0, -9}, {18, 0, 0}, {0, 0, 18});
    add_sphere(scene, grey, {0, 2, -3}, 1, 40);
    const TriangleTree tree = build_triangle_tree(scene);
    EXPECT_EQ(tree.triangles.size(), scene.indices.size() / 3);
    const Walked walked = walk(tree);
    EXPECT_EQ(walked.found.size(), scene.indices.size() / 3);
    EXPECT_EQ(walked.depth, tree.depth);
    EXPECT_LE(tree.depth, most_tree_depth);
    const TriangleTree again = build_triangle_tree(scene);
    ASSERT_EQ(again.triangles.size(), tree.triangles.size());
    for (size_t i = 0; i < tree.triangles.size(); ++i)
        EXPECT_EQ(again.triangles[i].first_index, tree.triangles[i].first_index);
}

TEST(TriangleTree, OfFewTrianglesOrNone)
{
    Scene scene;
    EXPECT_TRUE(build_triangle_tree(scene).nodes.empty());
    add_quad(scene, add_material(scene, {1, 1, 1}, 1), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene.materials[0].alpha_mask = true;
    const TriangleTree tree       = build_triangle_tree(scene);
    EXPECT_EQ(walk(tree).found.size(), 2U);
    EXPECT_EQ(tree.triangles[0].material, masked_bit);
    scene.vertices[0].position_ws.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(build_triangle_tree(scene).triangles.empty()); // both use that corner
}

TEST(TriangleTree, ManyTrianglesInOnePlaceStayWithinTheStack)
{
    Scene          scene;
    const uint32_t grey = add_material(scene, {0.5, 0.5, 0.5}, 0);
    for (int i = 0; i < 500; ++i) add_quad(scene, grey, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const TriangleTree tree = build_triangle_tree(scene);
    EXPECT_EQ(walk(tree).found.size(), 1000U);
    EXPECT_LE(tree.depth, most_tree_depth);
}

// Bounds follow what moved, up to the root, and no farther.
TEST(TriangleTree, HoldsTrianglesWhereTheyMovedTo)
{
    Scene          scene;
    const uint32_t grey = add_material(scene, {0.5, 0.5, 0.5}, 0);
    add_quad(scene, grey, {-9, 0, -9}, {18, 0, 0}, {0, 0, 18});
    Scene few = scene;
    add_sphere(scene, grey, {0, 2, -3}, 1, 40);
    for (const Scene& still : {scene, few}) {
        Scene moved = still;
        for (Vertex& vertex : moved.vertices) {
            const glm::vec3 at = vertex.position_ws;
            vertex.position_ws = at.y > 0 ? glm::vec3(at.z + 40, at.x, -at.y) : glm::vec3(at.x, at.y - 2, at.z);
        }
        TriangleTree tree = build_triangle_tree(still);
        refit(tree, moved);
        EXPECT_EQ(walk(tree).found.size(), still.indices.size() / 3);
        glm::vec3 low = moved.vertices[0].position_ws, high = low;
        for (const Vertex& vertex : moved.vertices) {
            low  = glm::min(low, vertex.position_ws);
            high = glm::max(high, vertex.position_ws);
        }
        const TreeNode& root = tree.nodes[0];
        const bool      both = std::isfinite(root.right_min_ws.x);
        EXPECT_EQ(both ? glm::min(root.left_min_ws, root.right_min_ws) : root.left_min_ws, low);
        EXPECT_EQ(both ? glm::max(root.left_max_ws, root.right_max_ws) : root.left_max_ws, high);
    }
}

TEST(TriangleTree, RefusesWhatReachesOutside)
{
    Scene scene;
    add_quad(scene, add_material(scene, {1, 1, 1}, 1), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    Scene far_index = scene, long_draw = scene;
    far_index.indices[3]           = 99;
    long_draw.draws[0].index_count = 9;
    EXPECT_THROW(build_triangle_tree(far_index), Failure);
    EXPECT_THROW(build_triangle_tree(long_draw), Failure);
}

} // namespace
} // namespace ssrlab::test
