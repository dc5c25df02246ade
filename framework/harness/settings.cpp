// The settings that belong to an experiment, not to a technique.
#include "harness/experiment.h"

#include "shared.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Trace settings hold for all techniques alike; `field` is a member of TraceSettings.
template <typename Field>
Setting trace_setting(const char* name, ParameterType type, Field TraceSettings::*field, double max, const char* doc,
                      double min = 0)
{
    return {{name, type, static_cast<double>(FrameSettings{}.trace.*field), min, max, {}, doc},
            "trace",
            [=](const FrameSettings& settings) { return static_cast<double>(settings.trace.*field); },
            [=](FrameSettings& settings, double value) { settings.trace.*field = static_cast<Field>(value); }};
}

template <typename Choice>
Setting trace_choice(const char* name, Choice TraceSettings::*field, std::span<const std::string_view> choices,
                     const char* doc)
{
    return {{.name          = name,
             .type          = ParameterType::choice,
             .default_value = static_cast<double>(FrameSettings{}.trace.*field),
             .max           = static_cast<double>(choices.size() - 1),
             .choices       = {choices.begin(), choices.end()},
             .doc           = doc},
            "trace",
            [=](const FrameSettings& settings) { return static_cast<double>(settings.trace.*field); },
            [=](FrameSettings& settings, double value) { settings.trace.*field = static_cast<Choice>(value); }};
}

Setting surface_setting()
{
    const std::span<const Surface> surfaces = all_surfaces();
    Parameter                      parameter{.name    = "surface",
                                             .type    = ParameterType::choice,
                                             .max     = static_cast<double>(surfaces.size() - 1),
                                             .choices = {},
                                             .doc = "what a pixel holds around its depth: a surface model (ssrlab show NAME), see "
                                                    "docs/reference/hit_contract.md"};
    std::ranges::transform(surfaces, std::back_inserter(parameter.choices), &Surface::id);
    const auto number_of = [=](const TraceSettings& trace) {
        return static_cast<double>(&find_surface(trace.surface) - surfaces.data());
    };
    parameter.default_value = number_of(FrameSettings{}.trace);
    return {parameter, "trace", [=](const FrameSettings& settings) { return number_of(settings.trace); },
            [=](FrameSettings& settings, double value) {
                settings.trace.surface = surfaces[static_cast<size_t>(value)].id;
            }};
}

std::vector<Setting> make_table()
{
    using enum ParameterType;
    std::vector<Setting> table = {
        trace_setting("thickness_m", real, &TraceSettings::thickness_m, 1e6,
                      "depth of the slab behind each pixel, in metres; with thickness_relative a fraction of the "
                      "distance"),
        trace_setting("thickness_relative", boolean, &TraceSettings::thickness_relative, 1,
                      "whether thickness_m is a fraction of the distance"),
        trace_setting("max_distance_m", real, &TraceSettings::max_distance_m, infinity,
                      "length of the ray in view space"),
        trace_setting("ray_offset_m", real, &TraceSettings::ray_offset_m, 1e6,
                      "how far along its direction the ray starts"),
        trace_setting(
            "dielectric_min_f0", real, &TraceSettings::dielectric_min_f0, 1,
            "surfaces that are not metal reflect if their reflectance at normal incidence is at least this; 1: "
            "only metals reflect"),
        trace_setting("dielectric_max_roughness", real, &TraceSettings::dielectric_max_roughness, 1,
                      "surfaces that are not metal reflect up to this roughness"),
        trace_choice(
            "behind", &TraceSettings::behind, behind_names,
            "what becomes of a ray that meets a pixel from a side that the frame does not show: hit, pass (the "
            "ray goes on) or stop (it ends without a hit)"),
        surface_setting(),
        trace_setting("layers", integer, &TraceSettings::layers, MAX_LAYERS,
                      "surfaces that a pixel holds, one behind the other: the first, and the next that face the camera",
                      1),
    };
    for (const Parameter& parameter : all_pass_settings()) {
        const std::string name = parameter.name;
        table.push_back({parameter, "passes", [=](const FrameSettings& s) { return s.passes.at(name); },
                         [=](FrameSettings& s, double value) { s.passes.at(name) = value; }});
    }
    return table;
}

} // namespace

std::span<const Setting> all_settings()
{
    static const std::vector<Setting> table = make_table();
    return table;
}

} // namespace ssrlab
