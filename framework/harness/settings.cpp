// The settings that belong to an experiment, not to a technique.
#include "harness/experiment.h"

#include <algorithm>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Trace settings hold for all techniques alike; `field` is a member of TraceSettings.
template <typename Field>
Setting trace_setting(const char* name, ParameterType type, Field TraceSettings::*field, double max, const char* doc)
{
    const Parameter parameter{name, type, static_cast<double>(TraceSettings{}.*field), 0, max, {}, doc};
    return {parameter, "trace",
            [=](const FrameSettings& settings) {
                return format_parameter(parameter, static_cast<double>(settings.trace.*field));
            },
            [=](FrameSettings& settings, double value) { settings.trace.*field = static_cast<Field>(value); }};
}

template <typename Choice>
Setting trace_choice(const char* name, Choice TraceSettings::*field, std::span<const std::string_view> choices,
                     const char* doc)
{
    return {
        {.name          = name,
         .type          = ParameterType::choice,
         .default_value = static_cast<double>(TraceSettings{}.*field),
         .max           = static_cast<double>(choices.size() - 1),
         .choices       = {choices.begin(), choices.end()},
         .doc           = doc},
        "trace",
        [=](const FrameSettings& settings) { return std::string(choices[static_cast<size_t>(settings.trace.*field)]); },
        [=](FrameSettings& settings, double value) { settings.trace.*field = static_cast<Choice>(value); }};
}

Setting surface_setting(std::span<const Surface> surfaces)
{
    Parameter parameter{.name    = "surface",
                        .type    = ParameterType::choice,
                        .max     = static_cast<double>(surfaces.size()) - 1,
                        .choices = {},
                        .doc     = "what a pixel holds around its depth: a surface model, see ssrlab list and "
                                   "docs/hit_contract.md"};
    std::ranges::transform(surfaces, std::back_inserter(parameter.choices), &Surface::id);
    const auto usual        = std::ranges::find(parameter.choices, TraceSettings{}.surface);
    parameter.default_value = static_cast<double>(usual - parameter.choices.begin());
    return {parameter, "trace", [](const FrameSettings& settings) { return settings.trace.surface; },
            [choices = parameter.choices](FrameSettings& settings, double value) {
                settings.trace.surface = choices.at(static_cast<size_t>(value));
            }};
}

} // namespace

std::vector<Setting> all_settings(std::span<const Surface> surfaces)
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
        trace_choice(
            "behind", &TraceSettings::behind, behind_names,
            "what becomes of a ray that meets a pixel from a side that the frame does not show: hit, pass (the "
            "ray goes on) or stop (it ends without a hit)"),
        surface_setting(surfaces),
    };
    for (const Parameter& parameter : pass_parameters()) {
        const std::string& name = parameter.name;
        table.push_back({parameter, "passes",
                         [=](const FrameSettings& s) { return format_parameter(parameter, s.passes.at(name)); },
                         [=](FrameSettings& s, double value) { s.passes.at(name) = value; }});
    }
    return table;
}

std::span<const Setting> all_settings()
{
    static const std::vector<Setting> table = all_settings({});
    return table;
}

std::span<const Surface> surfaces_of(std::span<const Technique> techniques)
{
    return techniques.empty() ? std::span<const Surface>() : std::span(techniques.front().surfaces);
}

} // namespace ssrlab
