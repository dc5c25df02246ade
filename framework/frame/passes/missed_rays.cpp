// Light of rays that found no surface that the frame shows: the environment, but only where no triangle of the scene is in the way.
#include "frame/passes/missed_rays.h"

#include "frame/passes/pass_helpers.h"
#include "frame/world_light.h"

#include <algorithm>

namespace ssrlab {
namespace {

/// Of followed rays, how many meet a triangle: from here on, miss_light = rooms follows them. The foot of one statue on a
/// wide floor, where rays meet the statue within their start pixel, makes 0.1 % and is seen as a line of dashes.
constexpr double room_share = 0.001;
/// Further reflections that are followed at what these rays met. Beyond, ambient light stands in.
constexpr size_t further_bounces = 2;

/// The missed rays, and the one of each block that is followed.
struct FollowedRays {
    Buffer       missed, missed_launch; // indices of rays of the frame's list
    Buffer       ranks, places;         // of each block: the least rank; its place in `list`
    WorldRayList list;
    Buffer       hits;
    ComputePass  rank, choose, walk;
};

/// The side of the blocks that follow one ray each.
int block_px(const FrameInputs& frame) { return static_cast<int>(frame.plan.values.at("missed_block_px")); }

Defines followed_defines(const FrameInputs& frame)
{
    Defines defines = {{"MISS_BLOCK_PX", std::to_string(block_px(frame))},
                       {"MISS_START_SHARE", fmt::format("{}", world_start_share)}};
    if (frame.answers_given) defines.emplace("ANSWERS_GIVEN", "1");
    return defines;
}

size_t count_blocks(const FrameInputs& frame)
{
    const glm::ivec2 size = (frame.lab->gbuffer->view.size_px - 1) / block_px(frame) + 1;
    return static_cast<size_t>(size.x) * static_cast<size_t>(size.y);
}

FollowedRays make_followed_rays(Gpu& gpu, const PassContext& context)
{
    const FrameInputs& frame   = context.frame;
    const size_t       blocks  = count_blocks(frame);
    const Defines      defines = followed_defines(frame);
    FollowedRays       own;
    own.missed        = make_buffer(gpu, std::max<uint64_t>(frame.rays->capacity, 1) * sizeof(uint32_t));
    own.missed_launch = make_buffer(gpu, sizeof(ListLaunch));
    own.ranks         = make_buffer(gpu, blocks * sizeof(uint32_t));
    own.places        = make_buffer(gpu, blocks * sizeof(uint32_t));
    own.list          = make_ray_list(gpu, blocks);
    own.hits          = make_buffer(gpu, blocks * sizeof(WorldHit));
    own.rank          = make_pass(gpu, context, "passes/missed_ranks.comp", defines,
                                  {{"MissedRays", own.missed},
                                   {"AppendedLaunch", own.missed_launch},
                                   {"MissedLights", frame.answers},
                                   {"MissRanks", own.ranks}});
    own.choose        = make_pass(gpu, context, "passes/followed_rays.comp", defines,
                                  {{"MissedLaunch", own.missed_launch},
                                   {"MissedRays", own.missed},
                                   {"MissRanks", own.ranks},
                                   {"WorldRays", own.list.rays},
                                   {"AppendedLaunch", own.list.launch},
                                   {"FollowedPlaces", own.places}});
    own.walk          = make_walk_pass(gpu, *frame.buffers->world, own.list, own.hits);
    return own;
}

void record_followed_rays(const Commands& commands, const FrameInputs& frame, const FollowedRays& own)
{
    record_fill(commands, own.ranks, ~0U);
    record_empty(commands, own.missed_launch);
    record_empty(commands, own.list.launch);
    barrier(commands);
    dispatch_indirect(commands, own.rank, frame.rays->launch);
    barrier(commands);
    dispatch_indirect(commands, own.choose, own.missed_launch);
    barrier(commands);
    dispatch_indirect(commands, own.walk, own.list.launch);
    barrier(commands);
}

PassDecision decide(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    const MissLight chosen = choice<MissLight>(values);
    if (chosen == MissLight::environment) return {PassDecision::off, "miss_light = environment"};
    if (values.at("environment_fallback") == 0) return {PassDecision::off, "environment_fallback = false"};
    if (!facts.world) return {PassDecision::off, "the scene's triangles are not on the device"};
    if (statistics.gbuffer.reflecting_pixels == 0) return {PassDecision::not_needed, "no pixel reflects"};
    const MissCounts& misses = statistics.misses;
    if (misses.followed == 0) return {PassDecision::not_needed, "no ray missed"};
    const std::string reason = fmt::format("{} of {} followed rays meet a triangle", misses.met, misses.followed);
    if (chosen == MissLight::rooms && misses.met < room_share * misses.followed)
        return {PassDecision::off, fmt::format("{}, below {:.1f} %", reason, 100 * room_share)};
    if (values.at("hidden_layer") != 0)
        return {PassDecision::needed, "hidden_layer = true: which rays it leaves is not counted"};
    return {misses.met == 0 ? PassDecision::off : PassDecision::needed, reason};
}

/// Rays that met something, and the light that comes back along them.
struct LitRays {
    WorldRayList list;
    Buffer       hits, light, next;
    ComputePass  shade;
};

LitRays make_lit_rays(Gpu& gpu, const FrameBuffers& buffers, size_t capacity)
{
    LitRays own;
    own.list  = make_ray_list(gpu, capacity);
    own.hits  = make_buffer(gpu, capacity * sizeof(WorldHit));
    own.light = make_buffer(gpu, capacity * sizeof(glm::vec3));
    own.next  = make_buffer(gpu, capacity * sizeof(NextRay));
    own.shade = make_shade_pass(gpu, *buffers.world, *scene_of(buffers), buffers.dfg_table, own.list, own.hits,
                                own.light, own.next);
    return own;
}

/// The rays that go on from what others met, to find what that reflects.
struct OnwardRays {
    LitRays     lit;
    Buffer      sources; // of each: its place among the rays before it
    ComputePass list, walk, sum;
};

/// What followed rays met, and what that reflects.
struct FollowedLight {
    Buffer                  places; // of each followed ray, in `met`
    LitRays                 met;
    ComputePass             list_met;
    std::vector<OnwardRays> onward;
};

OnwardRays make_onward_rays(Gpu& gpu, const PassContext& context, const LitRays& before, size_t capacity)
{
    const FrameBuffers& buffers = *context.frame.buffers;
    OnwardRays          own;
    own.lit     = make_lit_rays(gpu, buffers, capacity);
    own.sources = make_buffer(gpu, capacity * sizeof(uint32_t));
    own.list    = make_pass(gpu, context, "passes/followed_bounces.comp", {},
                            {{"MetLaunch", before.list.launch},
                             {"NextRays", before.next},
                             {"AppendedLaunch", own.lit.list.launch},
                             {"WorldRays", own.lit.list.rays},
                             {"OnwardSources", own.sources}});
    own.walk    = make_walk_pass(gpu, *buffers.world, own.lit.list, own.lit.hits);
    Defines  defines;
    Bindings bindings = {{"OnwardLaunch", own.lit.list.launch}, {"NextRays", before.next},
                         {"OnwardSources", own.sources},        {"WorldHits", own.lit.hits},
                         {"WorldLight", before.light},          {"OnwardLight", own.lit.light}};
    add_environment(gpu, context, defines, bindings);
    own.sum = make_pass(gpu, context, "passes/followed_light.comp", defines, bindings);
    return own;
}

FollowedLight make_followed_light(Gpu& gpu, const PassContext& context, const FollowedRays& rays)
{
    const FrameBuffers& buffers = *context.frame.buffers;
    const size_t        blocks  = count_blocks(context.frame);
    FollowedLight       own;
    own.places   = make_buffer(gpu, blocks * sizeof(uint32_t));
    own.met      = make_lit_rays(gpu, buffers, blocks);
    own.list_met = make_pass(gpu, context, "passes/followed_hits.comp", {},
                             {{"FollowedLaunch", rays.list.launch},
                              {"WorldRays", rays.list.rays},
                              {"WorldHits", rays.hits},
                              {"AppendedLaunch", own.met.list.launch},
                              {"MetRays", own.met.list.rays},
                              {"MetHits", own.met.hits},
                              {"MetPlaces", own.places}});
    if (choice<BounceMode>(context.frame.plan.values) == BounceMode::off) return own;
    for (size_t i = 0; i < further_bounces; ++i)
        own.onward.push_back(make_onward_rays(gpu, context, i == 0 ? own.met : own.onward.back().lit, blocks));
    return own;
}

void record_followed_light(const Commands& commands, const FrameInputs& frame, const FollowedRays& rays,
                           const FollowedLight& own)
{
    const auto over = [&](const ComputePass& pass, const Buffer& launch) {
        dispatch_indirect(commands, pass, launch);
        barrier(commands);
    };
    const auto shade = [&](const LitRays& lit, bool follows) {
        record_shade(commands, lit.shade, *scene_of(*frame.buffers), frame.lab->settings, follows, lit.list.launch);
        barrier(commands);
    };
    record_empty(commands, own.met.list.launch);
    for (const OnwardRays& onward : own.onward) record_empty(commands, onward.lit.list.launch);
    barrier(commands);
    over(own.list_met, rays.list.launch);
    shade(own.met, !own.onward.empty());
    const LitRays* before = &own.met;
    for (const OnwardRays& onward : own.onward) {
        over(onward.list, before->list.launch);
        over(onward.walk, onward.lit.list.launch);
        shade(onward.lit, &onward != &own.onward.back());
        before = &onward.lit;
    }
    for (size_t i = own.onward.size(); i-- > 0;) over(own.onward[i].sum, own.onward[i].lit.list.launch);
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
    Defines look_up_defines  = followed_defines(frame);
    look_up_defines.merge(store_defines(gpu, frame.rays->hits));
    own->look_up = make_pass(gpu, context, "passes/missed_light.comp", look_up_defines,
                             {{"MissedLaunch", rays.missed_launch},
                              {"MissedRays", rays.missed},
                              {"MissedLights", frame.answers},
                              {"MissRanks", rays.ranks},
                              {"FollowedPlaces", rays.places},
                              {"WorldRays", rays.list.rays},
                              {"WorldHits", rays.hits},
                              {"MetPlaces", own->lit.places},
                              {"WorldLight", own->lit.met.light}});
    return [own, &frame](const auto& commands) {
        record_followed_rays(commands, frame, own->followed);
        record_followed_light(commands, frame, own->followed, own->lit);
        dispatch_indirect(commands, own->look_up, own->followed.missed_launch);
    };
}

} // namespace

bool asks_triangles(const ParameterValues& values)
{
    return choice<MissLight>(values) != MissLight::environment && values.at("environment_fallback") != 0;
}

MissCounts count_followed_rays(Gpu& gpu, FrameInputs& frame)
{
    const Pass pass             = missed_rays_pass();
    frame.answers               = make_answers(gpu, *frame.rays);
    const FollowedRays followed = make_followed_rays(gpu, {frame, pass, pass.id});
    submit(gpu, [&](const Commands& commands) {
        barrier(commands);
        record_followed_rays(commands, frame, followed);
    });
    MissCounts counts;
    counts.followed = download_as<ListLaunch>(gpu, followed.list.launch, 1)[0].count;
    for (const WorldHit& hit : download_as<WorldHit>(gpu, followed.hits, counts.followed))
        counts.met += hit.triangle < walk_unfinished ? 1 : 0;
    return counts;
}

Pass missed_rays_pass()
{
    return {
        .id = "missed_rays",
        .summary =
            "Follows rays that missed or stopped through the scene's triangles: each, or one of each block of pixels",
        .cite   = {"I. Wald et al. 2014, Embree: A Kernel Framework for Efficient CPU Ray Tracing"},
        .reads  = {Resource::gbuffer, Resource::surroundings, Resource::rays, Resource::hits},
        .writes = {Resource::hits, Resource::answers},
        .parameters =
            {choice_parameter(
                 MissLight::rooms,
                 "what a ray shows that missed. environment: what is infinitely far away. triangles: what the ray "
                 "meets in the scene, or the environment where it meets nothing; rays that stopped (behind = stop) "
                 "are followed, too. rooms: as triangles where at least 0.1 % of these rays meet something, else as "
                 "environment"),
             integer_parameter("missed_block_px", 1, 1, 4,
                               "side of blocks of pixels: one ray of each is followed, and the "
                               "others show what the nearest of these met")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
