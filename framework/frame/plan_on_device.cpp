// The facts that a plan rests on, and the plan of a frame on a device.
#include "core/stopwatch.h"
#include "frame/frame_inputs.h"
#include "frame/passes/missed_rays.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

/// "moving camera, 2 of 5 objects move, no jitter"
std::string describe_motion(const Drawing* drawing, bool jittered)
{
    if (drawing == nullptr || !drawing->motion) return "no frame before this one";
    const FrameMotion& motion = *drawing->motion;
    return fmt::format("{} camera, {} of {} objects move, {} jitter", motion.camera_moves ? "moving" : "still",
                       motion.moving_draws, motion.to_previous_ws.size(), jittered ? "with" : "no");
}

bool is_jittered(const Drawing* drawing)
{
    return drawing != nullptr && drawing->motion && drawing->gbuffer->view.centre_px != drawing->motion->view.centre_px;
}

HistoryFacts history_facts(const FrameBuffers& buffers, const FrameHistory* history)
{
    if (history == nullptr) return {};
    const Drawing* drawing = buffers.drawing.get();
    const auto     moved   = drawing == nullptr ? std::nullopt : drawing->motion;
    if (const std::string mismatch = history_mismatch(*history, buffers.gbuffer->view.size_px, moved);
        !mismatch.empty())
        return {.state = mismatch};
    const bool jittered = is_jittered(drawing) || history->view->centre_px != moved->previous_view.centre_px;
    return {.usable  = true,
            .changes = moved->camera_moves || moved->moving_draws > 0 || jittered,
            .state   = describe_motion(drawing, jittered)};
}

FrameFacts facts_of(const Lab& lab, const FrameBuffers& buffers, const FrameHistory* history)
{
    FrameFacts facts;
    for (const Structure& structure : lab.technique.structures) facts.structures.push_back(structure.id);
    facts.solids          = lab.surface.needs_solid;
    facts.layers          = lab.settings.layers;
    facts.history         = history_facts(buffers, history);
    facts.reflectors      = fmt::format("; metals, and what else has an F0 of {} or more up to roughness {}",
                                        lab.settings.dielectric_min_f0, lab.settings.dielectric_max_roughness);
    const GpuScene* scene = scene_of(buffers);
    if (scene == nullptr) return facts;
    facts.scene           = true;
    facts.world           = buffers.world != nullptr;
    facts.environment_map = scene->has_environment_map;
    facts.alpha_mask      = scene->alpha_mask;
    facts.motion          = describe_motion(buffers.drawing.get(), is_jittered(buffers.drawing.get()));
    return facts;
}

/// As this frame can have them: without a scene there are no lights. With the strategy's parameters.
ParameterValues possible_values(const FrameSettings& settings, const Reprojection& strategy, bool scene)
{
    ParameterValues values = settings.passes;
    if (!scene && choice<HitShading>(values) == HitShading::mirrored)
        values.insert_or_assign("hit_shading", choice_value(HitShading::lit));
    for (const Parameter& parameter : strategy.parameters) values.emplace(parameter.name, parameter.default_value);
    return values;
}

/// Nothing is traced yet.
FramePlan plan_inputs(const Catalogue& catalogue, const Lab& lab, const FrameBuffers& buffers,
                      const FrameSettings& settings, const FrameHistory* history, const GBufferCounts& counts)
{
    const glm::ivec2 size_px = lab.gbuffer->view.size_px;
    const glm::uvec3 tiles   = groups_of_8(size_px);
    FramePlan        plan;
    plan.facts        = facts_of(lab, buffers, history);
    plan.statistics   = {.pixels  = static_cast<uint32_t>(size_px.x) * static_cast<uint32_t>(size_px.y),
                         .tiles   = tiles.x * tiles.y,
                         .gbuffer = counts,
                         .trace   = {},
                         .misses  = {}};
    plan.reprojection = find_reprojection(catalogue.reprojections, settings.reprojection);
    plan.values       = possible_values(settings, plan.reprojection, plan.facts.scene);
    return plan;
}

} // namespace

FramePlan plan_with(const Catalogue& catalogue, const Lab& lab, const FrameBuffers& buffers,
                    const FrameSettings& settings, const FrameHistory* history, const GBufferCounts& counts,
                    const TraceCounts& hits)
{
    FramePlan plan        = plan_inputs(catalogue, lab, buffers, settings, history, counts);
    plan.statistics.trace = hits;
    plan.passes           = plan_passes(plan.facts, plan.statistics, plan.values);
    return plan;
}

FramePlan plan_frame(Gpu& gpu, const Catalogue& catalogue, const LabPtr& lab, const FrameBuffersPtr& buffers,
                     const FrameSettings& settings, const FrameHistoryPtr& history)
{
    const ShaderFilesHeld held(gpu);
    const GBufferCounts   counts = count_gbuffer(gpu, *lab->gbuffer, lab->settings);
    FramePlan             plan   = plan_inputs(catalogue, *lab, *buffers, settings, history.get(), counts);
    if (choice<PassSet>(plan.values) != PassSet::shading && counts.reflecting_pixels > 0) {
        const Stopwatch stopwatch;
        const auto      rays  = ray_buffers(gpu, *buffers, counts, plan.values);
        plan.statistics.trace = count_hits(gpu, *lab, *rays, rays_of(plan.values));
        if (plan.facts.world && asks_triangles(plan.values)) {
            FrameInputs traced;
            traced.lab             = lab;
            traced.buffers         = buffers;
            traced.plan            = plan;
            traced.rays            = rays;
            plan.statistics.misses = count_followed_rays(gpu, traced);
        }
        plan.counting_s = stopwatch.seconds();
    }
    plan.passes = plan_passes(plan.facts, plan.statistics, plan.values);
    return plan;
}

} // namespace ssrlab
