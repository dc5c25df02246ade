#include "trace/lab.h"

#include "core/error.h"
#include "shared.h"
#include "trace/lab_passes.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace ssrlab {

struct Tracer {
    LabPtr      lab;
    RayBuffers  rays;
    Buffer      view;   // in the precision of the rays
    Buffer      work;   // of each ray; empty in a timed tracer
    Buffer      visits; // of the one ray that is recorded, or empty
    TracePasses passes;
};

namespace {

LabPtr with_structures(Gpu& gpu, Lab lab)
{
    while (static_cast<int>(lab.gbuffer->layers.size()) + 1 < lab.settings.layers)
        lab.gbuffer->layers.push_back(make_gbuffer(gpu, lab.gbuffer->view, Filled::uploaded));
    const ShaderFilesHeld held(gpu);
    lab.structures = make_depth_structures(gpu, lab);
    return std::make_shared<const Lab>(std::move(lab));
}

} // namespace

LabPtr make_lab(Gpu& gpu, const Catalogue& catalogue, const GBufferPtr& gbuffer, const Technique& technique,
                const ParameterValues& values, const TraceSettings& settings)
{
    require_bounded(technique, values);
    return with_structures(
        gpu, {gbuffer, technique, values, settings, find_surface(catalogue.surfaces, settings.surface), {}});
}

LabPtr lab_on(Gpu& gpu, const Lab& lab, const GBufferPtr& gbuffer)
{
    return with_structures(gpu, {gbuffer, lab.technique, lab.values, lab.settings, lab.surface, {}});
}

namespace {

constexpr uint64_t most_visits = 1 << 16;

enum class Counted : uint8_t { nothing, work, work_and_visits };

TracerPtr make_any_tracer(Gpu& gpu, const LabPtr& lab, size_t capacity, NumberFormat number_format, Counted counted)
{
    if (number_format == NumberFormat::float64 && !gpu.info.float64)
        throw_failure("the device '{}' has no double precision", gpu.info.name);
    const ShaderFilesHeld held(gpu);
    auto                  tracer = std::make_shared<Tracer>();
    tracer->lab                  = lab;
    tracer->rays                 = make_ray_buffers(gpu, capacity, number_format);
    tracer->view                 = upload_view(gpu, lab->gbuffer->view, number_format);
    const uint64_t rays          = std::max<uint64_t>(capacity, 1);
    const bool     works         = counted != Counted::nothing;
    const bool     records       = counted == Counted::work_and_visits;
    if (works) tracer->work = make_buffer(gpu, rays * work_words(lab->technique) * sizeof(uint32_t));
    if (records) {
        tracer->visits      = make_buffer(gpu, sizeof(uint32_t) + most_visits * sizeof(glm::uvec4));
        const uint32_t none = 0;
        upload(gpu, tracer->visits, &none, sizeof(none));
    }
    tracer->passes =
        make_trace_passes(gpu, *lab, tracer->rays, tracer->view, {},
                          {.work = works ? &tracer->work : nullptr, .visits = records ? &tracer->visits : nullptr});
    return tracer;
}

template <typename Real> void upload_rays(Gpu& gpu, RayBuffers& buffers, std::span<const RayInput> rays)
{
    std::vector<PackedRay<Real>> listed;
    for (const RayInput& ray : rays)
        listed.push_back({ray.origin_px_depth, static_cast<Real>(ray.length_m), ray.delta_px_depth,
                          pack_pixel(ray.pixel, static_cast<int>(ray.end_status))});
    set_ray_count(gpu, buffers, rays.size());
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

bool counts_work(const Tracer& tracer) { return bool(*tracer.work.buffer); }

template <typename Real> std::vector<RayOutcome> read_outcomes(Gpu& gpu, const Tracer& tracer, size_t count)
{
    const auto   hits       = download_as<PackedHit<Real>>(gpu, tracer.rays.hits, count);
    const size_t words      = work_words(tracer.lab->technique);
    const auto   structures = static_cast<ptrdiff_t>(tracer.lab->technique.structures.size());
    const auto   works =
        counts_work(tracer) ? download_as<uint32_t>(gpu, tracer.work, count * words) : std::vector<uint32_t>(words);
    std::vector<RayOutcome> outcomes(count);
    for (size_t i = 0; i < count; ++i) {
        const std::span own(works.data() + (counts_work(tracer) ? i * words : 0), words);
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

bool in_double(const Tracer& tracer) { return tracer.rays.number_format == NumberFormat::float64; }

} // namespace

TracerPtr make_tracer(Gpu& gpu, const LabPtr& lab, size_t capacity, NumberFormat number_format)
{
    return make_any_tracer(gpu, lab, capacity, number_format, Counted::work);
}

TracerPtr make_tracer(Gpu& gpu, const LabPtr& lab, NumberFormat number_format)
{
    return make_tracer(gpu, lab, count_gbuffer(gpu, *lab->gbuffer, lab->settings).reflecting_pixels, number_format);
}

TracerPtr make_timed_tracer(Gpu& gpu, const LabPtr& lab, size_t capacity)
{
    return make_any_tracer(gpu, lab, capacity, NumberFormat::float32, Counted::nothing);
}

TracerPtr make_timed_tracer(Gpu& gpu, const LabPtr& lab)
{
    return make_timed_tracer(gpu, lab, count_gbuffer(gpu, *lab->gbuffer, lab->settings).reflecting_pixels);
}

TraceImage trace_gbuffer(Gpu& gpu, Tracer& tracer)
{
    submit(gpu, [&](const Commands& commands) {
        record_rays(commands, tracer.passes, *tracer.lab->gbuffer);
        record_depth_structures(commands, *tracer.lab);
        record_technique(commands, tracer.passes.technique, tracer.rays);
        barrier(commands);
    });
    const Buffer* work = counts_work(tracer) ? &tracer.work : nullptr;
    return in_double(tracer) ? read_result<double>(gpu, *tracer.lab, tracer.rays, work)
                             : read_result<float>(gpu, *tracer.lab, tracer.rays, work);
}

double time_trace(Gpu& gpu, Tracer& tracer, int times)
{
    const Timestamps timestamps = make_timestamps(gpu, 2);
    submit(gpu, [&](const Commands& commands) {
        barrier(commands);
        for (int time = 1; time <= times; ++time) {
            if (time == times) write_timestamp(commands, timestamps, 0);
            record_depth_structures(commands, *tracer.lab);
            record_technique(commands, tracer.passes.technique, tracer.rays);
            barrier(commands);
        }
        write_timestamp(commands, timestamps, 1);
    });
    return read_intervals_ms(gpu, timestamps)[0];
}

RecordedRay record_ray(Gpu& gpu, const LabPtr& lab, const RayInput& ray)
{
    const auto  tracer = make_any_tracer(gpu, lab, 1, NumberFormat::float32, Counted::work_and_visits);
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

std::vector<RayInput> set_up_rays(Gpu& gpu, Tracer& tracer)
{
    submit(gpu, [&](const Commands& commands) { record_rays(commands, tracer.passes, *tracer.lab->gbuffer); });
    return in_double(tracer) ? read_rays<double>(gpu, tracer.rays) : read_rays<float>(gpu, tracer.rays);
}

std::vector<RayOutcome> trace_rays(Gpu& gpu, Tracer& tracer, std::span<const RayInput> rays)
{
    if (rays.size() > tracer.rays.capacity)
        throw std::logic_error("trace_rays: more rays than the tracer has room for");
    if (rays.empty()) return {};
    if (in_double(tracer))
        upload_rays<double>(gpu, tracer.rays, rays);
    else
        upload_rays<float>(gpu, tracer.rays, rays);
    submit(gpu, [&](const Commands& commands) {
        barrier(commands);
        record_depth_structures(commands, *tracer.lab);
        record_technique(commands, tracer.passes.technique, tracer.rays);
        barrier(commands);
    });
    return in_double(tracer) ? read_outcomes<double>(gpu, tracer, rays.size())
                             : read_outcomes<float>(gpu, tracer, rays.size());
}

void replace_picture(Gpu& gpu, Tracer& tracer, const GBufferImage& image)
{
    GBuffer& gbuffer = *tracer.lab->gbuffer;
    if (image.view.size_px != gbuffer.view.size_px || image.view.projection != gbuffer.view.projection)
        throw std::logic_error("replace_picture: size or projection differ");
    gbuffer.view = image.view;
    gbuffer.counts.clear();
    upload_surfaces(gpu, gbuffer, image);
    write_view(gpu, gbuffer.view_uniforms, image.view, NumberFormat::float32);
    write_view(gpu, tracer.view, image.view, tracer.rays.number_format);
}

} // namespace ssrlab
