#include "render/technique.h"

#include "core/toml_reading.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <set>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> manifest_keys  = {"name",   "summary",    "cite",     "inputs",    "exact",
                                                 "limits", "bounded_by", "accuracy", "parameters"};
const std::vector<std::string> known_inputs   = {"depth_pyramid", "ray_beams", "front_beams"};
const std::vector<std::string> parameter_keys = {"default", "min", "max", "choices", "doc"};

const toml::node& required(const TomlFile& file, const toml::table& table, const std::string& key,
                           const std::string& owner)
{
    const toml::node* node = table.get(key);
    if (node == nullptr) throw_spec_error("{}: {} has no '{}'", toml_place(file, table), owner, key);
    return *node;
}

ParameterType type_of_default(const TomlFile& file, const toml::node& node, bool has_choices, const std::string& name)
{
    if (has_choices) return ParameterType::choice;
    if (node.is_boolean()) return ParameterType::boolean;
    if (node.is_integer()) return ParameterType::integer;
    if (node.is_floating_point()) return ParameterType::real;
    toml_refuse(file, node, "default of " + name, "an integer, a number, a boolean or one of 'choices'");
}

double read_limit(const TomlFile& file, const toml::table& table, const Parameter& parameter, const std::string& key)
{
    const std::string name = key + " of " + parameter.name;
    const toml::node& node = required(file, table, key, "parameter '" + parameter.name + "'");
    if (parameter.type == ParameterType::integer) return static_cast<double>(toml_integer(file, node, name));
    return toml_number(file, node, name);
}

void refuse_limits(const TomlFile& file, const toml::table& table, const Parameter& parameter)
{
    for (const char* key : {"min", "max"}) {
        if (const toml::node* node = table.get(key)) {
            throw_spec_error("{}: '{}' belongs to numbers, and '{}' is none", toml_place(file, *node), key,
                             parameter.name);
        }
    }
}

void read_choices(const TomlFile& file, const toml::table& table, const toml::node& node, Parameter& parameter)
{
    refuse_limits(file, table, parameter);
    const toml::node& list = *table.get("choices");
    parameter.choices      = toml_texts(file, list, "choices of " + parameter.name);
    if (std::set(parameter.choices.begin(), parameter.choices.end()).size() != parameter.choices.size()) {
        throw_spec_error("{}: 'choices' of '{}' names one twice", toml_place(file, list), parameter.name);
    }
    for (const std::string& choice : parameter.choices) {
        // The shader gets each choice as a constant.
        if (!is_glsl_name(parameter.name + "_" + choice)) {
            throw_spec_error("{}: choice '{}' of '{}' must be letters, digits and underscores", toml_place(file, list),
                             choice, parameter.name);
        }
    }
    parameter.max = static_cast<double>(parameter.choices.size()) - 1;
    parameter.default_value =
        parse_parameter(parameter, toml_text(file, node, "default of " + parameter.name), toml_place(file, node));
}

void read_number(const TomlFile& file, const toml::table& table, const toml::node& node, Parameter& parameter)
{
    parameter.min           = read_limit(file, table, parameter, "min");
    parameter.max           = read_limit(file, table, parameter, "max");
    parameter.default_value = toml_number(file, node, "default of " + parameter.name);
    if (parameter.min > parameter.max) {
        throw_spec_error("{}: min {} of '{}' is above its max {}", toml_place(file, table), parameter.min,
                         parameter.name, parameter.max);
    }
    if (parameter.default_value < parameter.min || parameter.default_value > parameter.max) {
        throw_spec_error("{}: default {} of '{}' is outside [{}, {}]", toml_place(file, node), parameter.default_value,
                         parameter.name, parameter.min, parameter.max);
    }
}

Parameter read_parameter(const TomlFile& file, const toml::key& key, const toml::node& node)
{
    Parameter parameter;
    parameter.name = key.str();
    if (!is_glsl_name(parameter.name)) {
        throw_spec_error("{}:{}: parameter '{}' is not a name that GLSL accepts (letters, digits, underscores; no "
                         "keyword)",
                         file.path, key.source().begin.line, parameter.name);
    }
    const toml::table& table = toml_table(file, node, parameter.name);
    toml_known_keys(file, table, "field of parameter '" + parameter.name + "'", parameter_keys);
    const std::string owner        = "parameter '" + parameter.name + "'";
    parameter.doc                  = toml_text(file, required(file, table, "doc", owner), "doc of " + parameter.name);
    const toml::node& default_node = required(file, table, "default", owner);
    parameter.type                 = type_of_default(file, default_node, table.contains("choices"), parameter.name);
    switch (parameter.type) {
    case ParameterType::choice: read_choices(file, table, default_node, parameter); break;
    case ParameterType::boolean:
        refuse_limits(file, table, parameter);
        parameter.max           = 1;
        parameter.default_value = toml_bool(file, default_node, parameter.name) ? 1 : 0;
        break;
    default: read_number(file, table, default_node, parameter);
    }
    return parameter;
}

/// In the order in which the manifest declares them, which toml++ does not keep.
std::vector<Parameter> read_parameters(const TomlFile& file, const toml::table& table)
{
    std::vector<std::pair<toml::source_position, Parameter>> declared;
    for (const auto& [key, node] : table) {
        declared.emplace_back(key.source().begin, read_parameter(file, key, node));
    }
    std::ranges::sort(declared, [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Parameter> parameters;
    for (auto& [position, parameter] : declared) parameters.push_back(std::move(parameter));
    return parameters;
}

void check_bounds(const TomlFile& file, const toml::node& node, const Technique& technique)
{
    for (const std::string& name : technique.bounded_by) {
        if (find_parameter(technique, name, toml_place(file, node)).type != ParameterType::integer) {
            throw_spec_error("{}: 'bounded_by' names '{}', which is not an integer", toml_place(file, node), name);
        }
    }
}

/// accuracy = { parameter = "steps", better = "higher" }, or a list of such tables.
void read_accuracy(const TomlFile& file, const toml::node& node, Technique& technique)
{
    std::vector<const toml::node*> nodes;
    if (const toml::array* list = node.as_array())
        for (const toml::node& one : *list) nodes.push_back(&one);
    else
        nodes.push_back(&node);
    static const std::vector<std::string> keys = {"parameter", "better"};
    for (const toml::node* one : nodes) {
        const toml::table& table = toml_table(file, *one, "accuracy");
        toml_known_keys(file, table, "field of 'accuracy'", keys);
        const toml::node& name   = required(file, table, "parameter", "'accuracy'");
        const toml::node& better = required(file, table, "better", "'accuracy'");
        const Parameter&  parameter =
            find_parameter(technique, toml_text(file, name, "parameter"), toml_place(file, name));
        if (parameter.type != ParameterType::integer && parameter.type != ParameterType::real)
            throw_spec_error("{}: 'accuracy' names '{}', which is not a number", toml_place(file, name),
                             parameter.name);
        const std::string direction = toml_text(file, better, "better");
        if (direction != "higher" && direction != "lower")
            toml_refuse(file, better, "better", "\"higher\" or \"lower\"");
        technique.accuracy.push_back({parameter.name, direction == "higher"});
    }
}

/// A list of which every text must be known.
std::vector<std::string> read_known(const TomlFile& file, const toml::node& node, const std::string& key,
                                    const std::string& kind, std::span<const std::string> known)
{
    std::vector<std::string> names = toml_texts(file, node, key);
    for (const std::string& name : names)
        if (std::ranges::count(known, name) == 0)
            throw_spec_error("{}: {}", toml_place(file, node), unknown_name(kind, name, known));
    return names;
}

void read_limits(const TomlFile& file, const toml::node& node, Technique& technique)
{
    std::vector<std::string> known;
    std::ranges::transform(known_limits(), std::back_inserter(known), &Limit::name);
    technique.limits = read_known(file, node, "limits", "limit", known);
    if (technique.exact && !technique.limits.empty())
        throw_spec_error("{}: 'limits' contradicts 'exact': an exact technique has none", toml_place(file, node));
}

void append_from(std::vector<Technique>& techniques, const fs::path& dir)
{
    if (!fs::is_directory(dir)) throw_spec_error("{}: no such directory of techniques", short_path(dir));
    std::vector<fs::path> folders;
    if (fs::exists(dir / "technique.toml")) {
        folders.push_back(fs::weakly_canonical(dir));
    } else {
        for (const fs::directory_entry& entry : fs::directory_iterator(dir)) {
            const bool complete = fs::exists(entry.path() / "technique.toml");
            if (complete || fs::exists(entry.path() / "trace.glsl")) folders.push_back(entry.path());
        }
        std::ranges::sort(folders);
        if (folders.empty()) throw_spec_error("{}: holds no technique (a folder with technique.toml)", short_path(dir));
    }
    for (const fs::path& folder : folders) {
        Technique  technique = load_technique(folder);
        const auto same      = std::ranges::find(techniques, technique.id, &Technique::id);
        if (same == techniques.end()) {
            techniques.push_back(std::move(technique));
        } else if (!fs::equivalent(same->folder, folder)) {
            throw_spec_error("two techniques are called '{}': {} and {}", technique.id, short_path(same->folder),
                             short_path(folder));
        }
    }
}

} // namespace

std::span<const Limit> known_limits()
{
    static const std::vector<Limit> limits = {
        {"point_sampled", "sees the depth buffer only at its samples: misses what lies between two of them, and may "
                          "report a later surface instead"},
        {"stops_behind_objects", "gives up where it has passed behind an object: misses everything farther along"},
        {"tests_whole_steps",
         "tests a pixel against the ray's depths over a whole step: may hit a surface that the ray "
         "touches only up to one step (t of the hit / its steps) before or behind that pixel"}};
    return limits;
}

Technique load_technique(const fs::path& folder)
{
    const TomlFile file = read_toml(folder / "technique.toml");
    Technique      technique;
    technique.folder = folder;
    technique.id     = fs::weakly_canonical(folder).filename().string();
    if (!is_glsl_name(technique.id)) {
        throw_spec_error(
            "{}:1: the folder's name '{}' is the technique's id and must be letters, digits and underscores", file.path,
            technique.id);
    }
    toml_known_keys(file, file.root, "key", manifest_keys);
    technique.name    = toml_text(file, required(file, file.root, "name", "the technique"), "name");
    technique.summary = toml_text(file, required(file, file.root, "summary", "the technique"), "summary");
    if (const toml::node* node = file.root.get("cite")) technique.cite = toml_texts(file, *node, "cite");
    if (const toml::node* node = file.root.get("inputs"))
        technique.inputs = read_known(file, *node, "inputs", "input", known_inputs);
    if (const toml::node* node = file.root.get("exact")) technique.exact = toml_bool(file, *node, "exact");
    if (const toml::node* node = file.root.get("limits")) read_limits(file, *node, technique);
    if (const toml::node* node = file.root.get("parameters")) {
        technique.parameters = read_parameters(file, toml_table(file, *node, "parameters"));
    }
    if (const toml::node* node = file.root.get("bounded_by")) {
        technique.bounded_by = toml_texts(file, *node, "bounded_by");
        check_bounds(file, *node, technique);
    }
    if (const toml::node* node = file.root.get("accuracy")) read_accuracy(file, *node, technique);
    if (!fs::exists(folder / "trace.glsl")) {
        throw_spec_error("{}: missing; it holds the technique's trace function", short_path(folder / "trace.glsl"));
    }
    return technique;
}

std::vector<Technique> list_techniques(std::span<const fs::path> extra_dirs)
{
    std::vector<Technique> techniques;
    append_from(techniques, fs::path(SSRLAB_SOURCE_DIR) / "techniques");
    const char* variable = std::getenv("SSRLAB_TECHNIQUES");
    std::string dirs     = variable == nullptr ? "" : variable;
    for (size_t start = 0; start < dirs.size();) {
        const size_t end = std::min(dirs.find(':', start), dirs.size());
        if (end > start) append_from(techniques, dirs.substr(start, end - start));
        start = end + 1;
    }
    for (const fs::path& dir : extra_dirs) append_from(techniques, dir);
    return techniques;
}

const Technique& find_technique(std::span<const Technique> techniques, const std::string& id)
{
    const auto found = std::ranges::find(techniques, id, &Technique::id);
    if (found != techniques.end()) return *found;
    std::vector<std::string> known;
    std::ranges::transform(techniques, std::back_inserter(known), &Technique::id);
    throw SpecError(unknown_name("technique", id, known));
}

} // namespace ssrlab
