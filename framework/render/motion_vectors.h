// Where the surface of each pixel was in the frame before. Folder-internal.
#pragma once

#include "gpu/compute.h"
#include "scene/sequence.h"

namespace ssrlab {

struct GBuffer;

struct MotionVectors {
    GpuImage    vectors_px; // RG32F, GBufferImage::motion_px
    Buffer      previous_view, objects;
    ComputePass pass;
};

MotionVectors make_motion_vectors(Gpu& gpu, const GBuffer& gbuffer, const FrameMotion& motion);
void          record_motion_vectors(const vk::raii::CommandBuffer& commands, const MotionVectors& vectors);

} // namespace ssrlab
