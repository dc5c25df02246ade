// Light of rays that found nothing in the frame: the environment, but only where no triangle of the scene is in the way.
#include "frame/passes/missed_rays.h"

#include "frame/passes/pass_helpers.h"
#include "frame/world_light.h"

#include <algorithm>

namespace ssrlab {
namespace {

constexpr int side_px = 4; // of the blocks that follow one ray each

struct FollowedRays {
    uint32_t    blocks = 0;
    Buffer      ranks, rays, hits; // of each block
    ComputePass rank, list, walk;
};

Defines followed_defines(const FrameInputs& frame)
{
    Defines defines = {{"MISS_BLOCK_PX", std::to_string(side_px)},
                       {"MISS_START_SHARE", fmt::format("{}", world_start_share)}};
    if (frame.answers_given) defines.emplace("ANSWERS_GIVEN", "1");
    return defines;
}

FollowedRays make_followed_rays(Gpu& gpu, const PassContext& context)
{
    const FrameInputs& frame   = context.frame;
    const glm::ivec2   size    = (frame.lab->gbuffer->view.size_px - 1) / side_px + 1;
    const Defines      defines = followed_defines(frame);
    FollowedRays       followed;
    followed.blocks         = static_cast<uint32_t>(size.x) * static_cast<uint32_t>(size.y);
    followed.ranks          = make_buffer(gpu, followed.blocks * sizeof(uint32_t));
    followed.rays           = make_buffer(gpu, followed.blocks * sizeof(WorldRay));
    followed.hits           = make_buffer(gpu, followed.blocks * sizeof(WorldHit));
    const Bindings bindings = {{"MissRanks", followed.ranks}, {"WorldRays", followed.rays}};
    followed.rank           = make_pass(gpu, context, "passes/missed_ranks.comp", defines, bindings);
    followed.list           = make_pass(gpu, context, "passes/followed_rays.comp", defines, bindings);
    followed.walk           = make_walk_pass(gpu, *frame.buffers->world, followed.rays, followed.hits);
    return followed;
}

void record_followed_rays(const vk::raii::CommandBuffer& commands, const FrameInputs& frame,
                          const FollowedRays& followed)
{
    constexpr uint32_t minus_one = 0xBF800000; // as a float
    commands.fillBuffer(*followed.ranks.buffer, 0, VK_WHOLE_SIZE, ~0U);
    commands.fillBuffer(*followed.rays.buffer, 0, VK_WHOLE_SIZE, minus_one); // a ray that ends at -1 m meets nothing
    barrier(commands);
    dispatch_indirect(commands, followed.rank, frame.rays->launch);
    barrier(commands);
    dispatch_indirect(commands, followed.list, frame.rays->launch);
    barrier(commands);
    push(commands, followed.walk, followed.blocks);
    dispatch(commands, followed.walk, groups_for(followed.blocks));
    barrier(commands);
}

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<MissLight>(values) != MissLight::triangles) return {PassDecision::off, "miss_light = environment"};
    if (values.at("environment_fallback") == 0) return {PassDecision::off, "environment_fallback = false"};
    if (!facts.world) return {PassDecision::off, "the scene's triangles are not on the device"};
    if (statistics.gbuffer.reflecting_pixels == 0) return {PassDecision::not_needed, "no pixel reflects"};
    const MissCounts& misses = statistics.misses;
    if (misses.followed == 0) return {PassDecision::not_needed, "no ray missed"};
    if (values.at("hidden_layer") != 0)
        return {PassDecision::needed, "hidden_layer = true: which rays it leaves is not counted"};
    const std::string reason = fmt::format("{} of {} followed rays meet a triangle", misses.met, misses.followed);
    return {misses.met == 0 ? PassDecision::not_needed : PassDecision::needed, reason};
}

/// What the followed rays met, and what that reflects.
struct FollowedLight {
    Buffer      light, next, onward, onward_hits, onward_light, no_next; // of each block
    ComputePass shade, list_onward, walk_onward, shade_onward, sum;
};

FollowedLight make_followed_light(Gpu& gpu, const PassContext& context, const FollowedRays& rays)
{
    const FrameBuffers& buffers = *context.frame.buffers;
    const GpuScene&     scene   = *scene_of(buffers);
    const auto          shade   = [&](const Buffer& of, const Buffer& hits, const Buffer& light, const Buffer& next) {
        return make_shade_pass(gpu, *buffers.world, scene, buffers.dfg_table, of, hits, light, next);
    };
    FollowedLight own;
    own.light        = make_buffer(gpu, rays.blocks * sizeof(glm::vec3));
    own.next         = make_buffer(gpu, rays.blocks * sizeof(NextRay));
    own.onward       = make_buffer(gpu, rays.blocks * sizeof(WorldRay));
    own.onward_hits  = make_buffer(gpu, rays.blocks * sizeof(WorldHit));
    own.onward_light = make_buffer(gpu, rays.blocks * sizeof(glm::vec3));
    own.no_next      = make_buffer(gpu, rays.blocks * sizeof(NextRay));
    own.shade        = shade(rays.rays, rays.hits, own.light, own.next);
    own.list_onward  = make_pass(gpu, context, "passes/followed_bounces.comp", {},
                                 {{"NextRays", own.next}, {"WorldRays", own.onward}}, sizeof(uint32_t));
    own.walk_onward  = make_walk_pass(gpu, *buffers.world, own.onward, own.onward_hits);
    own.shade_onward = shade(own.onward, own.onward_hits, own.onward_light, own.no_next);
    Defines  defines;
    Bindings bindings = {{"WorldLight", own.light},
                         {"NextRays", own.next},
                         {"WorldHits", own.onward_hits},
                         {"OnwardLight", own.onward_light}};
    add_environment(gpu, context, defines, bindings);
    own.sum = make_pass(gpu, context, "passes/followed_light.comp", defines, bindings, sizeof(uint32_t));
    return own;
}

void record_followed_light(const vk::raii::CommandBuffer& commands, const FrameInputs& frame, uint32_t blocks,
                           const FollowedLight& own)
{
    const GpuScene&      scene   = *scene_of(*frame.buffers);
    const TraceSettings& trace   = frame.lab->settings;
    const bool           bounces = choice<BounceMode>(frame.plan.values) != BounceMode::off;
    record_shade(commands, own.shade, scene, trace, bounces, blocks);
    barrier(commands);
    if (!bounces) return;
    const auto over_blocks = [&](const ComputePass& pass) {
        push(commands, pass, blocks);
        dispatch(commands, pass, groups_for(blocks));
        barrier(commands);
    };
    over_blocks(own.list_onward);
    over_blocks(own.walk_onward);
    record_shade(commands, own.shade_onward, scene, trace, false, blocks);
    barrier(commands);
    over_blocks(own.sum);
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    struct Own {
        FollowedRays  followed;
        FollowedLight lit;
        ComputePass   look_up;
    };
    const FrameInputs& frame = context.frame;
    auto               own   = std::make_shared<Own>();
    own->followed            = make_followed_rays(gpu, context);
    const FollowedRays& rays = own->followed;
    own->lit                 = make_followed_light(gpu, context, rays);
    own->look_up             = make_pass(gpu, context, "passes/missed_light.comp", followed_defines(frame),
                                         {{"MissedLights", frame.answers},
                                          {"MissRanks", rays.ranks},
                                          {"WorldRays", rays.rays},
                                          {"WorldHits", rays.hits},
                                          {"WorldLight", own->lit.light}});
    return [own, &frame, &launch = ray_launch(context)](const auto& commands) {
        record_followed_rays(commands, frame, own->followed);
        record_followed_light(commands, frame, own->followed.blocks, own->lit);
        dispatch_indirect(commands, own->look_up, launch);
    };
}

} // namespace

bool asks_triangles(const ParameterValues& values)
{
    return choice<MissLight>(values) == MissLight::triangles && values.at("environment_fallback") != 0;
}

MissCounts count_followed_rays(Gpu& gpu, FrameInputs& frame)
{
    const Pass pass             = missed_rays_pass();
    frame.answers               = make_answers(gpu, *frame.rays);
    const FollowedRays followed = make_followed_rays(gpu, {frame, pass, pass.id});
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        barrier(commands);
        record_followed_rays(commands, frame, followed);
    });
    MissCounts counts;
    for (const uint32_t rank : download_as<uint32_t>(gpu, followed.ranks, followed.blocks))
        counts.followed += rank != ~0U ? 1 : 0;
    for (const WorldHit& hit : download_as<WorldHit>(gpu, followed.hits, followed.blocks))
        counts.met += hit.triangle < walk_unfinished ? 1 : 0;
    return counts;
}

Pass missed_rays_pass()
{
    return {.id = "missed_rays",
            .summary =
                "Follows one missed ray of each 4x4 pixels through the scene's triangles, on behalf of the others",
            .cite           = {"I. Wald et al. 2014, Embree: A Kernel Framework for Efficient CPU Ray Tracing"},
            .reads          = {Resource::gbuffer, Resource::surroundings, Resource::rays, Resource::hits},
            .writes         = {Resource::answers},
            .parameters     = {choice_parameter(MissLight::environment,
                                                "what a ray shows that missed. environment: what is infinitely far away; "
                                                    "triangles: what one missed ray of each 4x4 pixels meets in the scene, and "
                                                    "the environment where it meets nothing")},
            .decide         = decide,
            .prepare        = prepare,
            .beyond_shading = true};
}

} // namespace ssrlab
