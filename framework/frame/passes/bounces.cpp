// Mirror in mirror: further bounces, traced ray by ray or taken from the previous frame's reflection.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

struct Bounce {
    std::shared_ptr<DerivedRays> rays;
    ComputePass                  set_up, launch, colour;
    TechniquePasses              technique;
};

/// A list of derived rays in the place of the frame's own.
Bindings list_bindings(const DerivedRays& derived)
{
    return {{"RaySources", derived.sources},
            {"RayThroughputs", derived.throughputs},
            {"RayCount", derived.rays.count},
            {"Rays", derived.rays.list},
            {"Hits", derived.rays.hits}};
}

/// The rays that continue those of `from`, or of the frame where that is null.
Bounce make_bounce(Gpu& gpu, const PassContext& context, const DerivedRays* from, int which)
{
    const Lab& lab = *context.frame.lab;
    Bounce     bounce;
    bounce.rays       = derived_rays(gpu, context, which);
    Bindings arriving = derived_bindings(*bounce.rays);
    if (from != nullptr) arriving.merge(list_bindings(*from));
    Defines defines = number_format_defines(gpu, NumberFormat::float32);
    defines.merge(store_defines(gpu, bounce.rays->rays.list));
    if (from != nullptr) defines.emplace("FURTHER", "1");
    Bindings traced = ray_bindings(*lab.gbuffer, bounce.rays->rays);
    traced.insert({"View", lab.gbuffer->view_uniforms});
    bounce.set_up    = make_colour_pass(gpu, context, "passes/bounce_rays.comp", defines, arriving);
    bounce.launch    = make_launch_pass(gpu, bounce.rays->rays);
    bounce.technique = make_technique_passes(gpu, lab, bounce.rays->rays, traced);
    Bindings listed  = list_bindings(*bounce.rays);
    Defines  colour_defines;
    add_environment(gpu, context, colour_defines, listed);
    bounce.colour = make_colour_pass(gpu, context, "passes/bounce_colour.comp", colour_defines, listed);
    return bounce;
}

void record_bounce(const Commands& commands, const Bounce& bounce, const Buffer& arriving_launch)
{
    const RayBuffers& rays = bounce.rays->rays;
    barrier(commands);
    record_fill(commands, rays.count, 0);
    barrier(commands);
    dispatch_indirect(commands, bounce.set_up, arriving_launch);
    barrier(commands);
    dispatch(commands, bounce.launch, {1, 1, 1});
    barrier(commands);
    record_technique(commands, bounce.technique, rays);
    barrier(commands);
    dispatch_indirect(commands, bounce.colour, rays.launch);
}

/// The first bounce continues the frame's rays; the others alternate between two lists.
RecordFunction direct(Gpu& gpu, const PassContext& context, int count)
{
    auto bounces = std::make_shared<std::vector<Bounce>>();
    bounces->push_back(make_bounce(gpu, context, nullptr, 0));
    if (count > 1) bounces->push_back(make_bounce(gpu, context, bounces->at(0).rays.get(), 1));
    if (count > 2) bounces->push_back(make_bounce(gpu, context, bounces->at(1).rays.get(), 0));
    return [&rays = ray_launch(context), bounces, count](const auto& commands) {
        record_bounce(commands, bounces->at(0), rays);
        for (int i = 1; i < count; ++i) {
            const Bounce& bounce = bounces->at(i % 2 == 1 ? 1 : 2);
            record_bounce(commands, bounce, bounces->at(i % 2 == 1 ? 0 : 1).rays->rays.launch);
        }
    };
}

/// From the reflection that the frame before left in its history.
RecordFunction from_history(Gpu& gpu, const PassContext& context)
{
    auto pass = std::make_shared<ComputePass>(
        make_colour_pass(gpu, context, "passes/bounce_history.comp", {{"REPROJECTED", "1"}}));
    return [&rays = ray_launch(context), pass](const auto& commands) { dispatch_indirect(commands, *pass, rays); };
}

/// Without a history every pass stands for the next frame of a still image.
RecordFunction from_still_image(Gpu& gpu, const PassContext& context, int count)
{
    const GpuImage &reflection = image_of(context, Resource::reflection),
                   &before     = image_of(context, Resource::filtered);
    auto pass                  = std::make_shared<ComputePass>(
        make_colour_pass(gpu, context, "passes/bounce_history.comp", {}, {{"history_image", before}}));
    return [&rays = ray_launch(context), &reflection, &before, pass, count](const auto& commands) {
        for (int i = 0; i < count; ++i) {
            record_copy(commands, reflection, before);
            dispatch_indirect(commands, *pass, rays);
        }
    };
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    const int count = static_cast<int>(context.frame.plan.values.at("bounces"));
    if (choice<BounceMode>(context.frame.plan.values) != BounceMode::history) return direct(gpu, context, count);
    return context.frame.plan.facts.history.usable ? from_history(gpu, context) : from_still_image(gpu, context, count);
}

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<BounceMode>(values) == BounceMode::off) return {PassDecision::off, "bounce_mode = off"};
    if (!one_ray_per_pixel(values)) return {PassDecision::off, "needs one ray per pixel at full resolution"};
    const TraceCounts& trace = statistics.trace;
    if (trace.mirror_hits == 0) return {PassDecision::not_needed, fmt::format("none of {} hits reflects", trace.hits)};
    return {PassDecision::needed,
            fmt::format("{} of {} hits reflect{}", percent(trace.mirror_hits, trace.hits), trace.hits,
                        takes_bounces_from_history(facts, values) ? ", as the frame before shows" : "")};
}

} // namespace

bool takes_bounces_from_history(const FrameFacts& facts, const ParameterValues& values)
{
    return choice<BounceMode>(values) == BounceMode::history && facts.history.usable;
}

Pass bounces_pass()
{
    return {
        .id             = "bounces",
        .summary        = "Further bounces between mirrors: continues the rays whose hits reflect, too",
        .cite           = {"J. Somerville Roberts, Screen Space Reflections"},
        .reads          = {Resource::gbuffer, Resource::light, Resource::objects, Resource::layers, Resource::solids,
                           Resource::surroundings, Resource::structures, Resource::rays, Resource::hits, Resource::small_colour,
                           Resource::cones, Resource::reflection, Resource::history, Resource::reprojected, Resource::lobe_rays},
        .writes         = {Resource::filtered, Resource::reflection},
        .parameters     = {choice_parameter(BounceMode::direct,
                                            "further bounces. off: none; history: from the previous frame's "
                                                "reflection as the camera saw it, reprojected; direct: traced in the mirror "
                                                "direction of the arriving ray"),
                           integer_parameter("bounces", 2, 1, 16,
                                             "further bounces; with history and no frame before this one, earlier frames "
                                                 "of a still image; each adds one level of reflection")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
