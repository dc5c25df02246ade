// Gradients of depth: how they are kept, and what normals say of them.
#include "core/plane_gradient.h"

#include "truth_gbuffers.h"

namespace ssrlab::test {
namespace {

TEST(PlaneGradient, KeepsEightSignificantBitsOfEachComponent)
{
    for (const float value : {0.0F, 1.0F, -0.75F, 3.1e-5F, -1.7e-9F, 0.3333F}) {
        const glm::vec2 kept = unpack_gradient(pack_gradient({value, -value}));
        EXPECT_LE(std::abs(kept.x - value), std::abs(value) / 256) << value;
        EXPECT_EQ(kept.y, -kept.x);
        EXPECT_EQ(unpack_gradient(pack_gradient(kept)), kept) << "what is kept stays as it is";
    }
}

TEST(PlaneGradient, WhatIsNotFiniteIsNoPlane)
{
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        EXPECT_TRUE(std::isnan(unpack_gradient(pack_gradient({0.5F, bad})).x));
}

/// Depth of the plane through (0, 0, -6) at pixel centres, and its differences from one to the next.
TEST(PlaneGradient, OfANormalIsTheDifferenceOfDepths)
{
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.4, 1));
    GBufferImage     image  = empty_gbuffer(bench_view({8, 8}));
    const auto       depth  = [&](glm::dvec2 px) {
        const glm::dvec3 at_1 = px_to_vs(image.view, px, distance_to_depth(image.view, 1));
        return distance_to_depth(image.view, glm::dot(glm::dvec3(0, 0, -6), normal) / glm::dot(at_1, normal));
    };
    image.depth[27]     = static_cast<float>(depth({3.5, 3.5}));
    image.normal_vs[27] = glm::vec3(normal);
    image.depth[28]     = image.depth[27];
    image.normal_vs[28] = glm::vec3(0);
    complete_gradients(image);
    EXPECT_NEAR(image.gradient[27].x, depth({4.5, 3.5}) - depth({3.5, 3.5}), 1e-5);
    EXPECT_NEAR(image.gradient[27].y, depth({3.5, 4.5}) - depth({3.5, 3.5}), 1e-5);
    EXPECT_TRUE(std::isnan(image.gradient[28].x)) << "a normal of zero";
    EXPECT_EQ(image.gradient[0], glm::vec2(0)) << "background";
}

} // namespace
} // namespace ssrlab::test
