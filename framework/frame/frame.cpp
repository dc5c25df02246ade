#include "frame/frame.h"

#include "core/pixel_index.h"
#include "frame/frame_inputs.h"
#include "shared.h"

#include <algorithm>
#include <numeric>

namespace ssrlab {

double FrameTimes::of(const std::string& pass) const
{
    const auto found = std::ranges::find(passes_ms, pass, &std::pair<std::string, double>::first);
    return found == passes_ms.end() ? 0 : found->second;
}

double FrameTimes::total_ms() const
{
    return std::accumulate(passes_ms.begin(), passes_ms.end(), 0.0,
                           [](double sum, const auto& pass) { return sum + pass.second; });
}

namespace {

MotionBuffers motion_since(Gpu& gpu, const FrameInputs& inputs)
{
    const FrameMotion& motion = *inputs.buffers->drawing->motion;
    return make_motion_buffers(gpu, inputs.lab->gbuffer->view, motion,
                               inputs.history->view->centre_px - motion.previous_view.centre_px,
                               !inputs.plan.facts.history.changes);
}

} // namespace

RayChoice rays_of(const ParameterValues& passes)
{
    return {.every_surface = passes.at("skip_unneeded_passes") == 0,
            .per_pixel     = static_cast<int>(passes.at("rays_per_pixel")),
            .from_lobe     = draws_lobe_rays(passes),
            .block_px      = trace_block_px(passes)};
}

std::shared_ptr<RayBuffers> ray_buffers(Gpu& gpu, FrameBuffers& buffers, const GBufferCounts& counts,
                                        const ParameterValues& passes)
{
    const RayChoice              chosen    = rays_of(passes);
    const size_t                 pixels    = chosen.every_surface ? counts.surface_pixels : counts.reflecting_pixels;
    const size_t                 capacity  = pixels * static_cast<size_t>(chosen.per_pixel);
    const bool                   of_pixels = choice<RayList>(passes) == RayList::pixels;
    const int                    rays_of_pixels = of_pixels ? chosen.per_pixel : 0;
    const bool                   from_lobe      = of_pixels && chosen.from_lobe;
    std::shared_ptr<RayBuffers>& rays           = buffers.rays[{capacity, rays_of_pixels, from_lobe}];
    if (!rays) {
        rays = std::make_shared<RayBuffers>(make_ray_buffers(gpu, capacity, NumberFormat::float32, rays_of_pixels));
        rays->from_lobe = from_lobe;
    }
    return rays;
}

Buffer make_answers(Gpu& gpu, const RayBuffers& rays)
{
    return make_buffer(gpu, std::max<uint64_t>(rays.capacity, 1) * sizeof(RayLight), sizeof(RayLight));
}

GpuScene* scene_of(const FrameBuffers& buffers) { return buffers.drawing ? buffers.drawing->scene.get() : nullptr; }

FrameBuffersPtr make_frame_buffers(Gpu& gpu, const DrawingPtr& drawing)
{
    return make_frame_buffers(gpu, drawing->gbuffer, drawing);
}

FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer, const DrawingPtr& drawing)
{
    auto             buffers = std::make_shared<FrameBuffers>();
    const glm::ivec2 size_px = gbuffer->view.size_px, half_size_px = (size_px - 1) / 2 + 1;
    constexpr auto   colour = vk::Format::eR16G16B16A16Sfloat;
    buffers->gbuffer        = gbuffer;
    buffers->drawing        = drawing;
    buffers->reflection     = make_storage_image(gpu, colour, size_px);
    buffers->filtered       = make_storage_image(gpu, colour, size_px);
    buffers->small_colour   = make_storage_image(gpu, colour, half_size_px);
    buffers->block_pixel    = make_storage_image(gpu, vk::Format::eR32Uint, half_size_px);
    buffers->shaded         = make_storage_image(gpu, colour, size_px);
    buffers->dfg_table      = upload_dfg_table(gpu);
    const glm::vec3 ambient = drawing ? drawing->scene->ambient : glm::vec3(0);
    buffers->ambient        = make_buffer(gpu, 16);
    upload(gpu, buffers->ambient, &ambient, sizeof(ambient));
    return buffers;
}

FramePtr make_frame(Gpu& gpu, const LabPtr& lab, const FrameBuffersPtr& buffers, const FramePlan& plan,
                    const FrameHistoryPtr& history, Answers answers)
{
    const ShaderFilesHeld held(gpu);
    auto                  frame  = std::make_shared<ReadyFrame>();
    FrameInputs&          inputs = frame->inputs;
    inputs.lab                   = lab;
    inputs.buffers               = buffers;
    inputs.plan                  = plan;
    inputs.history               = history;
    // Whoever answers rays reads them from the list.
    if (answers == Answers::given)
        inputs.plan.values.insert_or_assign(chosen(RayList::rays).first, chosen(RayList::rays).second);
    const ParameterValues& values = inputs.plan.values;
    inputs.rays                   = ray_buffers(gpu, *buffers, plan.statistics.gbuffer, values);
    inputs.trace         = make_trace_passes(gpu, *lab, *inputs.rays, lab->gbuffer->view_uniforms, rays_of(values));
    inputs.answers_given = answers == Answers::given;
    if (inputs.answers_given || runs(plan, "missed_rays")) inputs.answers = make_answers(gpu, *inputs.rays);
    if (plan.facts.history.usable) inputs.motion = motion_since(gpu, inputs);
    for (const PlannedPass& planned : plan.passes)
        if (planned.runs)
            frame->record_functions.push_back(planned.pass->prepare(gpu, {inputs, *planned.pass, planned.id}));
    frame->timestamps = make_timestamps(gpu, static_cast<uint32_t>(frame->record_functions.size()) + 1);
    return frame;
}

CompiledFrame compile_frame(Gpu& gpu, const Catalogue& catalogue, const Technique& technique,
                            const ParameterValues& values, const FrameSettings& settings)
{
    CompiledFrame    result;
    const GBufferPtr gbuffer = make_gbuffer(gpu, camera_to_view(Camera{}, result.size_px), Filled::drawn);
    const auto       pixels  = static_cast<uint32_t>(pixel_count(gbuffer->view.size_px));
    const glm::uvec3 tiles   = groups_of_8(gbuffer->view.size_px);
    GBufferCounts    all{.surface_pixels = pixels, .reflecting_pixels = pixels, .reflecting_tiles = tiles.x * tiles.y};
    all.roughness_pixels[0] = all.roughness_pixels[ROUGHNESS_BINS / 4] = pixels / 2;
    const LabPtr          lab     = make_lab(gpu, catalogue, gbuffer, technique, values, settings.trace);
    const FrameBuffersPtr buffers = make_frame_buffers(gpu, gbuffer);
    const FramePtr        frame   = make_frame(
                 gpu, lab, buffers, plan_with(catalogue, *lab, *buffers, settings, nullptr, all, {pixels, pixels, 0}));
    result.pipelines = take_compiled(gpu);
    result.passes    = count_traffic(gpu, *frame);
    return result;
}

FrameTimes run_passes(Gpu& gpu, const ReadyFrame& frame, const Timestamps& timestamps, size_t first, size_t last,
                      int frames)
{
    const auto records = std::span(frame.record_functions).subspan(first, last - first);
    submit(gpu, [&](const Commands& commands) {
        for (int untimed = 1; untimed < frames; ++untimed)
            for (const RecordFunction& record : records) {
                record(commands);
                barrier(commands);
            }
        uint32_t timestamp = 0;
        write_timestamp(commands, timestamps, timestamp++);
        for (const RecordFunction& record : records) {
            record(commands);
            barrier(commands);
            write_timestamp(commands, timestamps, timestamp++);
        }
    });
    const auto intervals_ms = read_intervals_ms(gpu, timestamps);
    FrameTimes times;
    size_t     place = 0;
    for (const PlannedPass& planned : frame.inputs.plan.passes) {
        if (!planned.runs) continue;
        if (place >= first && place < last) times.passes_ms.emplace_back(planned.id, intervals_ms[place - first]);
        ++place;
    }
    return times;
}

FrameTimes run_frame(Gpu& gpu, ReadyFrame& frame, int frames)
{
    return run_passes(gpu, frame, frame.timestamps, 0, frame.record_functions.size(), frames);
}

Image read_shaded(Gpu& gpu, const ReadyFrame& frame)
{
    const auto texels = download_as<std::array<uint16_t, 4>>(gpu, frame.inputs.buffers->shaded);
    Image      image{frame.inputs.lab->gbuffer->view.size_px, {"R", "G", "B"}, {}, {}};
    image.values.reserve(texels.size() * 3);
    for (const auto& texel : texels)
        for (size_t c = 0; c < 3; ++c) image.values.push_back(half_to_float(texel[c]));
    return image;
}

} // namespace ssrlab
