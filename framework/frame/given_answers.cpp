// A frame in two parts, between which others may answer its rays.
#include "frame/frame_inputs.h"

#include <algorithm>

namespace ssrlab {
namespace {

/// The number of passes up to the last one that traces the frame's rays.
size_t passes_to_the_trace(const ReadyFrame& frame)
{
    size_t count = 0, place = 0;
    for (const PlannedPass& planned : frame.inputs.plan.passes) {
        if (!planned.runs) continue;
        ++place;
        if (planned.id == "trace" || planned.id == "hidden_layer") count = place;
    }
    return count;
}

} // namespace

FrameTimes trace_frame(Gpu& gpu, ReadyFrame& frame, FrameRays& rays)
{
    rays               = {};
    const size_t count = passes_to_the_trace(frame);
    if (count == 0) return {};
    const FrameTimes  times = run_passes(gpu, frame, make_timestamps(gpu, static_cast<uint32_t>(count) + 1), 0, count);
    const RayBuffers& buffers = *frame.inputs.rays;
    rays.per_pixel            = rays_of(frame.inputs.plan.values).per_pixel;
    for (const PackedRay<float>& ray : read_list<float>(gpu, buffers))
        rays.rays.push_back({glm::dvec3(ray.origin), glm::dvec3(ray.delta), static_cast<double>(ray.length_m),
                             unpack_status(ray.pixel), unpack_pixel(ray.pixel)});
    for (const PackedHit<float>& hit : download_as<PackedHit<float>>(gpu, buffers.hits, rays.rays.size()))
        rays.outcomes.push_back({unpack_status(hit.pixel), unpack_pixel(hit.pixel), static_cast<double>(hit.t), 0, 0, 0,
                                 unpack_layer(hit.pixel)});
    return times;
}

FrameTimes shade_frame(Gpu& gpu, ReadyFrame& frame, const FrameRays& rays, std::span<const RayLight> answers)
{
    const size_t first = passes_to_the_trace(frame), last = frame.record_functions.size();
    if (!rays.rays.empty()) {
        // For the passes after the trace, a ray that was answered elsewhere found nothing in the frame.
        auto                  hits = download_as<PackedHit<float>>(gpu, frame.inputs.rays->hits, rays.rays.size());
        std::vector<RayLight> lights(hits.size());
        std::ranges::copy(answers, lights.begin());
        for (size_t i = 0; i < hits.size(); ++i)
            if (lights[i].distance_m >= 0)
                hits[i].pixel = pack_pixel(rays.rays[i].pixel, static_cast<int>(TraceStatus::left_screen));
        upload(gpu, frame.inputs.answers, lights.data(), lights.size() * sizeof(RayLight));
        upload(gpu, frame.inputs.rays->hits, hits.data(), hits.size() * sizeof(hits[0]));
    }
    return run_passes(gpu, frame, make_timestamps(gpu, static_cast<uint32_t>(last - first) + 1), first, last);
}

} // namespace ssrlab
