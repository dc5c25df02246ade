#include "frame/motion_vectors.h"

#include "shared.h"
#include "trace/gbuffer.h"

namespace ssrlab {
namespace {

/// shaders/passes/previous_frame.glsl, uniform PreviousView, scalar layout; motion_vectors.comp knows its beginning.
struct PreviousViewBlock {
    glm::vec2 focal_px, centre_px, jitter_px, previous_jitter_px;
    float     near_m, far_m;
    int32_t   takes_history, stands_still;
};

} // namespace

MotionBuffers make_motion_buffers(Gpu& gpu, const View& view, const FrameMotion& motion, glm::dvec2 previous_jitter_px,
                                  bool repeats)
{
    const View&             previous = motion.previous_view;
    const PreviousViewBlock block{glm::vec2(previous.focal_px),
                                  glm::vec2(previous.centre_px),
                                  glm::vec2(view.centre_px - motion.view.centre_px),
                                  glm::vec2(previous_jitter_px),
                                  static_cast<float>(previous.near_m),
                                  static_cast<float>(previous.far_m),
                                  repeats ? 0 : 1,
                                  motion.camera_moves || motion.moving_draws > 0 ? 0 : 1};
    // In double: world positions may be far larger than motions.
    const glm::dmat4       view_to_world = glm::inverse(motion.view.world_to_view);
    std::vector<glm::mat4> to_previous_vs{glm::mat4(previous.world_to_view * view_to_world)};
    for (const glm::dmat4& matrix : motion.to_previous_ws)
        to_previous_vs.emplace_back(previous.world_to_view * matrix * view_to_world);
    MotionBuffers buffers{make_buffer(gpu, sizeof(block)), make_buffer_with<glm::mat4>(gpu, to_previous_vs)};
    upload(gpu, buffers.previous_view, &block, sizeof(block));
    return buffers;
}

MotionVectors make_motion_vectors(Gpu& gpu, GBuffer& gbuffer, const FrameMotion& motion)
{
    MotionVectors vectors;
    vectors.motion    = make_motion_buffers(gpu, gbuffer.view, motion);
    gbuffer.motion_px = make_storage_image(gpu, vk::Format::eR32G32Sfloat, gbuffer.view.size_px);
    Constants constants;
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(gbuffer.view.projection == Projection::orthographic));
    vectors.pass = make_compute_pass(gpu, compile_shader(gpu, {.file = "gbuffer/motion_vectors.comp"}),
                                     {{"View", gbuffer.view_uniforms},
                                      {"depth_words", depth_bindings(gbuffer.depth).at("depth_words")},
                                      {"object_image", gbuffer.object},
                                      {"motion_image", *gbuffer.motion_px},
                                      {"PreviousView", vectors.motion.previous_view},
                                      {"Objects", vectors.motion.objects}},
                                     constants);
    return vectors;
}

void record_motion_vectors(const Commands& commands, const MotionVectors& vectors, const GBuffer& gbuffer)
{
    dispatch(commands, vectors.pass, groups_of_8(gbuffer.view.size_px));
}

} // namespace ssrlab
