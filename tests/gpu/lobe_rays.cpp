// Rays drawn from the lobes of rough surfaces, and their reuse by neighbours.
#include "gpu/passes.h"

#include <algorithm>

namespace ssrlab::test {
namespace {

/// A rough metal floor before a wall of one colour, at 64 x 64.
GBufferImage floor_before_glow(float roughness)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 10);
    for (size_t i = 0; i < image.depth.size(); ++i) {
        image.base_colour[i] = glm::vec3(1);
        if (image.metallic[i] > 0) image.roughness[i] = roughness;
        image.radiance[i] = image.metallic[i] > 0 ? glm::vec3(8, 0, 0) : glm::vec3(0.25F, 0.5F, 1);
    }
    return image;
}

/// Pixels hold planes: no ray meets its own floor.
Reflection reflection_with(const Picture& picture, const ParameterValues& passes)
{
    const auto frame = frame_with(picture, passes, "hiz", "plane");
    run_frame(device(), *frame);
    return read_colours(picture.buffers->reflection);
}

// Whatever the weights, a mean of one colour is that colour; and more than the mirror image of the wall shows it.
TEST(LobeRays, ReflectTheOnlyColourThatThereIs)
{
    const Picture picture = make_picture(floor_before_glow(0.4F));
    for (const double rays : {1.0, 3.0}) {
        const Reflection found =
            reflection_with(picture, {chosen(Gloss::stochastic), chosen(EdgeFade::off), {"rays_per_pixel", rays}});
        size_t reflecting = 0, weak = 0;
        for (size_t i = 0; i < found.size(); ++i) {
            if (found[i].a <= 0) continue;
            ++reflecting;
            weak += found[i].a < 0.95F;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(found[i][c], glm::vec3(0.25F, 0.5F, 1)[c], 2e-3) << i << ", " << rays << " rays";
        }
        EXPECT_GT(reflecting, 1000U);
        EXPECT_GT(weak, 50U) << "some rays of each lobe miss";
    }
}

TEST(LobeRays, OfMirrorsAreMirrorRaysToTheLastBit)
{
    GBufferImage image = floor_before_glow(0.4F);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 32; ++x) image.roughness[at(image, x, y)] = 0;
    const Picture    picture = make_picture(image);
    const Reflection plain   = reflection_with(picture, {chosen(Gloss::off)}),
                     drawn   = reflection_with(picture, {chosen(Gloss::stochastic)});
    EXPECT_GT(changes_on_the_right_alone(drawn, plain), 300U);
}

// At half resolution every pixel uses the rays of the traced ones.
TEST(LobeRays, AtHalfResolutionServeEveryPixel)
{
    const Picture    picture = make_picture(floor_before_glow(0.4F));
    const Reflection full    = reflection_with(picture, {chosen(Gloss::stochastic)}),
                     half    = reflection_with(picture, {chosen(Gloss::stochastic), chosen(TraceResolution::half)});
    for (size_t i = 0; i < full.size(); ++i) ASSERT_EQ(full[i].a >= 0, half[i].a >= 0) << i;
}

} // namespace
} // namespace ssrlab::test
