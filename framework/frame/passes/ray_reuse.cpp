// Gloss by rays drawn from the lobe of each pixel, each used by its neighbours, too.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<Gloss>(values) != Gloss::stochastic) return {PassDecision::off, "gloss is not stochastic"};
    return needed_if_anything_is_rough(statistics);
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    const LobeRayImages& images = lobe_ray_images(gpu, context);
    const auto           make   = [&](const char* shader, const Defines& defines, const Bindings& bound) {
        return std::make_shared<ComputePass>(make_pass(gpu, context, shader, defines, bound));
    };
    // The dense filter's result takes the place of what ray_reuse.comp read of neighbours.
    return [gather = make("passes/reuse_gather.comp", {}, {}), reuse = make("passes/ray_reuse.comp", {}, {}),
            dense  = make("passes/reuse_filter.comp", {{"DENSE", "1"}},
                          {{"source_image", images.reused}, {"target_image", images.gathered}}),
            wide   = make("passes/reuse_filter.comp", {}, {{"source_image", images.gathered}}),
            &tiles = tile_launch(context), groups = groups_of_8(images.reused.size_px)](const auto& commands) {
        dispatch(commands, *gather, groups);
        barrier(commands);
        dispatch_indirect(commands, *reuse, tiles);
        barrier(commands);
        dispatch_indirect(commands, *dense, tiles);
        barrier(commands);
        dispatch_indirect(commands, *wide, tiles);
    };
}

} // namespace

Pass ray_reuse_pass()
{
    return {
        .id      = "ray_reuse",
        .summary = "Makes each rough pixel's reflection of its own and its neighbours' rays, weighted by its BRDF, and "
                   "filters them",
        .cite    = {"T. Stachowiak 2015, Stochastic Screen-Space Reflections (SIGGRAPH)"},
        .reads = {Resource::gbuffer, Resource::tiles, Resource::block_pixel, Resource::lobe_rays, Resource::reflection},
        .writes = {Resource::reflection},
        .parameters =
            {integer_parameter("reuse_neighbours", 32, 1, 256,
                               "pixels whose rays a rough pixel uses, itself among them"),
             real_parameter("reuse_radius", 0.15, 0, 1,
                            "radius of these pixels' disk at roughness 1, as a share of the image's height"),
             real_parameter("reuse_spread", 0.8, 0, 1e6,
                            "standard deviation of the kernel that shares and filters rays, as a share of the "
                            "lobe's half width at the pixel's nearest hit"),
             real_parameter("reuse_depth_tolerance", 0.0003, 1e-6, 1e6,
                            "distance from the pixel's plane, as a share of the view distance, at which another "
                            "pixel's rays weigh 1/e")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
