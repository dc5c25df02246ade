// Pipelines are made once: for equal shaders and constants, with a store that stays small, of files as they are, and for all pictures of a scene.
#include "core/files.h"
#include "frame/drawing.h"
#include "gpu/compute.h"
#include "gpu/device.h"
#include "shared.h"

namespace ssrlab::test {
namespace {

struct Launch {
    Buffer rays   = make_buffer_with<uint32_t>(device(), std::vector<uint32_t>{1000});
    Buffer launch = make_buffer(device(), sizeof(glm::uvec3)), groups = make_buffer(device(), sizeof(glm::uvec3));

    ComputePass pass(int rays_per_workgroup, std::optional<float> of_no_use = {})
    {
        Constants constants;
        if (of_no_use) constants.add(CONSTANT_SLAB_SCALE, *of_no_use);
        constants.add(CONSTANT_RAYS_PER_WORKGROUP, rays_per_workgroup);
        return make_compute_pass(device(), compile_shader(device(), {.file = "trace/dispatch_args.comp"}),
                                 {{"RayCount", rays}, {"RayLaunch", launch}, {"GroupLaunch", groups}}, constants);
    }

    /// Workgroups that the pass computes.
    uint32_t run(const ComputePass& pass)
    {
        submit(device(), [&](const Commands& commands) {
            dispatch(commands, pass, {1, 1, 1});
            barrier(commands);
        });
        return download_as<uint32_t>(device(), groups, 3)[0];
    }
};

TEST(Pipelines, AreSharedByEqualConstantsOnly)
{
    Launch            a, b;
    const ComputePass first = a.pass(10), again = b.pass(10), other = a.pass(25);
    EXPECT_EQ(first.compute, again.compute);
    EXPECT_NE(first.compute, other.compute);
    EXPECT_EQ(a.run(first), 100U);
    EXPECT_EQ(a.run(other), 40U);
    EXPECT_EQ(b.run(again), 100U); // with its own buffers
}

TEST(Pipelines, AreSharedWhereNoConstantThatTheShaderUsesDiffers)
{
    Launch            launch;
    const ComputePass first = launch.pass(10, 0.5F), again = launch.pass(10, 0.25F), other = launch.pass(25, 0.5F);
    EXPECT_EQ(first.compute, again.compute);
    EXPECT_NE(first.compute, other.compute);
    EXPECT_EQ(launch.run(again), 100U);
    EXPECT_EQ(launch.run(other), 40U);
}

TEST(Pipelines, KnowTheConstantsThatAShaderUses)
{
    EXPECT_EQ(compile_shader(device(), {.file = "trace/dispatch_args.comp"}).constants,
              std::set<uint32_t>{CONSTANT_RAYS_PER_WORKGROUP});
    const auto of_rays = compile_shader(device(), {.file = "rays/rays.comp"}).constants;
    EXPECT_TRUE(of_rays.contains(CONSTANT_MAX_DISTANCE_M));
    EXPECT_FALSE(of_rays.contains(CONSTANT_SLAB_SLOPE));
}

TEST(Pipelines, ThatWereForgottenGoOnForThoseWhoHoldThem)
{
    Launch            launch;
    const ComputePass first = launch.pass(10);
    for (int i = 1; i <= 300; ++i) launch.pass(100 + i);
    EXPECT_LE(device().impl->known_pipelines.size(), 256U);
    EXPECT_NE(launch.pass(10).compute, first.compute);
    EXPECT_EQ(launch.run(first), 100U);
}

TEST(Pipelines, AreAllReadyWhenTheyAreFinished)
{
    Launch launch;
    for (int i = 1; i <= 8; ++i) launch.pass(1000 + i);
    finish_pipelines(device());
    for (const auto& [key, known] : device().impl->known_pipelines)
        EXPECT_EQ(known.pipeline->pipeline.wait_for(std::chrono::seconds(0)), std::future_status::ready);
}

TEST(Pipelines, SeeAFileThatWasEditedUnlessFilesAreHeld)
{
    const std::filesystem::path file  = std::filesystem::path(::testing::TempDir()) / "edited.comp";
    const auto                  write = [&](int groups) {
        write_file_atomically(file, fmt::format("layout(local_size_x = {}) in;\nvoid main() {{}}\n", groups));
    };
    const auto size = [&] { return group_size(compile_shader(device(), {.file = file})); };
    write(2);
    EXPECT_EQ(size(), 2U);
    write(16);
    EXPECT_EQ(size(), 16U);
    {
        const ShaderFilesHeld held(device()), twice(device());
        EXPECT_EQ(size(), 16U);
        write(128);
        EXPECT_EQ(size(), 16U);
    }
    EXPECT_EQ(size(), 128U);
    std::filesystem::remove(file);
}

TEST(Pipelines, OfAGBufferAreSharedByThePicturesOfAScene)
{
    const Picture    a        = make_picture("builtin:sphere_over_mirror", "default", {31, 17});
    const Picture    b        = make_picture("builtin:sphere_over_mirror", "default", {40, 24});
    const DrawingPtr second_a = make_second_layer(device(), *a.drawing),
                     second_b = make_second_layer(device(), *b.drawing);
    EXPECT_EQ(a.drawing->pipeline, b.drawing->pipeline);
    EXPECT_EQ(second_a->pipeline, second_b->pipeline);
    EXPECT_NE(a.drawing->pipeline, second_a->pipeline);
}

} // namespace
} // namespace ssrlab::test
