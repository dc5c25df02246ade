// Rays drawn from the lobes of rough surfaces, and their reuse by neighbours.
#include "core/files.h"
#include "gpu/compute.h"
#include "gpu/passes.h"

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
    for (const auto [i, x, y] : pixels_of({32, 64})) image.roughness[at(image, x, y)] = 0;
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

struct AskedLobe {
    glm::vec3 to_eye, to_light;
    float     alpha;
};

std::vector<AskedLobe> random_lobes()
{
    std::mt19937                          random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    const auto                            above = [&] {
        const float z = 0.02F + 0.98F * unit(random), turn = 6.28F * unit(random), sine = std::sqrt(1 - z * z);
        return glm::vec3(sine * std::cos(turn), sine * std::sin(turn), z);
    };
    std::vector<AskedLobe> asked;
    while (asked.size() < 4096) asked.push_back({above(), above(), 0.01F + 0.9F * unit(random)});
    return asked;
}

// D G2 / (4 n.v) and D G1 / (4 n.v), as B. Walter et al. 2007 and E. Heitz 2014 have them.
TEST(LobeRays, ValueAndDensityAreThoseOfTheMicrofacetModel)
{
    const std::vector<AskedLobe> asked   = random_lobes();
    const Buffer                 given   = make_buffer_with<AskedLobe>(device(), asked);
    const Buffer                 answers = make_buffer(device(), asked.size() * sizeof(glm::vec2));
    const ComputePass            pass =
        make_compute_pass(device(), compile_shader(device(), {.file = data_root() / "tests/gpu/lobe.comp"}),
                          {{"AskedLobes", given}, {"FoundLobes", answers}});
    submit(device(), [&](const Commands& commands) {
        dispatch(commands, pass, {static_cast<uint32_t>(asked.size()) / 64, 1, 1});
        barrier(commands);
    });
    const auto found = download_as<glm::vec2>(device(), answers, asked.size());
    for (size_t i = 0; i < asked.size(); ++i) {
        const double alpha  = asked[i].alpha;
        const auto   lambda = [&](double cosine) {
            return (std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
        };
        const glm::dvec3 to_eye(asked[i].to_eye), to_light(asked[i].to_light);
        const double     n_h     = glm::normalize(to_eye + to_light).z;
        const double     spread  = n_h * n_h * (alpha * alpha - 1) + 1;
        const double     facets  = alpha * alpha / (std::numbers::pi * spread * spread);
        const double     value   = facets / (1 + lambda(to_eye.z) + lambda(to_light.z)) / (4 * to_eye.z);
        const double     density = facets / (1 + lambda(to_eye.z)) / (4 * to_eye.z);
        ASSERT_NEAR(found[i].x / value, 1, 2e-3) << i;
        ASSERT_NEAR(found[i].y / density, 1, 2e-3) << i;
    }
}

} // namespace
} // namespace ssrlab::test
