#include "core/error.h"
#include "core/pixel_index.h"
#include "core/stopwatch.h"
#include "frame/directional_albedo.h"
#include "frame/layers.h"
#include "shared.h"
#include "trace/frame_passes.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ssrlab {
namespace {

/// shaders/api/view.glsl, uniform View, scalar layout.
template <typename Real> struct ViewBlock {
    glm::ivec2        size_px;
    glm::vec<2, Real> focal_px, centre_px, focal_low_px, centre_low_px;
    Real              near_m, far_m;
};

template <typename Real> void write_view_as(Gpu& gpu, Buffer& target, const View& view)
{
    using Real2 = glm::vec<2, Real>;
    const Real2           focal_px(view.focal_px), centre_px(view.centre_px);
    const ViewBlock<Real> block{view.size_px,
                                focal_px,
                                centre_px,
                                Real2(view.focal_px - glm::dvec2(focal_px)),
                                Real2(view.centre_px - glm::dvec2(centre_px)),
                                static_cast<Real>(view.near_m),
                                static_cast<Real>(view.far_m)};
    upload(gpu, target, &block, sizeof(block));
}

} // namespace

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

RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, Precision precision, int rays_of_pixels)
{
    const uint64_t listed_bytes = rays_of_pixels > 0                ? sizeof(uint32_t)
                                  : precision == Precision::float64 ? sizeof(PackedRay<double>)
                                                                    : sizeof(PackedRay<float>);
    const uint64_t rays         = std::max<uint64_t>(capacity, 1);
    const uint64_t largest      = rays * sizeof(glm::uvec3); // what was counted of each, a storage buffer
    if (largest > gpu.impl->limits.maxStorageBufferRange)
        throw_failure("{} rays need a buffer of {} MiB; the device allows {} MiB", rays, largest >> 20,
                      gpu.impl->limits.maxStorageBufferRange >> 20);
    RayBuffers buffers;
    buffers.precision      = precision;
    buffers.capacity       = capacity;
    buffers.count          = make_buffer(gpu, 16);
    buffers.launch         = make_buffer(gpu, 16);
    buffers.list           = make_texel_buffer(gpu, rays * listed_bytes,
                                     rays_of_pixels > 0 ? vk::Format::eR32Uint : vk::Format::eR32G32B32A32Uint);
    buffers.rays_of_pixels = rays_of_pixels;
    buffers.hits           = precision == Precision::float64
                                 ? make_texel_buffer(gpu, rays * sizeof(PackedHit<double>), vk::Format::eR32G32B32A32Uint)
                                 : make_texel_buffer(gpu, rays * sizeof(PackedHit<float>), vk::Format::eR32G32Uint);

    buffers.group_launch = make_buffer(gpu, 16);
    buffers.structures   = std::make_shared<StructureBuffers>();
    return buffers;
}

namespace {

/// Counts on the device: the number of reflecting pixels decides how large the ray list is.
FrameStatistics count_gbuffer(Gpu& gpu, const FrameBuffers& buffers, const TraceSettings& settings)
{
    const View&      view  = buffers.gbuffer->view;
    const glm::uvec3 tiles = groups_of_8(view.size_px);
    FrameStatistics  statistics;
    statistics.pixels = static_cast<uint32_t>(view.size_px.x) * static_cast<uint32_t>(view.size_px.y);
    statistics.tiles  = tiles.x * tiles.y;
    Bindings bindings = surface_bindings(*buffers.gbuffer);
    bindings.insert(
        {{"View", buffers.view}, {"TileMasks", buffers.tiles.masks}, {"PictureStatistics", buffers.tiles.statistics}});
    Constants constants;
    add_reflecting(constants, settings);
    const Classification classification = make_classification(gpu, bindings, constants);
    submit(gpu, [&](const auto& commands) { record_marking(commands, classification, buffers); });
    statistics.gbuffer = download_as<GBufferCounts>(gpu, buffers.tiles.statistics, 1)[0];
    return statistics;
}

/// Counted once for each rule of what reflects.
const FrameStatistics& statistics_for(Gpu& gpu, FrameBuffers& buffers, const TraceSettings& settings)
{
    const std::pair rule(settings.dielectric_min_f0, settings.dielectric_max_roughness);
    const auto      known = buffers.statistics.find(rule);
    if (known != buffers.statistics.end()) return known->second;
    return buffers.statistics.emplace(rule, count_gbuffer(gpu, buffers, settings)).first->second;
}

std::shared_ptr<RayBuffers> rays_for(Gpu& gpu, FrameBuffers& buffers, const GBufferCounts& counts,
                                     const FrameSettings& settings)
{
    const size_t pixels =
        settings.passes.at("skip_unneeded_passes") == 0 ? counts.surface_pixels : counts.reflecting_pixels;
    const size_t capacity             = pixels * static_cast<size_t>(settings.passes.at("rays_per_pixel"));
    const bool   of_pixels            = choice<RayList>(settings.passes) == RayList::pixels;
    const int    rays_of_pixels       = of_pixels ? static_cast<int>(settings.passes.at("rays_per_pixel")) : 0;
    const bool   from_lobe            = of_pixels && draws_lobe_rays(settings.passes);
    std::shared_ptr<RayBuffers>& rays = buffers.rays[{capacity, rays_of_pixels, from_lobe}];
    if (!rays) {
        rays = std::make_shared<RayBuffers>(make_ray_buffers(gpu, capacity, Precision::float32, rays_of_pixels));
        rays->from_lobe = from_lobe;
    }
    return rays;
}

void upload_dfg_table(Gpu& gpu, FrameBuffers& buffers)
{
    std::vector<uint32_t> texels;
    for (const glm::vec2& entry : dfg_table()) texels.push_back(glm::packHalf2x16(entry));
    buffers.dfg_table   = make_image(gpu, {.format  = vk::Format::eR16G16Sfloat,
                                           .size_px = glm::ivec2(DFG_TABLE_ENTRIES),
                                           .usage   = vk::ImageUsageFlagBits::eSampled});
    buffers.dfg_sampler = {gpu.impl->device,
                           vk::SamplerCreateInfo{.magFilter    = vk::Filter::eLinear,
                                                 .minFilter    = vk::Filter::eLinear,
                                                 .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                                 .addressModeV = vk::SamplerAddressMode::eClampToEdge}};
    upload(gpu, buffers.dfg_table, texels.data(), texels.size() * sizeof(uint32_t));
}

/// "moving camera, 2 of 5 objects move, no jitter"
std::string describe_motion(const GBuffer& gbuffer, bool jittered)
{
    if (!gbuffer.motion) return "no frame before this one";
    const FrameMotion& motion = *gbuffer.motion;
    return fmt::format("{} camera, {} of {} objects move, {} jitter", motion.camera_moves ? "moving" : "still",
                       motion.moving_draws, motion.to_previous_ws.size(), jittered ? "with" : "no");
}

bool is_jittered(const GBuffer& gbuffer)
{
    return gbuffer.motion && gbuffer.view.centre_px != gbuffer.motion->view.centre_px;
}

HistoryFacts history_facts(const PreparedFrame& frame)
{
    if (!frame.history) return {};
    const GBuffer& gbuffer = *frame.buffers->gbuffer;
    if (const std::string mismatch = history_mismatch(*frame.history, gbuffer); !mismatch.empty())
        return {.state = mismatch};
    const FrameMotion& motion = *gbuffer.motion;
    const bool jittered = is_jittered(gbuffer) || frame.history->view->centre_px != motion.previous_view.centre_px;
    return {.usable  = true,
            .changes = motion.camera_moves || motion.moving_draws > 0 || jittered,
            .state   = describe_motion(gbuffer, jittered)};
}

FrameFacts facts_of(const PreparedFrame& frame)
{
    const GpuScene* scene = frame.buffers->gbuffer->scene.get();
    FrameFacts      facts;
    for (const Structure& structure : frame.technique.structures) facts.structures.push_back(structure.id);
    facts.solids               = find_surface(frame.settings.trace.surface).needs_solid;
    facts.layers               = frame.settings.trace.layers;
    facts.history              = history_facts(frame);
    const TraceSettings& trace = frame.settings.trace;
    facts.reflectors           = fmt::format("; metals, and what else has an F0 of {} or more up to roughness {}",
                                             trace.dielectric_min_f0, trace.dielectric_max_roughness);
    if (scene == nullptr) return facts;
    facts.scene           = true;
    facts.environment_map = scene->has_environment_map;
    facts.alpha_mask      = scene->alpha_mask;
    facts.motion          = describe_motion(*frame.buffers->gbuffer, is_jittered(*frame.buffers->gbuffer));
    return facts;
}

MotionBuffers motion_since(Gpu& gpu, const PreparedFrame& frame)
{
    const GBuffer&     gbuffer = *frame.buffers->gbuffer;
    const FrameMotion& motion  = *gbuffer.motion;
    return make_motion_buffers(gpu, gbuffer.view, motion,
                               frame.history->view->centre_px - motion.previous_view.centre_px,
                               !frame.facts.history.changes);
}

/// Traces once and counts how the rays ended.
TraceCounts count_hits(Gpu& gpu, PreparedFrame& frame)
{
    const Buffer counts   = make_buffer(gpu, 16);
    Bindings     bindings = bindings_of(*frame.buffers, *frame.rays);
    bindings.insert({{"View", frame.buffers->view}, {"TraceStatistics", counts}});
    const Constants   constants = settings_constants(frame, Precision::float32);
    const ComputePass count     = make_compute_pass(
            gpu,
            compile_shader(gpu, {.file = "trace/trace_statistics.comp", .defines = ray_list_defines(gpu, *frame.rays)}),
            bindings, constants);
    submit(gpu, [&](const auto& commands) {
        commands.fillBuffer(*counts.buffer, 0, VK_WHOLE_SIZE, 0);
        record_rays(commands, frame.trace, *frame.buffers);
        record_depth_structures(commands, frame.structures);
        record_technique(commands, frame.trace.technique, *frame.rays);
        barrier(commands);
        dispatch_indirect(commands, count, frame.rays->launch);
        barrier(commands);
    });
    return download_as<TraceCounts>(gpu, counts, 1)[0];
}

/// counts: what the rays hit; null: to be counted.
PreparedFramePtr prepare(Gpu& gpu, const FrameBuffersPtr& buffers, const Technique& technique,
                         const ParameterValues& values, const FrameSettings& settings, const FrameHistoryPtr& history,
                         const TraceCounts* counts)
{
    require_bounded(technique, values);
    const ShaderFilesHeld held;
    auto                  frame = std::make_shared<PreparedFrame>();
    frame->buffers              = buffers;
    frame->technique            = technique;
    frame->values               = values;
    frame->settings             = settings;
    frame->history              = history;
    if (!buffers->gbuffer->scene && choice<HitShading>(settings.passes) == HitShading::mirrored) // there are no lights
        frame->settings.passes.insert_or_assign("hit_shading", choice_value(HitShading::lit));
    frame->statistics = statistics_for(gpu, *buffers, settings.trace);
    prepare_layers(gpu, *buffers->gbuffer, settings.trace);
    frame->rays       = rays_for(gpu, *buffers, frame->statistics.gbuffer, settings);
    frame->structures = make_depth_structures(gpu, *frame, *buffers->gbuffer);
    frame->trace      = make_trace_passes(gpu, *frame, *frame->rays, buffers->view, nullptr);

    frame->facts = facts_of(*frame);
    if (frame->facts.history.usable) frame->motion = motion_since(gpu, *frame);
    if (counts != nullptr)
        frame->statistics.trace = *counts;
    else if (choice<PassSet>(settings.passes) != PassSet::shading && frame->statistics.gbuffer.reflecting_pixels > 0) {
        const Stopwatch stopwatch;
        frame->statistics.trace = count_hits(gpu, *frame);
        frame->counting_s       = stopwatch.seconds();
    }
    frame->plan = plan_frame(frame->facts, frame->statistics, settings.passes);
    for (const PlannedPass& planned : frame->plan)
        if (planned.runs)
            frame->record_functions.push_back(planned.pass->prepare_structure != nullptr
                                                  ? planned.pass->prepare_structure(*frame, planned.id)
                                                  : planned.pass->prepare(gpu, *frame));
    frame->timestamps = make_timestamps(gpu, static_cast<uint32_t>(frame->record_functions.size()) + 1);
    return frame;
}

} // namespace

FrameBuffersPtr make_frame_buffers(Gpu& gpu, const GBufferPtr& gbuffer)
{
    auto       buffers = std::make_shared<FrameBuffers>();
    const auto image   = [&](vk::Format format, glm::ivec2 size_px) {
        return make_image(gpu, {.format = format, .size_px = size_px, .usage = vk::ImageUsageFlagBits::eStorage});
    };
    const glm::ivec2 size_px = gbuffer->view.size_px, half_size_px = (size_px - 1) / 2 + 1;
    constexpr auto   colour = vk::Format::eR16G16B16A16Sfloat;
    buffers->gbuffer        = gbuffer;
    buffers->view           = upload_view(gpu, gbuffer->view, Precision::float32);
    buffers->tiles          = make_tile_buffers(gpu, gbuffer->view.size_px);
    buffers->reflection     = image(colour, size_px);
    buffers->filtered       = image(colour, size_px);
    buffers->small_colour   = image(colour, half_size_px);
    buffers->block_pixel    = image(vk::Format::eR32Uint, half_size_px);
    buffers->shaded         = image(colour, size_px);
    upload_dfg_table(gpu, *buffers);
    const glm::vec3 ambient = gbuffer->scene ? gbuffer->scene->ambient : glm::vec3(0);
    buffers->ambient        = make_buffer(gpu, 16);
    upload(gpu, buffers->ambient, &ambient, sizeof(ambient));
    return buffers;
}

PreparedFramePtr prepare_frame(Gpu& gpu, const FrameBuffersPtr& buffers, const Technique& technique,
                               const ParameterValues& values, const FrameSettings& settings,
                               const FrameHistoryPtr& history)
{
    return prepare(gpu, buffers, technique, values, settings, history, nullptr);
}

PreparedFramePtr prepare_unculled(Gpu& gpu, const PreparedFrame& planned)
{
    FrameSettings settings                     = planned.settings;
    settings.passes.at("skip_unneeded_passes") = 0;
    return prepare(gpu, planned.buffers, planned.technique, planned.values, settings, planned.history,
                   &planned.statistics.trace);
}

std::vector<CompiledPtr> compile_frame(Gpu& gpu, const Technique& technique, const ParameterValues& values,
                                       const FrameSettings& settings)
{
    const GBufferPtr      gbuffer = make_gbuffer(gpu, camera_to_view(Camera{}, {1920, 1080}), Filled::drawn);
    const FrameBuffersPtr buffers = make_frame_buffers(gpu, gbuffer);
    const auto            pixels  = static_cast<uint32_t>(pixel_count(gbuffer->view.size_px));
    const glm::uvec3      tiles   = groups_of_8(gbuffer->view.size_px);
    FrameStatistics       all{.pixels = pixels, .tiles = tiles.x * tiles.y, .gbuffer = {}, .trace = {}};
    all.gbuffer.surface_pixels = all.gbuffer.reflecting_pixels = pixels;
    all.gbuffer.reflecting_tiles                               = all.tiles;
    all.gbuffer.roughness_pixels[0] = all.gbuffer.roughness_pixels[ROUGHNESS_BINS / 4] = pixels / 2;
    buffers->statistics.emplace(std::pair(settings.trace.dielectric_min_f0, settings.trace.dielectric_max_roughness),
                                all);
    const TraceCounts every_ray_hits{pixels, pixels, 0};
    prepare(gpu, buffers, technique, values, settings, nullptr, &every_ray_hits);
    return take_compiled(gpu);
}

const std::vector<PlannedPass>& plan_of(const PreparedFrame& frame) { return frame.plan; }

size_t reflecting_pixels_of(const PreparedFrame& frame) { return frame.statistics.gbuffer.reflecting_pixels; }
double counting_s_of(const PreparedFrame& frame) { return frame.counting_s; }

bool plan_skips_work(const PreparedFrame& frame)
{
    ParameterValues unculled = frame.settings.passes;
    if (unculled.at("skip_unneeded_passes") == 0 || choice<PassSet>(unculled) == PassSet::shading) return false;
    unculled.at("skip_unneeded_passes") = 0;
    const GBufferCounts& counts         = frame.statistics.gbuffer;
    return counts.reflecting_pixels < counts.surface_pixels ||
           !std::ranges::equal(frame.plan, plan_frame(frame.facts, frame.statistics, unculled), {}, &PlannedPass::runs,
                               &PlannedPass::runs);
}

std::vector<std::string> facts_of_plan(const PreparedFrame& frame)
{
    return describe_facts(frame.facts, frame.statistics);
}

FrameTimes run_frame(Gpu& gpu, PreparedFrame& frame, int frames)
{
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        for (int untimed = 1; untimed < frames; ++untimed)
            for (const RecordFunction& record : frame.record_functions) {
                record(commands);
                barrier(commands);
            }
        uint32_t timestamp = 0;
        write_timestamp(commands, frame.timestamps, timestamp++);
        for (const RecordFunction& record : frame.record_functions) {
            record(commands);
            barrier(commands);
            write_timestamp(commands, frame.timestamps, timestamp++);
        }
    });
    const auto intervals_ms = read_intervals_ms(gpu, frame.timestamps);
    FrameTimes times;
    for (const PlannedPass& planned : frame.plan)
        if (planned.runs) times.passes_ms.emplace_back(planned.id, intervals_ms[times.passes_ms.size()]);
    return times;
}

struct PreparedCount {
    RayBuffers  rays;
    Buffer      work, view;
    TracePasses passes;
};

PreparedCountPtr prepare_count(Gpu& gpu, const PreparedFrame& frame, Precision precision)
{
    if (precision == Precision::float64 && !gpu.info.float64)
        throw_failure("the device '{}' has no double precision", gpu.info.name);
    const ShaderFilesHeld held;
    auto                  count = std::make_shared<PreparedCount>();
    count->rays                 = make_ray_buffers(gpu, frame.statistics.gbuffer.reflecting_pixels, precision);
    const uint64_t rays         = std::max<uint64_t>(count->rays.capacity, 1);
    count->work                 = make_buffer(gpu, rays * work_words(frame.technique) * sizeof(uint32_t));
    count->view                 = upload_view(gpu, frame.buffers->gbuffer->view, precision);
    count->passes               = make_trace_passes(gpu, frame, count->rays, count->view, &count->work);
    return count;
}

TraceResult count_frame(Gpu& gpu, PreparedFrame& frame, const PreparedCount& count)
{
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        record_rays(commands, count.passes, *frame.buffers);
        record_depth_structures(commands, frame.structures);
        record_technique(commands, count.passes.technique, count.rays);
        barrier(commands);
    });
    return count.rays.precision == Precision::float64 ? read_result<double>(gpu, frame, count.rays, &count.work)
                                                      : read_result<float>(gpu, frame, count.rays, &count.work);
}

TraceResult count_frame(Gpu& gpu, PreparedFrame& frame, Precision precision)
{
    return count_frame(gpu, frame, *prepare_count(gpu, frame, precision));
}

Image read_shaded(Gpu& gpu, const PreparedFrame& frame)
{
    const auto texels = download_as<std::array<uint16_t, 4>>(gpu, frame.buffers->shaded);
    Image      image{frame.buffers->gbuffer->view.size_px, {"R", "G", "B"}, {}, {}};
    image.values.reserve(texels.size() * 3);
    for (const auto& texel : texels)
        for (size_t c = 0; c < 3; ++c) image.values.push_back(half_to_float(texel[c]));
    return image;
}

} // namespace ssrlab
