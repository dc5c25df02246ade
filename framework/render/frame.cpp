#include "core/error.h"
#include "render/frame_passes.h"
#include "shared.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// shaders/view.glsl, uniform View, scalar layout.
template <typename Real> struct ViewBlock {
    glm::vec<2, Real> focal_px, centre_px;
    Real              near_m, far_m;
    glm::ivec2        size_px;
};

template <typename Real> void write_view_as(Gpu& gpu, Buffer& target, const View& view)
{
    const ViewBlock<Real> block{glm::vec<2, Real>(view.focal_px), glm::vec<2, Real>(view.centre_px),
                                static_cast<Real>(view.near_m), static_cast<Real>(view.far_m), view.size_px};
    upload(gpu, target, &block, sizeof(block));
}

size_t count_reflecting(Gpu& gpu, const GBuffer& gbuffer)
{
    const GBufferImage image = read_gbuffer(gpu, gbuffer);
    size_t             count = 0;
    for (size_t i = 0; i < image.depth.size(); ++i) count += image.depth[i] > 0 && image.metallic[i] > 0;
    return count;
}

glm::uvec3 groups_of_8(glm::ivec2 size_px)
{
    return {static_cast<uint32_t>(size_px.x + 7) / 8, static_cast<uint32_t>(size_px.y + 7) / 8, 1};
}

} // namespace

void write_view(Gpu& gpu, Buffer& target, const View& view, Precision precision)
{
    if (precision == Precision::float64)
        write_view_as<double>(gpu, target, view);
    else
        write_view_as<float>(gpu, target, view);
}

Buffer upload_view(Gpu& gpu, const View& view, Precision precision)
{
    Buffer buffer = make_buffer(gpu, sizeof(ViewBlock<double>));
    write_view(gpu, buffer, view, precision);
    return buffer;
}

RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, Precision precision)
{
    const uint64_t real_bytes = precision == Precision::float64 ? 8 : 4;
    const uint64_t rays       = std::max<uint64_t>(capacity, 1);
    const uint64_t largest    = rays * 3 * real_bytes;
    if (largest > gpu.impl->limits.maxStorageBufferRange)
        throw_failure("{} rays need a buffer of {} MiB; the device allows {} MiB", rays, largest >> 20,
                      gpu.impl->limits.maxStorageBufferRange >> 20);
    RayBuffers buffers;
    buffers.precision  = precision;
    buffers.capacity   = capacity;
    buffers.count      = make_buffer(gpu, 16);
    buffers.launch     = make_buffer(gpu, 16);
    buffers.origins    = make_buffer(gpu, largest);
    buffers.deltas     = make_buffer(gpu, largest);
    buffers.lengths    = make_buffer(gpu, rays * real_bytes);
    buffers.pixels     = make_buffer(gpu, rays * 4);
    buffers.hit_pixels = make_buffer(gpu, rays * 4);
    buffers.hit_ts     = make_buffer(gpu, rays * real_bytes);
    return buffers;
}

FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer)
{
    auto buffers     = std::make_shared<FrameBuffers>();
    buffers->gbuffer = gbuffer;
    buffers->view    = upload_view(gpu, gbuffer->view, Precision::float32);
    buffers->rays    = make_ray_buffers(gpu, count_reflecting(gpu, *gbuffer), Precision::float32);
    buffers->shaded  = make_image(gpu, {.format  = vk::Format::eR16G16B16A16Sfloat,
                                        .size_px = gbuffer->view.size_px,
                                        .usage   = vk::ImageUsageFlagBits::eStorage});
    buffers->lit     = make_compute_pass(gpu, compile_shader({.file = "lit.comp"}),
                                         {{"radiance_image", gbuffer->radiance},
                                          {"highlight_image", gbuffer->highlight},
                                          {"shaded_image", buffers->shaded}});
    buffers->pyramid = make_pyramid_images(gpu, gbuffer->view.size_px);
    return buffers;
}

PreparedFramePtr prepare_frame(Gpu& gpu, const FrameBuffersPtr& buffers, const Technique& technique,
                               const ParameterValues& values, const FrameSettings& settings)
{
    require_bounded(technique, values);
    auto frame       = std::make_shared<PreparedFrame>();
    frame->buffers   = buffers;
    frame->technique = technique;
    frame->values    = values;
    frame->settings  = settings;
    frame->pyramid =
        std::ranges::count(technique.inputs, "depth_pyramid") > 0 ? make_pyramid_passes(gpu, *frame) : PyramidPasses{};
    frame->trace      = make_trace_passes(gpu, *frame, buffers->rays, buffers->view, nullptr);
    frame->shade      = make_shade_pass(gpu, *frame);
    frame->timestamps = make_timestamps(gpu, 5);
    return frame;
}

PassTimes run_frame(Gpu& gpu, PreparedFrame& frame)
{
    FrameBuffers& buffers = *frame.buffers;
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        write_timestamp(commands, frame.timestamps, 0);
        record_rays(commands, frame.trace, buffers.rays, buffers.gbuffer->view.size_px);
        write_timestamp(commands, frame.timestamps, 1);
        record_pyramid(commands, frame.pyramid);
        write_timestamp(commands, frame.timestamps, 2);
        dispatch_indirect(commands, frame.trace.trace, buffers.rays.launch);
        barrier(commands);
        write_timestamp(commands, frame.timestamps, 3);
        dispatch(commands, buffers.lit, groups_of_8(buffers.gbuffer->view.size_px));
        barrier(commands);
        dispatch_indirect(commands, frame.shade, buffers.rays.launch);
        barrier(commands);
        write_timestamp(commands, frame.timestamps, 4);
    });
    const auto intervals = read_intervals_ms(gpu, frame.timestamps);
    return {intervals[0], intervals[1], intervals[2], intervals[3]};
}

TraceResult count_frame(Gpu& gpu, PreparedFrame& frame, Precision precision)
{
    if (precision == Precision::float64 && !gpu.info.float64)
        throw_failure("the device '{}' has no double precision", gpu.info.name);
    const GBuffer&    gbuffer = *frame.buffers->gbuffer;
    const RayBuffers  rays    = make_ray_buffers(gpu, frame.buffers->rays.capacity, precision);
    const Buffer      work    = make_buffer(gpu, std::max<uint64_t>(rays.capacity, 1) * 12);
    const Buffer      view    = upload_view(gpu, gbuffer.view, precision);
    const TracePasses passes  = make_trace_passes(gpu, frame, rays, view, &work);
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        record_rays(commands, passes, rays, gbuffer.view.size_px);
        record_pyramid(commands, frame.pyramid);
        dispatch_indirect(commands, passes.trace, rays.launch);
        barrier(commands);
    });
    return precision == Precision::float64 ? read_result<double>(gpu, gbuffer.view.size_px, rays, &work)
                                           : read_result<float>(gpu, gbuffer.view.size_px, rays, &work);
}

Image read_shaded(Gpu& gpu, PreparedFrame& frame)
{
    const auto texels = download_as<std::array<uint16_t, 4>>(gpu, frame.buffers->shaded);
    Image      image{frame.buffers->gbuffer->view.size_px, {"R", "G", "B"}, {}, {}};
    image.values.reserve(texels.size() * 3);
    for (const auto& texel : texels)
        for (size_t c = 0; c < 3; ++c) image.values.push_back(half_to_float(texel[c]));
    return image;
}

} // namespace ssrlab
