// Where the surface of each pixel was in the frame before. Folder-internal.
#pragma once

#include "gpu/compute.h"
#include "scene/sequence.h"

namespace ssrlab {

struct GBuffer;

/// A motion as shaders read it.
struct MotionBuffers {
    Buffer previous_view; // shaders/passes/previous_frame.glsl, uniform PreviousView
    Buffer objects;       // per object: this frame's view space to the previous one's; 0: what stands still
};

struct MotionVectors {
    MotionBuffers motion;
    ComputePass   pass;
};

/// Uploads a motion. `previous_jitter_px`: of the frame before. `repeats`: nothing has changed since.
MotionBuffers make_motion_buffers(Gpu& gpu, const View& view, const FrameMotion& motion,
                                  glm::dvec2 previous_jitter_px = {}, bool repeats = false);
/// Makes GBuffer::motion_px, with undefined content, and the pass that fills it.
MotionVectors make_motion_vectors(Gpu& gpu, GBuffer& gbuffer, const FrameMotion& motion);
void          record_motion_vectors(const Commands& commands, const MotionVectors& vectors, const GBuffer& gbuffer);

} // namespace ssrlab
