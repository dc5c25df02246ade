#include "harness/resolve_figures.h"

#include "core/files.h"
#include "core/toml_reading.h"
#include "harness/columns.h"
#include "harness/measured_run.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace ssrlab {
namespace {

using json = nlohmann::ordered_json;

struct Figures {
    const TomlFile&          file;
    const Experiment&        experiment;
    std::vector<std::string> told_apart_by; // columns
    std::vector<std::string> measures;      // columns
    std::vector<Record>      runs;          // what each row will have in the former
};

const toml::node& needed(const TomlFile& file, const toml::table& figure, const std::string& name,
                         const std::string& key)
{
    const toml::node* node = figure.get(key);
    if (node == nullptr) throw_spec_error("{}: [figures.{}] has no '{}'", toml_place(file, figure), name, key);
    return *node;
}

bool holds(const Record& run, const std::string& column, const toml::node& node)
{
    if (const auto* flag = node.as_boolean()) return words_of(run, column) == (flag->get() ? "true" : "false");
    if (const auto* words = node.as_string()) return words_of(run, column) == words->get();
    const auto number = number_of(run, column);
    const auto wanted = node.value<double>();
    return number && wanted &&
           (*number == *wanted || std::abs(*number - *wanted) <= 1e-6 * std::max(1.0, std::abs(*wanted)));
}

/// Columns in which the runs differ, with what a reader may write.
std::string differences(std::span<const Record* const> runs, std::span<const std::string> columns)
{
    std::vector<std::string> names;
    for (const std::string& column : columns) {
        const auto value = [&](const Record* run) { return run->contains(column) ? run->at(column) : Value(); };
        if (column != "run_id" && column != "run_number" &&
            std::ranges::any_of(runs, [&](const Record* run) { return value(run) != value(runs.front()); }))
            names.push_back(column);
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

void check_shown(const Figures& figures, const toml::node& node)
{
    static const std::vector<std::string> known = {"off", "truth", "agreement", "causes", "flip", "fetches"};
    const std::string                     shown = toml_text(figures.file, node, "show");
    const std::string                     place = toml_place(figures.file, node);
    if (std::ranges::find(known, shown) == known.end())
        throw_spec_error("{}: {}", place, unknown_name("'show'", shown, known));
    const MeasureSettings& measure = figures.experiment.measure;
    if (!measure.truth && shown != "fetches")
        throw_spec_error("{}: show = \"{}\" needs truth = true in [measure], got false", place, shown);
    if (!measure.image_errors && shown == "flip")
        throw_spec_error("{}: show = \"flip\" needs image_errors = true in [measure], got false", place);
}

/// The run that a panel names.
const Record& run_of(const Figures& figures, const toml::table& panel)
{
    std::vector<const Record*> left;
    for (const Record& run : figures.runs) left.push_back(&run);
    for (const auto& [key, node] : panel) {
        const std::string column(key.str());
        if (column == "show") {
            check_shown(figures, node);
            continue;
        }
        std::vector<std::string> known = figures.told_apart_by;
        known.emplace_back("show");
        if (std::ranges::find(known, column) == known.end())
            throw_spec_error("{}: {}", toml_place(figures.file, node),
                             unknown_name("column of results.csv", column, known));
        if (!node.is_value()) toml_refuse(figures.file, node, column, "one value");
        std::erase_if(left, [&, &wanted = node](const Record* run) { return !holds(*run, column, wanted); });
        if (left.empty())
            throw_spec_error("{}: a panel must name one run, and none has '{}' as {}, with the panel's other values",
                             toml_place(figures.file, node), column, toml_found(node));
    }
    if (left.size() > 1)
        throw_spec_error("{}: a panel must name one run, this names {}, which differ in {}",
                         toml_place(figures.file, panel), left.size(), differences(left, figures.told_apart_by));
    return *left.front();
}

/// [x, y, width, height] within a picture.
std::array<int64_t, 4> read_crop(const TomlFile& file, const toml::node& node, glm::ivec2 size_px)
{
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != 4) toml_refuse(file, node, "crop", "[x, y, width, height] in pixels");
    std::array<int64_t, 4> crop{};
    for (size_t i = 0; i < crop.size(); ++i) crop[i] = toml_integer(file, *list->get(i), "crop");
    const auto [x, y, width, height] = crop;
    if (x < 0 || y < 0 || width < 1 || height < 1 || x > size_px.x - width || y > size_px.y - height)
        throw_spec_error("{}: crop [{}] leaves the picture of {}", toml_place(file, node), fmt::join(crop, ", "),
                         size_text(size_px));
    return crop;
}

json resolve_panel(const toml::table& panel, const Record& run)
{
    json resolved = {{"run_id", words_of(run, "run_id")}};
    for (const auto& [key, node] : panel) {
        json& value = resolved[std::string(key.str())];
        if (const auto* flag = node.as_boolean())
            value = flag->get();
        else if (const auto* whole = node.as_integer())
            value = whole->get();
        else if (const auto* number = node.as_floating_point(); number != nullptr && std::isfinite(number->get()))
            value = number->get();
        else
            value = number != nullptr ? "inf" : node.value_or(std::string());
    }
    return resolved;
}

json resolve_figure(const Figures& figures, const std::string& name, const toml::table& figure)
{
    static const std::vector<std::string> known = {"says", "measures", "crop", "panels"};
    const TomlFile&                       file  = figures.file;
    toml_known_keys(file, figure, "key of [figures." + name + "]", known);
    json resolved = {{"says", toml_text(file, needed(file, figure, name, "says"), "says")},
                     {"measures", json::array()},
                     {"panels", json::array()}};
    if (const toml::node* node = figure.get("measures"))
        for (const toml::node* value : toml_values(file, *node, "measures")) {
            const std::string measure = toml_text(file, *value, "measures");
            if (std::ranges::find(figures.measures, measure) == figures.measures.end())
                throw_spec_error("{}: {}", toml_place(file, *value),
                                 unknown_name("measure", measure, figures.measures));
            resolved["measures"].push_back(measure);
        }
    for (const toml::node* node : toml_values(file, needed(file, figure, name, "panels"), "panels")) {
        const toml::table& panel = toml_table(file, *node, "panels");
        const Record&      run   = run_of(figures, panel);
        if (const toml::node* crop = figure.get("crop"))
            resolved["crop"] =
                read_crop(file, *crop, {number_of(run, "width").value(), number_of(run, "height").value()});
        resolved["panels"].push_back(resolve_panel(panel, run));
    }
    return resolved;
}

} // namespace

std::string resolve_figures(const Experiment& experiment, std::span<const Technique> techniques,
                            std::span<const Run> runs)
{
    const TomlFile    file = parse_toml(short_path(experiment.file), experiment.text);
    const toml::node* node = file.root.get("figures");
    if (node == nullptr) return "";
    const toml::table& tables = toml_table(file, *node, "figures");
    if (!experiment.measure.pictures)
        throw_spec_error("{}: [figures] show pictures: needs pictures = true in [measure], got false",
                         toml_place(file, *node));
    if (!experiment.targets.empty())
        throw_spec_error("{}: [figures] name runs before they are made: not with [targets], whose search chooses them",
                         toml_place(file, *node));
    Figures figures{file, experiment, names_of(setting_columns(experiment, techniques)), {}, {}};
    for (const Column& column : result_columns(experiment, techniques))
        if (column.type == ColumnType::measure) figures.measures.push_back(column.name);
    for (const Run& run : runs)
        figures.runs.push_back(identity_row(experiment, run, find_technique(techniques, run.technique)));
    json resolved;
    for (const auto& [key, figure] : tables) {
        const std::string name(key.str());
        resolved[name] = resolve_figure(figures, name, toml_table(file, figure, "figures." + name));
    }
    return resolved.dump();
}

} // namespace ssrlab
