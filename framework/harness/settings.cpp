// The settings that belong to an experiment, not to a technique.
#include "harness/experiment.h"

#include "core/error.h"
#include "core/names.h"
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
    const FrameSettings defaults;
    return {{name, type, static_cast<double>(defaults.trace.*field), min, max, {}, doc},
            "trace",
            [=](const FrameSettings& settings) { return static_cast<double>(settings.trace.*field); },
            [=](FrameSettings& settings, double value) { settings.trace.*field = static_cast<Field>(value); }};
}

template <typename Choice>
Setting trace_choice(const char* name, Choice TraceSettings::*field, std::span<const std::string_view> choices,
                     const char* doc)
{
    const FrameSettings defaults;
    return {{.name          = name,
             .type          = ParameterType::choice,
             .default_value = static_cast<double>(defaults.trace.*field),
             .max           = static_cast<double>(choices.size() - 1),
             .choices       = {choices.begin(), choices.end()},
             .doc           = doc},
            "trace",
            [=](const FrameSettings& settings) { return static_cast<double>(settings.trace.*field); },
            [=](FrameSettings& settings, double value) { settings.trace.*field = static_cast<Choice>(value); }};
}

/// A setting whose choices were found on disk.
Setting found_choice(const char* name, const char* table, std::vector<std::string> ids, const char* doc,
                     const std::function<std::string&(FrameSettings&)>& id_in)
{
    const auto get = [=](const FrameSettings& settings) {
        FrameSettings copy  = settings;
        const auto    found = std::ranges::find(ids, id_in(copy));
        if (found == ids.end()) throw SpecError(unknown_name(name, id_in(copy), ids));
        return static_cast<double>(found - ids.begin());
    };
    const FrameSettings defaults;
    const Parameter     parameter{.name          = name,
                                  .type          = ParameterType::choice,
                                  .default_value = get(defaults),
                                  .max           = static_cast<double>(ids.size()) - 1,
                                  .choices       = ids,
                                  .doc           = doc};
    return {parameter, table, get,
            [=](FrameSettings& settings, double value) { id_in(settings) = ids[static_cast<size_t>(value)]; }};
}

template <typename Item> std::vector<std::string> ids_of(const std::vector<Item>& items)
{
    std::vector<std::string> ids;
    std::ranges::transform(items, std::back_inserter(ids), &Item::id);
    return ids;
}

/// Of a pass or of a reprojection strategy; the latter are in FrameSettings::passes when they are not at their default.
Setting pass_setting(const Parameter& parameter)
{
    return {parameter, "passes",
            [=](const FrameSettings& settings) {
                const auto found = settings.passes.find(parameter.name);
                return found == settings.passes.end() ? parameter.default_value : found->second;
            },
            [=](FrameSettings& settings, double value) { settings.passes[parameter.name] = value; }};
}

} // namespace

std::vector<Setting> all_settings(const Catalogue& catalogue)
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
        found_choice("surface", "trace", ids_of(catalogue.surfaces),
                     "what a pixel holds around its depth: a surface model (ssrlab show NAME), see "
                     "docs/reference/hit_contract.md",
                     [](FrameSettings& settings) -> std::string& { return settings.trace.surface; }),
        trace_setting("layers", integer, &TraceSettings::layers, MAX_LAYERS,
                      "surfaces that a pixel holds, one behind the other: the first, and the next that face the camera",
                      1),
    };
    for (const Parameter& parameter : plan_parameters()) table.push_back(pass_setting(parameter));
    for (const Pass& pass : all_passes()) {
        for (const Parameter& parameter : pass.parameters) table.push_back(pass_setting(parameter));
        if (pass.id == reprojection_pass().id)
            table.push_back(
                found_choice("reprojection", "passes", ids_of(catalogue.reprojections),
                             "where a reflection was in the frame before: a folder with reprojection.toml, see "
                             "docs/explanation/motion.md",
                             [](FrameSettings& settings) -> std::string& { return settings.reprojection; }));
    }
    for (const Reprojection& strategy : catalogue.reprojections)
        for (const Parameter& parameter : strategy.parameters) table.push_back(pass_setting(parameter));
    return table;
}

std::vector<std::string> names_of(std::span<const Setting> settings)
{
    std::vector<std::string> names;
    std::ranges::transform(settings, std::back_inserter(names), &Setting::name);
    return names;
}

} // namespace ssrlab
