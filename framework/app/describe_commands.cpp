// ssrlab list and show: what there is.
#include "app/commands.h"

#include "core/error.h"
#include "core/names.h"
#include "gpu/gpu.h"
#include "harness/experiment.h"
#include "sources/source.h"
#include "truth/pixel_surface.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

std::string range_of(const Parameter& parameter)
{
    return parameter.type == ParameterType::choice    ? fmt::format("{}", fmt::join(parameter.choices, " | "))
           : parameter.type == ParameterType::boolean ? "true | false"
                                                      : fmt::format("{} … {}", parameter.min, parameter.max);
}

nlohmann::json json_of(const Parameter& parameter)
{
    nlohmann::json json{{"name", parameter.name},
                        {"default", format_parameter(parameter, parameter.default_value)},
                        {"doc", parameter.doc}};
    if (parameter.type == ParameterType::choice)
        json["choices"] = parameter.choices;
    else if (parameter.type == ParameterType::boolean)
        json["choices"] = {"false", "true"};
    else
        json["min"] = parameter.min, json["max"] = parameter.max;
    return json;
}

void print_parameter(const Parameter& parameter)
{
    std::puts(fmt::format("  {:<24} {} (default {})\n                           {}", parameter.name,
                          range_of(parameter), format_parameter(parameter, parameter.default_value), parameter.doc)
                  .c_str());
}

nlohmann::json json_of(const Technique& technique)
{
    nlohmann::json json{{"name", technique.id},
                        {"title", technique.name},
                        {"summary", technique.summary},
                        {"exact", technique.exact},
                        {"limits", technique.limits},
                        {"ignores", technique.ignores},
                        {"folder", technique.folder.string()},
                        {"sources", technique.cite},
                        {"structures", nlohmann::json::array()},
                        {"parameters", nlohmann::json::array()}};
    for (const Structure& structure : technique.structures) json["structures"].push_back(structure.id);
    for (const Parameter& parameter : technique.parameters) json["parameters"].push_back(json_of(parameter));
    return json;
}

int print_technique(const Technique& technique)
{
    std::puts(fmt::format("{} ({})\n{}\n", technique.name, technique.id, technique.summary).c_str());
    std::puts(technique.exact ? "exact: gives the pixel walk's answer on every ray" : "not exact");
    if (!technique.limits.empty()) std::puts(fmt::format("limits: {}", fmt::join(technique.limits, ", ")).c_str());
    if (!technique.ignores.empty())
        std::puts(fmt::format("its own hit test ignores: {}", fmt::join(technique.ignores, ", ")).c_str());
    std::puts(fmt::format("folder: {}", technique.folder.string()).c_str());
    for (const Structure& structure : technique.structures)
        std::puts(
            fmt::format("structure: {} ({}), {}", structure.id, structure.name, structure.folder.string()).c_str());
    for (const Accuracy& accuracy : technique.accuracy)
        std::puts(fmt::format("accuracy: {} (better when {})", accuracy.parameter,
                              accuracy.higher_is_better ? "higher" : "lower")
                      .c_str());
    for (const std::string& citation : technique.cite) std::puts(fmt::format("source: {}", citation).c_str());
    std::puts("\nParameters");
    for (const Parameter& parameter : technique.parameters) print_parameter(parameter);
    return 0;
}

std::vector<std::string> needs_of(const Surface& surface)
{
    std::vector<std::string> needs;
    if (surface.needs_gradient) needs.emplace_back("gradient");
    if (surface.needs_solid) needs.emplace_back("solid");
    return needs;
}

nlohmann::json json_of(const Surface& surface)
{
    return {{"name", surface.id},
            {"title", surface.name},
            {"summary", surface.summary},
            {"needs", needs_of(surface)},
            {"screen_truth", has_screen_truth(surface.id)},
            {"folder", surface.folder.string()},
            {"sources", surface.cite}};
}

int print_surface(const Surface& surface)
{
    std::puts(fmt::format("{} ({})\n{}\n", surface.name, surface.id, surface.summary).c_str());
    std::puts(fmt::format("a surface model: -p surface={}, in experiments surface = \"{}\" in [trace]", surface.id,
                          surface.id)
                  .c_str());
    std::puts(fmt::format("needs of the G-buffer, besides depth and normal: {}",
                          needs_of(surface).empty() ? "nothing" : fmt::format("{}", fmt::join(needs_of(surface), ", ")))
                  .c_str());
    std::puts(has_screen_truth(surface.id) ? "screen truth: yes"
                                           : "screen truth: none, the model is known by its shaders alone");
    std::puts(fmt::format("folder: {}", surface.folder.string()).c_str());
    for (const std::string& citation : surface.cite) std::puts(fmt::format("source: {}", citation).c_str());
    return 0;
}

/// A source, a structure or a reprojection strategy.
struct Part {
    std::string_view             kind, use;
    std::string                  id, summary, folder; // folder: empty for what is compiled in
    std::span<const std::string> cite;
    std::span<const Parameter>   parameters;
};

std::vector<Part> parts_of(const Catalogue& catalogue)
{
    std::vector<Part> parts;
    for (const Source& one : all_sources())
        parts.push_back({"source",
                         "a source of answers: --sources LIST, in experiments [sources]; its parameters follow its "
                         "name, NAME:PARAMETER=VALUE",
                         one.id, one.summary, "", one.cite, one.parameters});
    for (const Structure& one : catalogue.structures)
        parts.push_back({"structure", "a structure: techniques name it in their structures", one.id, one.summary,
                         one.folder.string(), one.cite, one.parameters});
    for (const Reprojection& one : catalogue.reprojections)
        parts.push_back({"reprojection", "a reprojection strategy: -p reprojection=NAME", one.id, one.summary,
                         one.folder.string(), one.cite, one.parameters});
    return parts;
}

nlohmann::json json_of(const Part& part)
{
    nlohmann::json json{{"name", part.id},       {"kind", part.kind},    {"summary", part.summary},
                        {"folder", part.folder}, {"sources", part.cite}, {"parameters", nlohmann::json::array()}};
    for (const Parameter& parameter : part.parameters) json["parameters"].push_back(json_of(parameter));
    return json;
}

int print_part(const Part& part)
{
    std::puts(fmt::format("{}\n{}\n\n{}", part.id, part.summary, part.use).c_str());
    if (!part.folder.empty()) std::puts(fmt::format("folder: {}", part.folder).c_str());
    for (const std::string& citation : part.cite) std::puts(fmt::format("source: {}", citation).c_str());
    if (!part.parameters.empty()) std::puts("\nParameters");
    for (const Parameter& parameter : part.parameters) print_parameter(parameter);
    return 0;
}

int print_setting(const Setting& setting)
{
    std::puts(fmt::format("A setting of [{}] in experiments, and of -p\n", setting.table).c_str());
    print_parameter(setting);
    return 0;
}

nlohmann::json list_as_json(const Catalogue& catalogue)
{
    nlohmann::json json{{"techniques", nlohmann::json::array()}, {"surfaces", nlohmann::json::array()},
                        {"parts", nlohmann::json::array()},      {"scenes", nlohmann::json::array()},
                        {"settings", nlohmann::json::array()},   {"devices", nlohmann::json::array()}};
    for (const Technique& technique : catalogue.techniques) json["techniques"].push_back(json_of(technique));
    for (const Surface& surface : catalogue.surfaces) json["surfaces"].push_back(json_of(surface));
    for (const Part& part : parts_of(catalogue)) json["parts"].push_back(json_of(part));
    for (const SceneListing& scene : list_scenes())
        json["scenes"].push_back({{"name", scene.name}, {"summary", scene.summary}});
    for (const Setting& setting : all_settings(catalogue)) {
        json["settings"].push_back(json_of(setting));
        json["settings"].back()["table"] = setting.table;
    }
    try {
        for (const GpuInfo& info : list_gpus())
            json["devices"].push_back({{"index", info.index},
                                       {"name", info.name},
                                       {"type", info.type},
                                       {"vulkan", info.api_version},
                                       {"driver", info.driver},
                                       {"storage", storage_text(info)},
                                       {"passes", passes_text(info)},
                                       {"double", info.float64},
                                       {"int64", info.int64}});
    } catch (const Failure& failure) {
        json["no_device"] = failure.what();
    }
    return json;
}

/// One row of a Markdown table.
std::string row_of(const Parameter& parameter)
{
    std::string doc = parameter.doc;
    for (size_t bar = doc.find('|'); bar != std::string::npos; bar = doc.find('|', bar + 2)) doc.insert(bar, "\\");
    const std::string range = parameter.type == ParameterType::choice
                                  ? fmt::format("{}", fmt::join(parameter.choices, ", "))
                              : parameter.type == ParameterType::boolean ? "true, false"
                                                                         : range_of(parameter);
    return fmt::format("| `{}` | {} | {} | {} |\n", parameter.name, range,
                       format_parameter(parameter, parameter.default_value), doc);
}

constexpr const char* markdown_introduction = R"(# Settings and parameters

Settings belong to the experiment and are equal for all techniques: tables `[trace]` and `[passes]`
of a specification. Parameters belong to a technique: its table `[techniques.NAME]`. On the command
line both are `-p NAME=VALUE`, and both are columns of `results.csv`.
)";

} // namespace

int list_as_markdown(const CommonOptions& common)
{
    constexpr const char* head      = "| name | range | default | meaning |\n|---|---|---|---|\n";
    const Catalogue       catalogue = load_catalogue(common.technique_dirs);
    std::string           text      = markdown_introduction;
    for (const char* table : {"trace", "passes"}) {
        text += fmt::format("\n## [{}]\n{}", table, head);
        for (const Setting& setting : all_settings(catalogue))
            if (setting.table == table) text += row_of(setting);
    }
    for (const Technique& technique : catalogue.techniques) {
        text += fmt::format("\n## [techniques.{}]\n{}", technique.id, head);
        for (const Parameter& parameter : technique.parameters) text += row_of(parameter);
    }
    std::fputs(text.c_str(), stdout);
    return 0;
}

int list_everything(const CommonOptions& common, bool json)
{
    const Catalogue            catalogue = load_catalogue(common.technique_dirs);
    const std::vector<Setting> settings  = all_settings(catalogue);
    if (json) {
        std::puts(list_as_json(catalogue).dump(1).c_str());
        return 0;
    }
    std::puts("Techniques");
    for (const Technique& technique : catalogue.techniques)
        std::puts(
            fmt::format("  {:<16} {}{}", technique.id, technique.summary, technique.exact ? " (exact)" : "").c_str());
    std::puts("\nSurface models: what a pixel is taken to hold");
    for (const Surface& surface : catalogue.surfaces)
        std::puts(fmt::format("  {:<16} {}", surface.id, surface.summary).c_str());
    const std::vector<Part> parts = parts_of(catalogue);
    for (const auto& [kind, title] : {std::pair("source", "Sources: where the answer to a ray may come from"),
                                      std::pair("structure", "Structures: what techniques read besides the G-buffer"),
                                      std::pair("reprojection", "Reprojection strategies")}) {
        std::puts(fmt::format("\n{}", title).c_str());
        for (const Part& part : parts)
            if (part.kind == kind) std::puts(fmt::format("  {:<16} {}", part.id, part.summary).c_str());
    }
    std::puts("\nScenes (besides any .glb, .gltf, recipe .toml or frame .exr by its path)");
    for (const SceneListing& scene : list_scenes())
        std::puts(fmt::format("  {:<26} {}", scene.name, scene.summary).c_str());
    std::puts("\nSettings (ssrlab show NAME)");
    for (const char* table : {"trace", "passes"}) {
        std::string names;
        for (const Setting& setting : settings)
            if (setting.table == table) names += " " + setting.name;
        std::puts(fmt::format("  [{}]{}", table, names).c_str());
    }
    std::puts("\nDevices");
    try {
        for (const GpuInfo& info : list_gpus())
            std::puts(fmt::format("  {} {} ({}, Vulkan {}, {}; {}{}{})", info.index, info.name, info.type,
                                  info.api_version, info.driver, storage_text(info), info.float64 ? "" : ", no double",
                                  info.int64 ? "" : ", no 64-bit integers")
                          .c_str());
    } catch (const Failure& failure) {
        std::puts(fmt::format("  none: {}", failure.what()).c_str());
    }
    return 0;
}

int show_entry(const CommonOptions& common, const std::string& name, bool json)
{
    const Catalogue               catalogue  = load_catalogue(common.technique_dirs);
    const std::vector<Technique>& techniques = catalogue.techniques;
    const std::vector<Surface>&   surfaces   = catalogue.surfaces;
    const std::vector<Setting>    settings   = all_settings(catalogue);
    const auto                    show       = [&](const auto& entry, const auto& print) {
        if (!json) return print(entry);
        std::puts(json_of(entry).dump(1).c_str());
        return 0;
    };
    if (const auto found = std::ranges::find(techniques, name, &Technique::id); found != techniques.end())
        return show(*found, print_technique);
    if (const auto found = std::ranges::find(surfaces, name, &Surface::id); found != surfaces.end())
        return show(*found, print_surface);
    if (const auto found = std::ranges::find(settings, name, &Setting::name); found != settings.end())
        return show(*found, print_setting);
    const std::vector<Part> parts = parts_of(catalogue);
    if (const auto found = std::ranges::find(parts, name, &Part::id); found != parts.end())
        return show(*found, print_part);
    std::vector<std::string> known;
    for (const Technique& one : techniques) known.push_back(one.id);
    for (const Surface& one : surfaces) known.push_back(one.id);
    for (const Setting& one : settings) known.push_back(one.name);
    for (const Part& one : parts) known.push_back(one.id);
    throw_spec_error("{}", unknown_name("technique, surface model, setting or part", name, known));
}

} // namespace ssrlab
