// The colour and the weight of each hit.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    Defines defines;
    if (context.frame.answers.bytes > 0) defines.emplace("ANSWERS_GIVEN", "1");
    auto pass = std::make_shared<ComputePass>(make_colour_pass(gpu, context, "passes/hit_colour.comp", defines));
    RecordFunction no_pixel;
    if (trace_block_px(context.frame.plan.values) > 1)
        no_pixel = make_fill(gpu, image_of(context, Resource::block_pixel), {NO_PIXEL, 0, 0, 0});
    return [pass, no_pixel, &rays = ray_launch(context),
            no_reflection = make_reflection_fill(gpu, image_of(context, Resource::reflection))](const auto& commands) {
        no_reflection(commands);
        if (no_pixel) no_pixel(commands);
        dispatch_indirect(commands, *pass, rays);
    };
}

std::vector<Parameter> parameters()
{
    return {
        choice_parameter(
            HitShading::mirrored,
            "light of the hit surface. diffuse: the view-independent part; lit: with highlights as the "
            "camera sees them; mirrored: with highlights as the reflector sees them; a frame without a scene has "
            "no lights, and is lit"),
        choice_parameter(ViewerFade::off,
                         "weight of reflections that point toward the viewer, with a = -R.z. linear: a; cut: 1; both "
                         "are 0 where a is below 0; smooth: (a - viewer_fade_start) / (1 - viewer_fade_start)"),
        real_parameter("viewer_fade_start", 0, -1, 0.99, "a = -R.z at which viewer_fade = smooth starts"),
        choice_parameter(
            EdgeFade::off,
            "weight of hits by where they are. By their distance r from the image's centre: manhattan: 1 - "
            "|u-1/2| - |v-1/2|; linear: 1 - 2r; squared: 1 - (2r)^2. border: 1, and smoothly down to 0 at the "
            "image's border over edge_fade_width"),
        real_parameter("edge_fade_width", 0.04, 1e-4, 1,
                       "width of edge_fade = border, as a share of the image's height"),
        real_parameter("depth_step_fade_m", 0, 0, 1e6,
                       "depth difference to a neighbouring pixel at which a hit's weight reaches 0; 0: no such fade"),
        choice_parameter(FadeOperator::product, "how the fades are combined into one weight"),
        real_parameter("base_colour_min_weight", 0, 0, 1, "smallest weight of the reflector's own colour"),
        choice_parameter(Attenuation::off,
                         "falloff of reflected light with the ray's length d in metres: none, 1/d or 1/d^2; at most 1"),
        real_parameter("min_direction_cosine", -1, -1, 1,
                       "smallest cosine between the ray and the direction to the hit surface; below it the hit counts "
                       "as a miss; -1: every hit counts"),
        boolean_parameter(
            "stopped_shows_front", true,
            "a ray that stopped (behind = stop) brings back the light of the pixel where it stopped, "
            "whose other side it met, unless miss_light lets the scene's triangles answer; false: it counts as "
            "a miss")};
}

} // namespace

Pass hit_colour_pass()
{
    return {.id      = "hit_colour",
            .summary = "Turns each hit into a colour and a weight: hit tests, fades, attenuation",
            .cite    = {"J. Somerville Roberts, Screen Space Reflections", "Litheon 2012, Real-Time Local Reflections",
                        "A. Biro 2015, Report on Screen-Space Reflections"},
            .reads   = {Resource::gbuffer, Resource::light, Resource::layers, Resource::surroundings, Resource::rays,
                        Resource::hits, Resource::answers, Resource::small_colour, Resource::cones},
            .writes  = {Resource::reflection, Resource::block_pixel, Resource::lobe_rays},
            .parameters = parameters(),
            .decide     = needed_if_anything_reflects,
            .prepare    = prepare};
}

} // namespace ssrlab
