// The passes of a frame, as frame.cpp strings them together. Folder-internal.
#pragma once

#include "render/gbuffer.h"

namespace ssrlab {

/// The list of rays and what each found (shaders/rays.comp, trace.comp).
struct RayBuffers {
    Precision precision = Precision::float32;
    size_t    capacity  = 0;
    Buffer    count, launch, origins, deltas, lengths, pixels, hit_pixels, hit_ts;
};
/// The uniform block of shaders/view.glsl.
Buffer     upload_view(Gpu& gpu, const View& view, Precision precision);
void       write_view(Gpu& gpu, Buffer& target, const View& view, Precision precision);
RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, Precision precision);

/// All levels >= 1 of the depth pyramid in one atlas; level L begins at x = width - (width >> (L - 1)).
struct PyramidImages {
    GpuImage atlas;
    int      levels = 0; // above level 0, which is the depth image itself
};
PyramidImages make_pyramid_images(Gpu& gpu, glm::ivec2 size_px);

struct FrameBuffers {
    GBufferPtr    gbuffer;
    Buffer        view; // float
    RayBuffers    rays; // float
    PyramidImages pyramid;
    GpuImage      shaded; // RGBA16F
    ComputePass   lit;    // shaded = radiance + highlight
};

struct PyramidPush {
    int32_t    level;
    glm::ivec2 source_size, size, source_offset, offset;
};
struct PyramidPasses {
    ComputePass              build;
    std::vector<PyramidPush> levels; // empty: the technique reads no pyramid
};

struct TracePasses {
    ComputePass rays, launch, trace;
};

struct PreparedFrame {
    FrameBuffersPtr buffers;
    Technique       technique;
    ParameterValues values;
    FrameSettings   settings;
    PyramidPasses   pyramid;
    TracePasses     trace;
    ComputePass     shade;
    Timestamps      timestamps;
};

PyramidPasses make_pyramid_passes(Gpu& gpu, const PreparedFrame& frame);
/// work: steps, depth and pyramid fetches per ray, or null for the pipeline that is timed.
TracePasses make_trace_passes(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Buffer& view,
                              const Buffer* work);
ComputePass make_shade_pass(Gpu& gpu, const PreparedFrame& frame);

void record_rays(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const RayBuffers& rays,
                 glm::ivec2 size_px);
void record_pyramid(const vk::raii::CommandBuffer& commands, const PyramidPasses& passes);

template <typename Real>
TraceResult read_result(Gpu& gpu, glm::ivec2 size_px, const RayBuffers& rays, const Buffer* work);

float half_to_float(uint16_t half);

} // namespace ssrlab
