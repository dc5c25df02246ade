#include "harness/experiment.h"

#include "core/size.h"
#include "core/toml_reading.h"
#include "harness/read_sources.h"
#include "harness/search.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Below that after which the device is given up (gpu.cpp).
constexpr double most_time_limit_s = 240;

double number_within(const TomlFile& file, const toml::node& node, const std::string& name, double min, double max)
{
    const double value = toml_number(file, node, name);
    if (!(value >= min && value <= max)) {
        toml_refuse(file, node, name, fmt::format("in [{}, {}]", min, max));
    }
    return value;
}

int64_t integer_within(const TomlFile& file, const toml::node& node, const std::string& name, int64_t min, int64_t max)
{
    const int64_t value = toml_integer(file, node, name);
    if (value < min || value > max) toml_refuse(file, node, name, fmt::format("in [{}, {}]", min, max));
    return value;
}

std::string read_name(const TomlFile& file, const std::filesystem::path& path)
{
    const toml::node* node = file.root.get("name");
    std::string       name = node == nullptr ? path.stem().string() : toml_text(file, *node, "name");
    const auto        safe = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
    // The name becomes a folder below results/.
    if (!std::ranges::all_of(name, safe) || name.front() == '.') {
        throw_spec_error("{}: 'name' must be letters, digits, '_', '-' and '.', got '{}'",
                         node == nullptr ? file.path + ":1" : toml_place(file, *node), name);
    }
    return name;
}

std::vector<std::string> texts_of(const TomlFile& file, const toml::node& node, const std::string& name)
{
    std::vector<std::string> texts;
    for (const toml::node* value : toml_values(file, node, name)) texts.push_back(toml_text(file, *value, name));
    return texts;
}

std::vector<std::string> read_texts(const TomlFile& file, const std::string& name,
                                    const std::vector<std::string>& otherwise)
{
    const toml::node* node = file.root.get(name);
    return node == nullptr ? otherwise : texts_of(file, *node, name);
}

/// A list for all scenes, or a table of lists for scenes that name their own.
void read_views(const TomlFile& file, Experiment& experiment)
{
    const toml::node*  node  = file.root.get("views");
    const toml::table* table = node == nullptr ? nullptr : node->as_table();
    experiment.views = table == nullptr ? read_texts(file, "views", {"default"}) : std::vector<std::string>{"default"};
    experiment.views_place = node == nullptr ? "" : toml_place(file, *node);
    if (table == nullptr) return;
    toml_known_keys(file, *table, "scene of 'views'", experiment.scenes);
    for (const auto& [scene, views] : *table)
        experiment.scene_views[std::string(scene.str())] = texts_of(file, views, std::string(scene.str()));
}

glm::ivec2 read_size(const TomlFile& file, const toml::node& node)
{
    const std::optional<glm::ivec2> size_px = parse_size(toml_text(file, node, "sizes"));
    if (!size_px) toml_refuse(file, node, "sizes", "a size like \"1280x720\"");
    if (std::min(size_px->x, size_px->y) < 1 || std::max(size_px->x, size_px->y) > max_size_px)
        toml_refuse(file, node, "sizes", fmt::format("from 1x1 to {0}x{0} pixels", max_size_px));
    return *size_px;
}

std::vector<glm::ivec2> read_sizes(const TomlFile& file)
{
    const toml::node* node = file.root.get("sizes");
    if (node == nullptr) return {{1280, 720}};
    std::vector<glm::ivec2> sizes_px;
    for (const toml::node* value : toml_values(file, *node, "sizes")) sizes_px.push_back(read_size(file, *value));
    return sizes_px;
}

/// frames = 3 or [0, 5, 9], and jitter_phases of them all.
std::vector<SequenceFrame> read_frames(const TomlFile& file)
{
    int phases = 0;
    if (const toml::node* node = file.root.get("jitter_phases"))
        phases = static_cast<int>(integer_within(file, *node, "jitter_phases", 0, max_jitter_phases));
    const toml::node* node = file.root.get("frames");
    if (node == nullptr) return {{0, phases}};
    std::vector<SequenceFrame> frames;
    if (!node->is_array()) {
        const int64_t count = integer_within(file, *node, "frames", 1, max_frames);
        for (int frame = 0; frame < count; ++frame) frames.push_back({frame, phases});
        return frames;
    }
    for (const toml::node* value : toml_values(file, *node, "frames"))
        frames.push_back({static_cast<int>(integer_within(file, *value, "frames", 0, max_frames)), phases});
    return frames;
}

const toml::table* optional_table(const TomlFile& file, const std::string& name)
{
    const toml::node* node = file.root.get(name);
    return node == nullptr ? nullptr : &toml_table(file, *node, name);
}

double parameter_value(const TomlFile& file, const toml::node& node, const Parameter& parameter)
{
    switch (parameter.type) {
    case ParameterType::choice:
        return parse_parameter(parameter, toml_text(file, node, parameter.name), toml_place(file, node));
    case ParameterType::boolean: return toml_bool(file, node, parameter.name) ? 1 : 0;
    default: break;
    }
    const double value = parameter.type == ParameterType::integer
                             ? static_cast<double>(toml_integer(file, node, parameter.name))
                             : toml_number(file, node, parameter.name);
    check_parameter(parameter, value, toml_place(file, node));
    return value;
}

/// "smallest.factor" also lies in a table of its own: [passes.smallest].
const toml::node* find_setting(const TomlFile& file, const toml::table& table, const std::string& name)
{
    if (const toml::node* quoted = table.get(name)) return quoted;
    const size_t      dot   = name.find('.');
    const toml::node* inner = dot == std::string::npos ? nullptr : table.get(name.substr(0, dot));
    if (inner == nullptr) return nullptr;
    return toml_table(file, *inner, name.substr(0, dot)).get(name.substr(dot + 1));
}

void refuse_unknown_settings(const TomlFile& file, std::span<const Setting> all)
{
    std::map<std::string, std::vector<std::string>> known; // by table, and by table within a table
    for (const Setting& setting : all) {
        known[setting.table].push_back(setting.name);
        const size_t dot = setting.name.find('.');
        if (dot == std::string::npos) continue;
        known[setting.table].push_back(setting.name.substr(0, dot));
        known[setting.table + "." + setting.name.substr(0, dot)].push_back(setting.name.substr(dot + 1));
    }
    for (const auto& [table_name, names] : known)
        if (const toml::node_view<const toml::node> node = file.root.at_path(table_name); node.is_table())
            toml_known_keys(file, *node.as_table(), "setting of [" + table_name + "]", names);
}

ValueLists read_settings(const TomlFile& file, std::span<const Setting> all)
{
    refuse_unknown_settings(file, all);
    ValueLists settings;
    for (const Setting& setting : all) {
        std::vector<double>& values = settings[setting.name];
        const toml::table*   table  = optional_table(file, setting.table);
        const toml::node*    node   = table == nullptr ? nullptr : find_setting(file, *table, setting.name);
        if (node == nullptr) {
            values = {setting.default_value};
            continue;
        }
        for (const toml::node* value : toml_values(file, *node, setting.name)) {
            values.push_back(parameter_value(file, *value, setting));
        }
    }
    return settings;
}

/// A parameter of a structure may be named "structure.parameter" or lie in a table of the structure's name.
bool is_structure(const Technique& technique, const std::string& name)
{
    return std::ranges::find(technique.structures, name, &Structure::id) != technique.structures.end();
}

constexpr const char* sources_key = "sources"; // of a technique's table, beside its parameters and settings

void read_values(const TomlFile& file, const toml::table& table, const std::string& prefix, const Technique& technique,
                 std::span<const Setting> known, TechniqueSweep& sweep)
{
    for (const auto& [key, node] : table) {
        const std::string name = prefix + std::string(key.str());
        if (name == sources_key) continue;
        if (node.is_table() && is_structure(technique, name)) {
            read_values(file, *node.as_table(), name + ".", technique, known, sweep);
            continue;
        }
        const auto setting = std::ranges::find(known, name, &Setting::name);
        if (setting != known.end()) {
            for (const toml::node* value : toml_values(file, node, name)) {
                sweep.settings[name].push_back(parameter_value(file, *value, *setting));
            }
            continue;
        }
        const std::string place     = fmt::format("{}:{}", file.path, key.source().begin.line);
        const Parameter&  parameter = find_parameter(technique, name, place, names_of(known));
        for (const toml::node* value : toml_values(file, node, name)) {
            sweep.values[name].push_back(parameter_value(file, *value, parameter));
        }
    }
}

TechniqueSweep read_sweep(const TomlFile& file, const toml::table& table, const Technique& technique,
                          std::span<const Setting> known, const MeasureSettings& measure)
{
    TechniqueSweep sweep{technique.id, toml_place(file, table), {}, {}, {}};
    if (const toml::node* lists = table.get(sources_key))
        sweep.sources = read_source_lists(file, *lists, sources_key, std::array{HandOn::uncertain}, measure);
    read_values(file, table, "", technique, known, sweep);
    for (const auto& [name, value] : default_values(technique)) sweep.values.try_emplace(name, std::vector{value});
    return sweep;
}

std::vector<TechniqueSweep> read_sweeps(const TomlFile& file, std::span<const Technique> techniques,
                                        std::span<const Setting> known, const MeasureSettings& measure)
{
    const toml::table* table = optional_table(file, "techniques");
    if (table == nullptr || table->empty()) {
        throw_spec_error("{}:1: names no technique: add a table like [techniques.hiz]", file.path);
    }
    std::vector<std::pair<toml::source_position, TechniqueSweep>> found;
    for (const auto& [key, node] : *table) {
        const Technique* technique = nullptr;
        try {
            technique = &find_technique(techniques, std::string(key.str()));
        } catch (const SpecError& error) {
            throw_spec_error("{}:{}: {}", file.path, key.source().begin.line, error.what());
        }
        for (const toml::node* value : toml_values(file, node, "techniques." + technique->id)) {
            const toml::table& one = toml_table(file, *value, "techniques." + technique->id);
            found.emplace_back(one.source().begin, read_sweep(file, one, *technique, known, measure));
        }
    }
    std::ranges::sort(found, [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<TechniqueSweep> sweeps;
    for (auto& [position, sweep] : found) sweeps.push_back(std::move(sweep));
    return sweeps;
}

MeasureSettings read_measure(const TomlFile& file)
{
    MeasureSettings    measure;
    const toml::table* table = optional_table(file, "measure");
    if (table == nullptr) return measure;
    std::vector<std::string> known;
    const auto               with = [&](const std::string& name, const auto& read) {
        known.push_back(name);
        if (const toml::node* node = table->get(name)) read(*node, name);
    };
    const auto integer = [&](const std::string& name, auto& field, int64_t min, int64_t max) {
        using Field = std::remove_reference_t<decltype(field)>;
        with(name, [&, min, max](const toml::node& node, const std::string& key) {
            field = static_cast<Field>(integer_within(file, node, key, min, max));
        });
    };
    const auto number = [&](const std::string& name, double& field, double min, double max) {
        with(name, [&, min, max](const toml::node& node, const std::string& key) {
            field = number_within(file, node, key, min, max);
        });
    };
    const auto flag = [&](const std::string& name, bool& field) {
        with(name, [&](const toml::node& node, const std::string& key) { field = toml_bool(file, node, key); });
    };
    integer("seed", measure.seed, 0, std::numeric_limits<int64_t>::max());
    number("warmup_s", measure.warmup_s, 0, 60);
    integer("min_repeats", measure.min_repeats, 1, 100000);
    integer("max_repeats", measure.max_repeats, 1, 100000);
    integer("frames_per_submit", measure.frames_per_submit, 0, 1000);
    number("budget_s", measure.budget_s, 0, infinity);
    number("time_limit_s", measure.time_limit_s, 0.1, most_time_limit_s);
    flag("truth", measure.truth);
    flag("image_errors", measure.image_errors);
    flag("double_twin", measure.double_twin);
    flag("pictures", measure.pictures);
    flag("saved_time", measure.saved_time);
    toml_known_keys(file, *table, "key of [measure]", known);
    if (measure.max_repeats < measure.min_repeats) {
        throw_spec_error("{}: max_repeats {} is below min_repeats {}", toml_place(file, *table), measure.max_repeats,
                         measure.min_repeats);
    }
    return measure;
}

std::vector<Target> read_targets(const TomlFile& file, const MeasureSettings& measure)
{
    std::vector<Target> targets;
    const toml::table*  table = optional_table(file, "targets");
    if (table == nullptr) return targets;
    std::vector<std::string> known;
    for (const TargetMeasure& one : target_measures()) known.push_back(one.name);
    toml_known_keys(file, *table, "measure of [targets]", known);
    if (!measure.truth)
        throw_spec_error("{}: [targets] are judged by the truths: needs truth = true in [measure], got false",
                         toml_place(file, *table));
    for (const TargetMeasure& one : target_measures()) {
        const toml::node* node = table->get(one.name);
        if (node == nullptr) continue;
        if (one.name == "flip_visible" && !measure.image_errors)
            throw_spec_error("{}: 'flip_visible' needs image_errors = true in [measure], got false",
                             toml_place(file, *node));
        Target target{one.name, {}, one.higher_is_better};
        for (const toml::node* value : toml_values(file, *node, one.name))
            target.values.push_back(number_within(file, *value, one.name, 0, 1));
        targets.push_back(std::move(target));
    }
    return targets;
}

} // namespace

Experiment load_experiment(const std::filesystem::path& path, const Catalogue& catalogue)
{
    static const std::vector<std::string> known = {"name",          "title",   "scenes",  "views",      "sizes",
                                                   "frames",        "trace",   "passes",  "techniques", "sources",
                                                   "jitter_phases", "measure", "targets", "figures"};
    const TomlFile                        file  = read_toml(path);
    toml_known_keys(file, file.root, "key", known);
    Experiment experiment;
    experiment.file  = path;
    experiment.text  = file.text;
    experiment.name  = read_name(file, path);
    experiment.title = experiment.name;
    if (const toml::node* node = file.root.get("title")) experiment.title = toml_text(file, *node, "title");
    experiment.scenes = read_texts(file, "scenes", {});
    if (experiment.scenes.empty())
        throw_spec_error("{}:1: names no scene: add scenes = [\"builtin:stairs\"]", file.path);
    experiment.scenes_place = toml_place(file, *file.root.get("scenes"));
    read_views(file, experiment);
    experiment.sizes_px = read_sizes(file);
    experiment.frames   = read_frames(file);
    for (const char* name : {"sizes", "frames", "jitter_phases"})
        if (const toml::node* node = file.root.get(name)) experiment.places[name] = toml_place(file, *node);
    experiment.known_settings = all_settings(catalogue);
    experiment.known_surfaces = catalogue.surfaces;
    experiment.settings       = read_settings(file, experiment.known_settings);
    for (const Setting& setting : experiment.known_settings)
        if (const toml::table* table = optional_table(file, setting.table))
            if (const toml::node* node = find_setting(file, *table, setting.name))
                experiment.places[setting.name] = toml_place(file, *node);
    experiment.measure    = read_measure(file);
    experiment.techniques = read_sweeps(file, catalogue.techniques, experiment.known_settings, experiment.measure);
    experiment.targets    = read_targets(file, experiment.measure);
    experiment.sources    = read_sources(file, experiment.measure);
    return experiment;
}

} // namespace ssrlab
