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

Need depth_pyramid_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (std::ranges::count(facts.inputs, "depth_pyramid") == 0) return {Call::off, "the technique reads none"};
    return where_something_reflects(facts, statistics, values);
}

bool beyond_shading(const ParameterValues& values) { return values.at("effect_set") == 0; }

Need hidden_layer_need(const FrameFacts& facts, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (!beyond_shading(values)) return {Call::off, "effect_set = shading"};
    if (values.at("hidden_layer") == 0) return {Call::off, "hidden_layer = false"};
    if (!facts.scene) return {Call::off, "no scene to draw again"};
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
    if (!beyond_shading(values)) return {Call::off, "effect_set = shading"};
    if (values.at("bounce_mode") == 0) return {Call::off, "bounce_mode = off"};
    const TraceCounts& trace = statistics.trace;
    if (trace.mirror_hits == 0) return {Call::not_needed, fmt::format("none of {} hits reflects", trace.hits)};
    return {Call::needed, fmt::format("{} of {} hits reflect", percent(trace.mirror_hits, trace.hits), trace.hits)};
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
         .shader  = "effects/classification.comp",
         .reads   = {"depth_image", "normal_image", "material_image"},
         .writes  = {"TileCount", "Tiles", "PictureStatistics"},
         .need    = classification_need},
        {.id      = "rays",
         .summary = "Sets up one ray for each pixel that reflects",
         .shader  = "rays.comp",
         .reads   = {"View", "TileCount", "Tiles", "depth_image", "normal_image", "material_image"},
         .writes  = {"RayCount", "RayOrigins", "RayDeltas", "RayLengths", "RayPixels"},
         .need    = where_something_reflects},
        {.id      = "depth_pyramid",
         .summary = "Reduces the depth image level by level",
         .shader  = "depth_pyramid.comp",
         .reads   = {"depth_image"},
         .writes  = {"depth_pyramid"},
         .need    = depth_pyramid_need},
        {.id      = "trace",
         .summary = "The technique on the list of rays",
         .shader  = "trace.comp",
         .reads   = {"View", "RayCount", "RayOrigins", "RayDeltas", "RayLengths", "RayPixels", "depth_image",
                     "normal_image", "depth_pyramid"},
         .writes  = {"HitPixels", "HitTs"},
         .need    = where_something_reflects},
        {.id      = "hidden_layer",
         .summary = "A second depth layer by depth peeling, and the rays that found nothing traced in it",
         .cite    = {"C. Everitt 2001, Interactive Order-Independent Transparency",
                     "M. Mara, M. McGuire, D. Nowrouzezahrai, D. Luebke 2016, Deep G-Buffers for Stable Global "
                        "Illumination Approximation"},
         .shader  = "effects/gather_misses.comp",
         .reads   = {"View", "RayCount", "RayOrigins", "RayDeltas", "RayLengths", "RayPixels", "depth_image",
                     "normal_image", "material_image"},
         .writes  = {"HitPixels", "HitTs"},
         .parameters =
             {boolean("hidden_layer", true, "whether rays that find nothing are traced in a second depth layer"),
              real("hidden_layer_separation_m", 0.5, 0, 1e6,
                   "the second layer is the nearest surface more than so far behind the first"),
              real("hidden_layer_threshold", 0, 0, 1,
                   "the second layer is left out up to this share of rays without hit; above 0 pictures change")},
         .need = hidden_layer_need},
        {.id      = "hit_colour",
         .summary = "Colour and weight of what each ray hit: hit tests, fades, attenuation",
         .cite    = {"J. Somerville Roberts, Screen Space Reflections", "Litheon 2012, Real-Time Local Reflections",
                     "A. Biro 2015, Report on Screen-Space Reflections"},
         .shader  = "effects/hit_colour.comp",
         .reads   = {"View", "RayCount", "RayOrigins", "RayDeltas", "RayPixels", "HitPixels", "HitTs", "depth_image",
                     "normal_image", "material_image", "radiance_image", "highlight_image"},
         .writes  = {"reflection_image"},
         .parameters =
             {choice("hit_light", {"diffuse", "lit"},
                     "light of the hit: the part that is the same from every direction, or all that the camera sees"),
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
         .shader  = "effects/bounce_rays.comp",
         .reads   = {"View", "RayCount", "RayOrigins", "RayDeltas", "RayPixels", "HitPixels", "HitTs", "depth_image",
                     "normal_image", "material_image", "radiance_image", "highlight_image", "depth_pyramid"},
         .writes  = {"reflection_image"},
         .parameters =
             {starting_with(choice("bounce_mode", {"off", "history", "direct"},
                                   "further bounces: none, by the previous frames' reflections as the camera saw them, "
                                   "or traced in the arriving ray's mirror direction"),
                            "direct"),
              integer("bounces", 1, 1, 16, "further bounces, or earlier frames; each adds one level of reflection")},
         .need = bounces_need},
        {.id         = "composite",
         .summary    = "Own and reflected light together: C = C_own + (C_reflected - C_own) * beta",
         .cite       = {"J. Somerville Roberts, Screen Space Reflections"},
         .shader     = "effects/composite.comp",
         .reads      = {"radiance_image", "highlight_image", "material_image", "reflection_image"},
         .writes     = {"shaded_image"},
         .parameters = {real("metallic_exponent", 3, 0, 64,
                             "beta = weight * metallic ^ exponent; 0 switches the factor off")},
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
        const Need need = effect.need(facts, statistics, values);
        const bool runs = need.call == Call::needed || (need.call == Call::not_needed && values.at("plan") == 0);
        plan.push_back({&effect, runs, need.reason});
    }
    return plan;
}

bool plan_needs_trace(const ParameterValues& values) { return values.at("effect_set") == 0; }

} // namespace ssrlab
