// Reflections of the pixels without rays, when rays have a lower resolution.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    return [pass   = make_shared_pass(gpu, context, "passes/upsampling.comp"),
            &tiles = tile_launch(context)](const auto& commands) { dispatch_indirect(commands, *pass, tiles); };
}

} // namespace

Pass upsampling_pass()
{
    return {.id         = "upsampling",
            .summary    = "Gives each pixel without rays the reflections of the 2 x 2 traced pixels around it",
            .cite       = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling",
                           "B. Karis 2014, Physically Based Shading on Mobile"},
            .reads      = {Resource::gbuffer, Resource::tiles, Resource::block_pixel, Resource::reflection},
            .writes     = {Resource::reflection},
            .parameters = {boolean_parameter(
                               "upsampling_distance", true,
                               "the four neighbours weigh by their distance (bilinear). If all weights are zero, "
                               "the most similar neighbour is used"),
                           boolean_parameter("upsampling_depth", true,
                                             "the four neighbours weigh by their distance from the pixel's plane"),
                           boolean_parameter("upsampling_normal", true,
                                             "the four neighbours weigh by their normal's cosine ^ 32"),
                           boolean_parameter("upsampling_reflectivity", true,
                                             "the four neighbours weigh by their reflectivity, the directional albedo"),
                           real_parameter("upsampling_depth_tolerance", 0.01, 1e-6, 1e6,
                                          "depth difference, as a share of the distance, at which the weight is 1/e"),
                           real_parameter("upsampling_reflectivity_tolerance", 0.05, 1e-6, 1e6,
                                          "difference of reflectivity at which the weight is 1/e")},
            .decide     = needed_at_lower_resolution,
            .prepare    = prepare};
}

} // namespace ssrlab
