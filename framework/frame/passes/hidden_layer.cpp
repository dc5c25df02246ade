// The hidden layer: the scene once more without what the first layer shows, and the rays that missed, traced in it.
#include "core/pixel_index.h"
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

struct HiddenLayer {
    std::shared_ptr<DerivedRays> missed;
    LabPtr                       lab; // the same technique on the second layer: it does not know which layer it sees
    ComputePass                  gather, launch, merge;
    TechniquePasses              technique;
};

/// Draws the second layer once it is recorded, with solids where the surface model asks.
const DrawingPtr& second_layer_of(Gpu& gpu, FrameBuffers& buffers, bool solids)
{
    if (!buffers.second_layer) buffers.second_layer = make_second_layer(gpu, *buffers.drawing);
    if (solids) make_solid_backs(gpu, *buffers.second_layer);
    return buffers.second_layer;
}

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("hidden_layer") == 0) return {PassDecision::off, "hidden_layer = false"};
    if (facts.layers > 1) return {PassDecision::off, "layers > 1: the walk knows what is hidden"};
    if (!facts.scene) return {PassDecision::off, "no scene to draw again"};
    if (!one_ray_per_pixel(values)) return {PassDecision::off, "needs one ray per pixel at full resolution"};
    const TraceCounts& trace  = statistics.trace;
    const uint32_t     misses = trace.rays - trace.hits;
    if (misses == 0) return {PassDecision::not_needed, fmt::format("none of {} rays missed", trace.rays)};
    const double      threshold = values.at("hidden_layer_threshold");
    const std::string reason    = fmt::format("{} of {} rays missed", percent(misses, trace.rays), trace.rays);
    if (misses <= threshold * trace.rays)
        return {PassDecision::off, fmt::format("{}, the threshold is {:.3g} %", reason, 100 * threshold)};
    return {PassDecision::needed, reason};
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    const FrameInputs& frame  = context.frame;
    const bool         solids = frame.lab->surface.needs_solid;
    const DrawingPtr&  layer  = second_layer_of(gpu, *frame.buffers, solids);
    auto               own    = std::make_shared<HiddenLayer>();
    own->missed               = derived_rays(gpu, context, 0);
    own->lab                  = lab_on(gpu, *frame.lab, layer->gbuffer);
    const Bindings derived    = derived_bindings(*own->missed);
    RayBuffers&    list       = own->missed->rays;
    Bindings       traced     = ray_bindings(*layer->gbuffer, list);
    traced.insert({"View", layer->gbuffer->view_uniforms});
    own->gather    = make_pass(gpu, context, "passes/gather_misses.comp", store_defines(gpu, list.list), derived);
    own->launch    = make_launch_pass(gpu, list);
    own->technique = make_technique_passes(gpu, *own->lab, list, traced);
    own->merge =
        make_pass(gpu, context, "passes/second_layer_hits.comp", store_defines(gpu, frame.rays->hits), derived);
    const double separation_m = frame.plan.values.at("hidden_layer_separation_m");
    return [own, layer, separation_m, solids, &rays = ray_launch(context)](const auto& commands) {
        const RayBuffers& missed = own->missed->rays;
        record_second_layer(commands, *layer, separation_m);
        if (solids) record_solid_backs(commands, *layer);
        record_depth_structures(commands, *own->lab);
        record_fill(commands, missed.count, 0);
        barrier(commands);
        dispatch_indirect(commands, own->gather, rays);
        barrier(commands);
        dispatch(commands, own->launch, {1, 1, 1});
        barrier(commands);
        record_technique(commands, own->technique, missed);
        barrier(commands);
        dispatch_indirect(commands, own->merge, missed.launch);
    };
}

} // namespace

Pass hidden_layer_pass()
{
    return {
        .id             = "hidden_layer",
        .summary        = "Draws a second depth layer by depth peeling, and traces in it the rays that missed",
        .cite           = {"C. Everitt 2001, Interactive Order-Independent Transparency",
                           "M. Mara, M. McGuire, D. Nowrouzezahrai, D. Luebke 2016, Deep G-Buffers for Stable Global "
                                     "Illumination Approximation"},
        .reads          = {Resource::gbuffer, Resource::rays, Resource::hits},
        .writes         = {Resource::layers, Resource::hits},
        .parameters     = {boolean_parameter("hidden_layer", false, "trace rays that missed in a second depth layer"),
                           real_parameter("hidden_layer_separation_m", 0.5, 0, 1e6,
                                          "the second layer is the nearest surface more than this far behind the first"),
                           real_parameter("hidden_layer_threshold", 0, 0, 1,
                                          "skip the second layer if at most this share of rays missed; above 0 the image "
                                              "changes")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

std::optional<TraceImage> read_hidden_hits(Gpu& gpu, const ReadyFrame& frame)
{
    if (!hits_hidden_layer(frame.inputs)) return std::nullopt;
    const RayBuffers& rays    = *frame.inputs.rays;
    const glm::ivec2  size_px = frame.inputs.lab->gbuffer->view.size_px;
    TraceImage        result  = read_result<float>(gpu, *frame.inputs.lab, rays, nullptr);
    const auto        listed  = read_list<float>(gpu, rays);
    const auto        hits    = download_as<PackedHit<float>>(gpu, rays.hits, listed.size());
    for (size_t i = 0; i < listed.size(); ++i) {
        if (unpack_layer(hits[i].pixel) > 0) continue;
        const glm::ivec2 pixel                     = unpack_pixel(listed[i].pixel);
        result.status[pixel_index(pixel, size_px)] = TraceStatus::not_traced;
    }
    return result;
}

GBufferImage read_second_layer(Gpu& gpu, const ReadyFrame& frame)
{
    if (!hits_hidden_layer(frame.inputs)) throw std::logic_error("read_second_layer: the frame has none");
    return read_gbuffer(gpu, *frame.inputs.buffers->second_layer->gbuffer);
}

} // namespace ssrlab
