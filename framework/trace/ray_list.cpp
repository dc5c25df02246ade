#include "trace/ray_list.h"

#include "core/error.h"
#include "frame/layers.h"
#include "shared.h"
#include "trace/frame_passes.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace ssrlab {

struct RayTracer {
    PreparedFrame frame;
    RayBuffers    rays;
    Buffer        view; // in the precision of the trace
    Buffer        work;
    Buffer        visits; // of the one ray that is recorded, or empty
    TracePasses   passes;
};

namespace {

template <typename Real> void upload_rays(Gpu& gpu, RayBuffers& buffers, std::span<const RayInput> rays)
{
    std::vector<PackedRay<Real>> listed;
    for (const RayInput& ray : rays)
        listed.push_back({ray.origin_px_depth, static_cast<Real>(ray.length_m), ray.delta_px_depth,
                          pack_pixel(ray.pixel, static_cast<int>(ray.end_status))});
    const uint32_t count = static_cast<uint32_t>(rays.size());
    upload(gpu, buffers.count, &count, sizeof(count));
    upload(gpu, buffers.list, listed.data(), listed.size() * sizeof(listed[0]));
}

template <typename Real> std::vector<RayInput> read_rays(Gpu& gpu, const RayBuffers& buffers)
{
    std::vector<RayInput> rays;
    for (const PackedRay<Real>& ray : read_list<Real>(gpu, buffers))
        rays.push_back({glm::dvec3(ray.origin), glm::dvec3(ray.delta), static_cast<double>(ray.length_m),
                        unpack_status(ray.pixel), unpack_pixel(ray.pixel)});
    return rays;
}

template <typename Real> std::vector<RayOutcome> read_outcomes(Gpu& gpu, const RayTracer& tracer, size_t count)
{
    const auto              hits       = download_as<PackedHit<Real>>(gpu, tracer.rays.hits, count);
    const size_t            words      = work_words(tracer.frame.technique);
    const auto              structures = static_cast<ptrdiff_t>(tracer.frame.technique.structures.size());
    const auto              works      = download_as<uint32_t>(gpu, tracer.work, count * words);
    std::vector<RayOutcome> outcomes(count);
    for (size_t i = 0; i < count; ++i) {
        const std::span own(works.data() + i * words, words);
        outcomes[i] = {unpack_status(hits[i].pixel),
                       unpack_pixel(hits[i].pixel),
                       static_cast<double>(hits[i].t),
                       own[0],
                       own[1],
                       std::accumulate(own.begin() + 2, own.begin() + 2 + structures, 0U),
                       unpack_layer(hits[i].pixel)};
        if (outcomes[i].status == TraceStatus::impossible)
            outcomes[i] = {
                TraceStatus::impossible, {static_cast<int>(own[1]), static_cast<int>(own[2])}, 0, own[0], 0, 0, 0};
    }
    return outcomes;
}

bool in_double(const RayTracer& tracer) { return tracer.rays.precision == Precision::float64; }

} // namespace

namespace {

constexpr uint64_t most_visits = 1 << 16;

RayTracerPtr make_tracer(Gpu& gpu, const GBufferPtr& gbuffer, const Technique& technique, const ParameterValues& values,
                         const TraceSettings& settings, size_t capacity, Precision precision, bool records)
{
    if (precision == Precision::float64 && !gpu.info.float64)
        throw_failure("the device '{}' has no double precision", gpu.info.name);
    require_bounded(technique, values);
    prepare_layers(gpu, *gbuffer, settings);
    auto tracer          = std::make_shared<RayTracer>();
    auto buffers         = std::make_shared<FrameBuffers>();
    buffers->gbuffer     = gbuffer;
    buffers->tiles       = make_tile_buffers(gpu, gbuffer->view.size_px);
    buffers->view        = upload_view(gpu, gbuffer->view, Precision::float32);
    tracer->view         = upload_view(gpu, gbuffer->view, precision);
    PreparedFrame& frame = tracer->frame;
    frame.buffers        = buffers;
    frame.technique      = technique;
    frame.values         = values;
    frame.settings.trace = settings;
    frame.structures     = make_depth_structures(gpu, frame, *gbuffer);
    tracer->rays         = make_ray_buffers(gpu, capacity, precision);
    tracer->work         = make_buffer(gpu, std::max<uint64_t>(capacity, 1) * work_words(technique) * sizeof(uint32_t));
    if (records) {
        tracer->visits      = make_buffer(gpu, sizeof(uint32_t) + most_visits * sizeof(glm::uvec4));
        const uint32_t none = 0;
        upload(gpu, tracer->visits, &none, sizeof(none));
    }
    tracer->passes =
        make_trace_passes(gpu, frame, tracer->rays, tracer->view, &tracer->work, records ? &tracer->visits : nullptr);
    return tracer;
}

} // namespace

RayTracerPtr make_ray_tracer(Gpu& gpu, const GBufferPtr& gbuffer, const Technique& technique,
                             const ParameterValues& values, const TraceSettings& settings, size_t capacity,
                             Precision precision)
{
    return make_tracer(gpu, gbuffer, technique, values, settings, capacity, precision, false);
}

RecordedRay record_ray(Gpu& gpu, const GBufferPtr& gbuffer, const Technique& technique, const ParameterValues& values,
                       const TraceSettings& settings, const RayInput& ray)
{
    const auto  tracer = make_tracer(gpu, gbuffer, technique, values, settings, 1, Precision::float32, true);
    RecordedRay recorded{trace_rays(gpu, *tracer, std::span(&ray, 1))[0], {}, 0};
    const auto  words    = download_as<uint32_t>(gpu, tracer->visits, 1 + 4 * most_visits);
    recorded.visit_count = words[0];
    for (size_t i = 0; i < std::min<size_t>(words[0], most_visits); ++i) {
        const uint32_t* word = &words[1 + 4 * i];
        recorded.visits.push_back({{static_cast<int>(word[0] & 0xFFFFU), static_cast<int>(word[0] >> 16U)},
                                   static_cast<int>(word[1]),
                                   static_cast<double>(std::bit_cast<float>(word[2])),
                                   static_cast<double>(std::bit_cast<float>(word[3]))});
    }
    return recorded;
}

std::vector<RayInput> set_up_rays(Gpu& gpu, RayTracer& tracer)
{
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        record_rays(commands, tracer.passes, *tracer.frame.buffers);
    });
    return in_double(tracer) ? read_rays<double>(gpu, tracer.rays) : read_rays<float>(gpu, tracer.rays);
}

std::vector<RayOutcome> trace_rays(Gpu& gpu, RayTracer& tracer, std::span<const RayInput> rays)
{
    if (rays.size() > tracer.rays.capacity)
        throw std::logic_error("trace_rays: more rays than the tracer has room for");
    if (rays.empty()) return {};
    if (in_double(tracer))
        upload_rays<double>(gpu, tracer.rays, rays);
    else
        upload_rays<float>(gpu, tracer.rays, rays);
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        barrier(commands);
        dispatch(commands, tracer.passes.ray_launch, {1, 1, 1});
        barrier(commands);
        record_depth_structures(commands, tracer.frame.structures);
        record_technique(commands, tracer.passes.technique, tracer.rays);
        barrier(commands);
    });
    return in_double(tracer) ? read_outcomes<double>(gpu, tracer, rays.size())
                             : read_outcomes<float>(gpu, tracer, rays.size());
}

void replace_picture(Gpu& gpu, RayTracer& tracer, const GBufferImage& image)
{
    GBuffer& gbuffer = *tracer.frame.buffers->gbuffer;
    if (image.view.size_px != gbuffer.view.size_px || image.view.projection != gbuffer.view.projection)
        throw std::logic_error("replace_picture: size or projection differ");
    gbuffer.view = image.view;
    upload_surfaces(gpu, gbuffer, image);
    write_view(gpu, tracer.frame.buffers->view, image.view, Precision::float32);
    write_view(gpu, tracer.view, image.view, tracer.rays.precision);
}

GBufferPtr upload_depth(Gpu& gpu, const View& view, std::span<const float> depth)
{
    auto gbuffer     = std::make_shared<GBuffer>();
    gbuffer->view    = view;
    const auto image = [&](vk::Format format, glm::ivec2 size_px) {
        return make_image(gpu, {.format = format, .size_px = size_px, .usage = vk::ImageUsageFlagBits::eStorage});
    };
    gbuffer->depth      = make_depth_buffer(gpu, view.size_px);
    gbuffer->normal     = image(vk::Format::eR32G32B32A32Sfloat, {1, 1});
    gbuffer->material   = image(vk::Format::eR16G16B16A16Sfloat, {1, 1});
    gbuffer->dielectric = image(vk::Format::eR32Sfloat, {1, 1});
    gbuffer->solid      = image(vk::Format::eR32Sfloat, {1, 1});
    write_depth(gpu, gbuffer->depth, usable_depth(depth), {});
    return gbuffer;
}

} // namespace ssrlab
