#include "render/effects.h"

#include <fmt/format.h>

#include <algorithm>

namespace ssrlab {
namespace {

Parameter choice(const char* name, std::vector<std::string> choices, const char* doc)
{
    return {name, ParameterType::choice, 0, 0, static_cast<double>(choices.size() - 1), std::move(choices), doc};
}

Parameter real(const char* name, double otherwise, double min, double max, const char* doc)
{
    return {name, ParameterType::real, otherwise, min, max, {}, doc};
}

Parameter integer(const char* name, double otherwise, double min, double max, const char* doc)
{
    return {name, ParameterType::integer, otherwise, min, max, {}, doc};
}

Parameter boolean(const char* name, bool otherwise, const char* doc)
{
    return {name, ParameterType::boolean, otherwise ? 1.0 : 0.0, 0, 1, {}, doc};
}

Parameter starting_with(Parameter parameter, const char* otherwise)
{
    parameter.default_value =
        static_cast<double>(std::ranges::find(parameter.choices, otherwise) - parameter.choices.begin());
    return parameter;
}

std::string percent(uint32_t part, uint32_t whole)
{
    return fmt::format("{:.3g} %", whole == 0 ? 0.0 : 100.0 * part / whole);
}

Need where_something_reflects(const FrameFacts& /*facts*/, const FrameStatistics& statistics,
                              const ParameterValues& /*values*/)
{
    const uint32_t reflecting = statistics.picture.reflecting_pixels;
    if (reflecting == 0) return {Call::not_needed, "no pixel reflects"};
    return {Call::needed, fmt::format("{} pixels reflect ({})", reflecting, percent(reflecting, statistics.pixels))};
}

Need classification_need(const FrameFacts& /*facts*/, const FrameStatistics& statistics,
                         const ParameterValues& /*values*/)
{
    const uint32_t tiles = statistics.picture.reflecting_tiles;
    if (tiles == 0) return {Call::not_needed, "no pixel reflects"};
    return {Call::needed, fmt::format("{} of {} tiles reflect", tiles, statistics.tiles)};
}

Need structures_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (facts.structures.empty()) return {Call::off, "the technique reads none"};
    return where_something_reflects(facts, statistics, values);
}

/// Effects that continue the rays one by one.
bool one_ray_per_pixel(const ParameterValues& values)
{
    return values.at("rays_per_pixel") == 1 && trace_block_px(values) == 1;
}

Need hidden_layer_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("hidden_layer") == 0) return {Call::off, "hidden_layer = false"};
    if (!facts.scene) return {Call::off, "no scene to draw again"};
    if (!one_ray_per_pixel(values)) return {Call::off, "needs one ray per pixel at full resolution"};
    const TraceCounts& trace  = statistics.trace;
    const uint32_t     misses = trace.rays - trace.hits;
    if (misses == 0) return {Call::not_needed, fmt::format("none of {} rays missed", trace.rays)};
    const double      threshold = values.at("hidden_layer_threshold");
    const std::string reason    = fmt::format("{} of {} rays found nothing", percent(misses, trace.rays), trace.rays);
    if (misses <= threshold * trace.rays)
        return {Call::off, fmt::format("{}, the threshold is {:.3g} %", reason, 100 * threshold)};
    return {Call::needed, reason};
}

Need bounces_need(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("bounce_mode") == 0) return {Call::off, "bounce_mode = off"};
    if (!one_ray_per_pixel(values)) return {Call::off, "needs one ray per pixel at full resolution"};
    const TraceCounts& trace = statistics.trace;
    if (trace.mirror_hits == 0) return {Call::not_needed, fmt::format("none of {} hits reflects", trace.hits)};
    return {Call::needed, fmt::format("{} of {} hits reflect", percent(trace.mirror_hits, trace.hits), trace.hits)};
}

Need where_something_is_rough(const FrameStatistics& statistics)
{
    const uint32_t all = statistics.picture.reflecting_pixels, rough = all - statistics.picture.roughness_pixels[0];
    if (all == 0) return {Call::not_needed, "no pixel reflects"};
    if (rough == 0) return {Call::not_needed, "every pixel that reflects is smooth"};
    return {Call::needed, fmt::format("{} of the reflecting pixels are rough", percent(rough, all))};
}

Need blur_need(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("gloss") != 1) return {Call::off, "gloss is not done by blur"};
    if (statistics.picture.reflecting_pixels > 0 && values.at("blur_bias") > 0)
        return {Call::needed, "blur_bias is above 0"};
    return where_something_is_rough(statistics);
}

Need cone_pyramid_need(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("gloss") != 2) return {Call::off, "gloss is not done by cones"};
    return where_something_is_rough(statistics);
}

Need environment_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("environment") == 0) return {Call::off, "environment = false"};
    if (!facts.scene) return {Call::off, "a picture without a scene has no environment"};
    const TraceCounts& trace = statistics.trace;
    if (statistics.picture.reflecting_pixels == 0) return {Call::not_needed, "no pixel reflects"};
    if (trace.hits < trace.rays)
        return {Call::needed,
                fmt::format("{} of the rays found nothing", percent(trace.rays - trace.hits, trace.rays))};
    for (const char* fade : {"viewer_fade", "edge_fade", "depth_step_fade_m", "own_share"})
        if (values.at(fade) != 0) return {Call::needed, fmt::format("{} blends into it", fade)};
    if (values.at("min_direction_cosine") > -1) return {Call::needed, "min_direction_cosine may refuse hits"};
    return {Call::not_needed, "every ray found something, and nothing fades"};
}

Need at_lower_resolution(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    const int block_px = trace_block_px(values);
    if (block_px == 1)
        return {shading_only(values) ? Call::off : Call::not_needed, "each pixel that reflects has rays of its own"};
    if (statistics.picture.reflecting_pixels == 0) return where_something_reflects(facts, statistics, values);
    return {Call::needed, fmt::format("one pixel in {} has rays", block_px * block_px)};
}

Need colour_downsampling_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("cross_blur") == 0) return {Call::off, "cross_blur = false"};
    return at_lower_resolution(facts, statistics, values);
}

Need kernel_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (values.at("kernel") == 0) return {Call::off, "kernel = off"};
    if (statistics.picture.reflecting_pixels == 0) return where_something_reflects(facts, statistics, values);
    const bool second_layer = hidden_layer_need(facts, statistics, values).call == Call::needed;
    if (statistics.trace.hits == 0 && !second_layer) return {Call::not_needed, "no ray hits anything"};
    return {Call::needed, fmt::format("{} rays hit ({})", statistics.trace.hits,
                                      percent(statistics.trace.hits, statistics.trace.rays))};
}

Need always(const FrameFacts& /*facts*/, const FrameStatistics& /*statistics*/, const ParameterValues& /*values*/)
{
    return {Call::needed, "every picture"};
}

std::vector<Effect> make_table()
{
    return {
        {.id      = "classification",
         .summary = "Lists the 8 x 8 tiles that reflect; all later passes up to the compositing work on these alone",
         .shader  = "rays/classification.comp",
         .reads   = {"View", "depth_words", "normal_image", "material_image"},
         .writes  = {"TileMasks", "TileCount", "Tiles", "RayCount", "PictureStatistics"},
         .need    = classification_need},
        {.id      = "rays",
         .summary = "Sets up the rays of each pixel that reflects",
         .cite    = {"J. Somerville Roberts, Screen Space Reflections"},
         .shader  = "rays/rays.comp",
         .reads   = {"View", "TileMasks", "TileCount", "Tiles", "depth_words", "normal_image", "material_image"},
         .writes  = {"Rays"},
         .parameters =
             {integer(
                  "rays_per_pixel", 1, 1, 16,
                  "rays that start at random places inside the pixel; 1: at its centre. They count as a miss unless "
                  "more than half of them hit. Beside the centre a ray may meet a neighbour of its own surface: "
                  "ray_offset_m starts it clear of those"),
              choice("trace_resolution", {"full", "half", "quarter"},
                     "pixels that have rays: all that reflect, or the first one of each block of 2 x 2 or 4 x 4, from "
                     "its centre outward")},
         .need = where_something_reflects},
        {.id      = "structures",
         .summary = "Builds what the technique reads beside depth, such as the depth pyramid",
         .shader  = "",
         .need    = structures_need},
        {.id      = "trace",
         .summary = "The technique on the list of rays",
         .shader  = "trace/trace.comp",
         .reads   = {"View", "RayCount", "Rays", "depth_words", "normal_image", "depth_pyramid", "PatchPlanes"},
         .writes  = {"Beams", "Hits"},
         .need    = where_something_reflects},
        {.id      = "hidden_layer",
         .summary = "A second depth layer by depth peeling, and the rays that found nothing traced in it",
         .cite    = {"C. Everitt 2001, Interactive Order-Independent Transparency",
                     "M. Mara, M. McGuire, D. Nowrouzezahrai, D. Luebke 2016, Deep G-Buffers for Stable Global "
                        "Illumination Approximation"},
         .shader  = "passes/gather_misses.comp",
         .reads   = {"View", "RayCount", "Rays", "depth_words", "normal_image", "material_image"},
         .writes  = {"Hits"},
         .parameters =
             {boolean("hidden_layer", false, "whether rays that find nothing are traced in a second depth layer"),
              real("hidden_layer_separation_m", 0.5, 0, 1e6,
                   "the second layer is the nearest surface more than so far behind the first"),
              real("hidden_layer_threshold", 0, 0, 1,
                   "the second layer is left out up to this share of rays without hit; above 0 pictures change")},
         .need           = hidden_layer_need,
         .beyond_shading = true},
        {.id         = "colour_downsampling",
         .summary    = "The lit colour at the resolution of the rays, blurred in the shape of a cross",
         .cite       = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling"},
         .shader     = "passes/colour_downsampling.comp",
         .reads      = {"radiance_image", "highlight_image"},
         .writes     = {"small_colour_image"},
         .parameters = {boolean("cross_blur", true,
                                "whether rays at half and quarter resolution find colours of that resolution, slightly "
                                "blurred")},
         .need       = colour_downsampling_need},
        {.id             = "cone_pyramid",
         .summary        = "Gloss by cones: colours and visibility level by level, for hit_colour to look up",
         .cite           = {"Y. Uludag 2014, Hi-Z Screen-Space Cone-Traced Reflections (GPU Pro 5)"},
         .shader         = "passes/cone_pyramid.comp",
         .reads          = {"View", "depth_words", "radiance_image", "highlight_image"},
         .writes         = {"cone_pyramid", "cone_ranges"},
         .parameters     = {real("cone_scale", 0.75, 0, 2,
                                 "half the angle of a cone, as a share of the angle that the article derives from the "
                                     "roughness"),
                            integer("cone_steps", 2, 1, 16, "circles in a cone, from the hit back to the reflector")},
         .need           = cone_pyramid_need,
         .beyond_shading = true},
        {.id      = "hit_colour",
         .summary = "Colour and weight of what each ray hit: hit tests, fades, attenuation",
         .cite    = {"J. Somerville Roberts, Screen Space Reflections", "Litheon 2012, Real-Time Local Reflections",
                     "A. Biro 2015, Report on Screen-Space Reflections"},
         .shader  = "passes/hit_colour.comp",
         .reads   = {"View", "RayCount", "Rays", "Hits", "depth_words", "normal_image", "material_image",
                     "radiance_image", "highlight_image", "small_colour_image", "cone_pyramid"},
         .writes  = {"reflection_image", "block_pixel_image"},
         .parameters =
             {choice("hit_light", {"diffuse", "lit", "mirrored"},
                     "light of the hit: the part that is the same from every direction; with the highlights that the "
                     "camera sees; or with those that the reflector sees"),
              starting_with(choice("viewer_fade", {"off", "linear", "cut", "smooth"},
                                   "weight of reflections toward the viewer, by a = -R.z: a, none below 0, or (a - "
                                   "viewer_fade_start) / (1 - viewer_fade_start)"),
                            "linear"),
              real("viewer_fade_start", 0, -1, 0.99, "a = -R.z at which viewer_fade = smooth begins"),
              starting_with(choice("edge_fade", {"off", "manhattan", "linear", "squared"},
                                   "weight of hits by their distance from the image's centre: 1 - |u-1/2| - |v-1/2|, "
                                   "or 1 - 2r, or 1 - (2r)^2"),
                            "manhattan"),
              real("depth_step_fade_m", 0, 0, 1e6,
                   "weight of hits falls to 0 where a neighbour's depth differs by so much; 0 switches this off"),
              choice("fade_combination", {"product", "minimum"}, "how the weights make one"),
              real("own_share", 0, 0, 1, "the reflector's own colour keeps at least this share"),
              choice("attenuation", {"off", "inverse", "inverse_square"},
                     "reflected light falls with the ray's length d in metres: not, 1/d or 1/d^2, never above 1"),
              real("min_direction_cosine", -1, -1, 1,
                   "a hit counts when the direction to its surface and the ray's have at least this cosine; -1: "
                   "always")},
         .need = where_something_reflects},
        {.id      = "bounces",
         .summary = "Mirror in mirror: further bounces where what was hit reflects, too",
         .cite    = {"J. Somerville Roberts, Screen Space Reflections"},
         .shader  = "passes/bounce_rays.comp",
         .reads   = {"View", "RayCount", "Rays", "Hits", "depth_words", "normal_image", "material_image",
                     "radiance_image", "highlight_image", "depth_pyramid"},
         .writes  = {"reflection_image"},
         .parameters =
             {starting_with(choice("bounce_mode", {"off", "history", "direct"},
                                   "further bounces: none, by the previous frames' reflections as the camera saw them, "
                                   "or traced in the arriving ray's mirror direction"),
                            "direct"),
              integer("bounces", 1, 1, 16, "further bounces, or earlier frames; each adds one level of reflection")},
         .need           = bounces_need,
         .beyond_shading = true},
        {.id      = "upsampling",
         .summary = "Gives pixels without rays what the 2 x 2 traced pixels about them reflect",
         .cite    = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling",
                     "B. Karis 2014, Physically Based Shading on Mobile"},
         .shader  = "passes/upsampling.comp",
         .reads   = {"View", "TileCount", "Tiles", "depth_words", "normal_image", "material_image", "block_pixel_image",
                     "reflection_image"},
         .writes  = {"reflection_image"},
         .parameters = {starting_with(
                            choice(
                                "upsampling_weights", {"bilinear", "depth", "depth_normal", "reflectivity"},
                                "by what the four are weighted; each adds to the one before. Reflectivity: specular "
                                "response by gloss, with Fresnel. Where all weights vanish, the most alike is taken"),
                            "reflectivity"),
                        real("upsampling_depth_tolerance", 0.01, 1e-6, 1e6,
                             "a step between surfaces of this share of the distance has the weight 1/e"),
                        real("upsampling_reflectivity_tolerance", 0.05, 1e-6, 1e6,
                             "a difference of reflectivity of this much has the weight 1/e")},
         .need       = at_lower_resolution},
        {.id             = "kernel_filter",
         .summary        = "A 3 x 3 kernel over what neighbouring pixels reflect, against noise",
         .cite           = {"J. Somerville Roberts, Screen Space Reflections"},
         .shader         = "passes/filter_3x3.comp",
         .reads          = {"TileCount", "Tiles", "reflection_image"},
         .writes         = {"filtered_image", "reflection_image"},
         .parameters     = {choice("kernel", {"off", "box3", "median3"},
                                   "none, the mean, or the neighbour of median brightness")},
         .need           = kernel_need,
         .beyond_shading = true},
        {.id             = "blur",
         .summary        = "Gloss by a separable Gaussian whose radius follows the roughness",
         .cite           = {"B. Wronski 2014, GDC follow-up: Screenspace reflections filtering and up-sampling"},
         .shader         = "passes/blur.comp",
         .reads          = {"View", "depth_words", "normal_image", "material_image", "reflection_image"},
         .writes         = {"filtered_image", "reflection_image"},
         .parameters     = {starting_with(choice("gloss", {"off", "blur", "cone"},
                                                 "how reflections on rough surfaces widen: not, by a blur of the picture "
                                                     "of reflections, or by colours looked up along a cone"),
                                          "blur"),
                            real("blur_scale", 0.1, 0, 1, "radius at roughness 1, as a share of the image's height"),
                            real("blur_bias", 0, -1, 1, "added to the radius, as a share of the image's height"),
                            real("blur_hole_widening", 2, 1, 16, "how much wider a pixel without a hit looks"),
                            real("blur_hole_weight", 0.3, 0, 1, "weight of a neighbour without a hit")},
         .need           = blur_need,
         .beyond_shading = true},
        {.id      = "environment",
         .summary = "Where rays found nothing or fade: what arrives from infinitely far away",
         .shader  = "passes/environment.comp",
         .reads   = {"View", "TileCount", "Tiles", "depth_words", "normal_image", "material_image", "environment_map",
                     "reflection_image"},
         .writes  = {"reflection_image"},
         .parameters = {boolean("environment", true, "whether the environment stands in for what a ray did not find")},
         .need       = environment_need,
         .beyond_shading = true},
        {.id         = "composite",
         .summary    = "Own and reflected light together: C = C_own + (C_reflected - C_own) * beta",
         .cite       = {"J. Somerville Roberts, Screen Space Reflections"},
         .shader     = "passes/composite.comp",
         .reads      = {"View", "depth_words", "normal_image", "material_image", "radiance_image", "highlight_image",
                        "reflection_image"},
         .writes     = {"shaded_image"},
         .parameters = {choice(
                            "reflectance", {"metallic", "ggx"},
                            "beta = weight * metallic ^ exponent, or weight * the share that a GGX surface reflects"),
                        real("metallic_exponent", 3, 0, 64, "for reflectance = metallic; 0 switches the factor off")},
         .need       = always},
    };
}

} // namespace

std::span<const Effect> all_effects()
{
    static const std::vector<Effect> table = make_table();
    return table;
}

std::span<const Parameter> effect_parameters()
{
    static const std::vector<Parameter> parameters = [] {
        std::vector<Parameter> all = {
            boolean("plan", true, "whether passes run only where the picture needs them; false: all, on every pixel"),
            choice("effect_set", {"all", "shading"},
                   "what may run: every effect, or nothing beyond trace and shading")};
        for (const Effect& effect : all_effects())
            all.insert(all.end(), effect.parameters.begin(), effect.parameters.end());
        return all;
    }();
    return parameters;
}

ParameterValues default_effect_values()
{
    ParameterValues values;
    for (const Parameter& parameter : effect_parameters()) values[parameter.name] = parameter.default_value;
    return values;
}

std::vector<PlannedEffect> plan_frame(const FrameFacts& facts, const FrameStatistics& statistics,
                                      const ParameterValues& values)
{
    std::vector<PlannedEffect> plan;
    for (const Effect& effect : all_effects()) {
        const Need need = effect.beyond_shading && shading_only(values) ? Need{Call::off, "effect_set = shading"}
                                                                        : effect.need(facts, statistics, values);
        const bool runs = need.call == Call::needed || (need.call == Call::not_needed && values.at("plan") == 0);
        plan.push_back({&effect, runs, need.reason});
    }
    return plan;
}

std::vector<std::string> describe_facts(const FrameFacts& facts, const FrameStatistics& statistics)
{
    const PictureCounts& picture   = statistics.picture;
    const auto           present   = [](uint32_t pixels) { return pixels > 0; };
    const auto           smoothest = std::ranges::find_if(picture.roughness_pixels, present);
    const auto           bin_of    = [&](auto bin) { return static_cast<double>(bin) / (ROUGHNESS_BINS - 1); };
    std::string          roughness = "nothing reflects";
    if (smoothest != picture.roughness_pixels.end()) {
        const auto roughest =
            std::ranges::find_if(picture.roughness_pixels.rbegin(), picture.roughness_pixels.rend(), present);
        const auto first = smoothest - picture.roughness_pixels.begin();
        const auto last  = picture.roughness_pixels.rend() - roughest - 1;
        roughness = fmt::format("roughness {:.2f} to {:.2f}", first == 0 ? 0.0 : bin_of(first - 1), bin_of(last));
    }
    return {fmt::format("{} of {} pixels reflect ({}), in {} of {} tiles; {}", picture.reflecting_pixels,
                        statistics.pixels, percent(picture.reflecting_pixels, statistics.pixels),
                        picture.reflecting_tiles, statistics.tiles, roughness),
            fmt::format("{} rays: {} found something, {} of these another mirror", statistics.trace.rays,
                        percent(statistics.trace.hits, statistics.trace.rays),
                        percent(statistics.trace.mirror_hits, statistics.trace.hits)),
            !facts.scene
                ? std::string("no scene: a picture from elsewhere")
                : fmt::format("environment {}, {} alpha mask, still camera and objects, no jitter",
                              facts.environment_map ? "map" : "of one colour", facts.alpha_mask ? "an" : "no")};
}

int trace_block_px(const ParameterValues& values) { return 1 << static_cast<int>(values.at("trace_resolution")); }

bool shading_only(const ParameterValues& values) { return values.at("effect_set") != 0; }

} // namespace ssrlab
