#include "render/motion_vectors.h"

#include "render/gbuffer.h"
#include "shared.h"

namespace ssrlab {
namespace {

/// shaders/gbuffer/motion_vectors.comp, uniform PreviousView, scalar layout.
struct PreviousViewBlock {
    glm::vec2 focal_px, centre_px, jitter_px;
};

} // namespace

MotionVectors make_motion_vectors(Gpu& gpu, const GBuffer& gbuffer, const FrameMotion& motion)
{
    const View&             previous = motion.previous_view;
    const PreviousViewBlock block{glm::vec2(previous.focal_px), glm::vec2(previous.centre_px),
                                  glm::vec2(gbuffer.view.centre_px - motion.view.centre_px)};
    // In double: world positions may be far larger than motions.
    const glm::dmat4       view_to_world = glm::inverse(motion.view.world_to_view);
    std::vector<glm::mat4> to_previous_vs{glm::mat4(previous.world_to_view * view_to_world)};
    for (const glm::dmat4& matrix : motion.to_previous_ws)
        to_previous_vs.emplace_back(previous.world_to_view * matrix * view_to_world);

    MotionVectors vectors;
    vectors.vectors_px    = make_image(gpu, {.format  = vk::Format::eR32G32Sfloat,
                                             .size_px = gbuffer.view.size_px,
                                             .usage   = vk::ImageUsageFlagBits::eStorage});
    vectors.previous_view = make_buffer(gpu, sizeof(block));
    upload(gpu, vectors.previous_view, &block, sizeof(block));
    vectors.objects = make_buffer_with<glm::mat4>(gpu, to_previous_vs);
    Constants constants;
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(gbuffer.view.projection == Projection::orthographic));
    vectors.pass = make_compute_pass(gpu, compile_shader({.file = "gbuffer/motion_vectors.comp"}),
                                     {{"View", gbuffer.view_uniforms},
                                      {"depth_words", gbuffer.depth.words},
                                      {"object_image", gbuffer.object},
                                      {"motion_image", vectors.vectors_px},
                                      {"PreviousView", vectors.previous_view},
                                      {"Objects", vectors.objects}},
                                     constants);
    return vectors;
}

void record_motion_vectors(const vk::raii::CommandBuffer& commands, const MotionVectors& vectors)
{
    dispatch(commands, vectors.pass, groups_of_8(vectors.vectors_px.size_px));
}

} // namespace ssrlab
