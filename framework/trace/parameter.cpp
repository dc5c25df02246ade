#include "core/names.h"
#include "trace/manifest.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace ssrlab {
namespace {

/// A function: manifests are read before all constants of other files are there.
const std::vector<std::string>& parameter_keys()
{
    static const std::vector<std::string> keys = {"default", "min", "max", "choices", "defines", "doc"};
    return keys;
}

std::string expectation(const Parameter& parameter)
{
    switch (parameter.type) {
    case ParameterType::boolean: return "true or false";
    case ParameterType::choice: return fmt::format("one of {}", fmt::join(parameter.choices, ", "));
    case ParameterType::integer: return fmt::format("an integer in [{}, {}]", parameter.min, parameter.max);
    case ParameterType::real: break;
    }
    return fmt::format("a number in [{}, {}]", parameter.min, parameter.max);
}

[[noreturn]] void refuse_value(const Parameter& parameter, const std::string& text, const std::string& place)
{
    throw_spec_error("{}: '{}' must be {}, got {}", place, parameter.name, expectation(parameter), text);
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
    const toml::node& node = manifest_key(file, table, key, "parameter '" + parameter.name + "'");
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
        if (const std::string fault = glsl_name_fault(parameter.name + "_" + choice); !fault.empty())
            throw_spec_error("{}: choice '{}' of '{}' cannot be part of a name: {}", toml_place(file, list), choice,
                             parameter.name, fault);
    }
    parameter.max = static_cast<double>(parameter.choices.size()) - 1;
    parameter.default_value =
        parse_parameter(parameter, toml_text(file, node, "default of " + parameter.name), toml_place(file, node));
}

/// Choices that compile the shader differently: CHOICE = "MACRO".
void read_defines(const TomlFile& file, const toml::table& table, Parameter& parameter)
{
    const toml::node* node = table.get("defines");
    if (node == nullptr) return;
    if (parameter.type != ParameterType::choice)
        throw_spec_error("{}: 'defines' belongs to choices, and '{}' has none", toml_place(file, *node),
                         parameter.name);
    const toml::table& defines = toml_table(file, *node, "defines of " + parameter.name);
    toml_known_keys(file, defines, "choice of '" + parameter.name + "'", parameter.choices);
    for (const auto& [choice, macro] : defines)
        parameter.defines[std::string(choice.str())] = toml_text(file, macro, "macro of " + std::string(choice.str()));
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
    if (const std::string fault = glsl_name_fault(parameter.name); !fault.empty())
        throw_spec_error("{}:{}: parameter '{}' is not a name that GLSL accepts: {}", file.path,
                         key.source().begin.line, parameter.name, fault);
    const toml::table& table = toml_table(file, node, parameter.name);
    toml_known_keys(file, table, "field of parameter '" + parameter.name + "'", parameter_keys());
    const std::string owner = "parameter '" + parameter.name + "'";
    parameter.doc           = toml_text(file, manifest_key(file, table, "doc", owner), "doc of " + parameter.name);
    const toml::node& default_node = manifest_key(file, table, "default", owner);
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
    read_defines(file, table, parameter);
    return parameter;
}

} // namespace

const toml::node& manifest_key(const TomlFile& file, const toml::table& table, const std::string& key,
                               const std::string& owner)
{
    const toml::node* node = table.get(key);
    if (node == nullptr) throw_spec_error("{}: {} has no '{}'", toml_place(file, table), owner, key);
    return *node;
}

std::vector<Parameter> read_parameters(const TomlFile& file)
{
    const toml::node* parameters_node = file.root.get("parameters");
    if (parameters_node == nullptr) return {};
    std::vector<Parameter> parameters;
    for_each_in_order(
        toml_table(file, *parameters_node, "parameters"),
        [&](const toml::key& key, const toml::node& node) { parameters.push_back(read_parameter(file, key, node)); });
    return parameters;
}

double parse_parameter(const Parameter& parameter, const std::string& text, const std::string& place)
{
    double value = 0;
    if (parameter.type == ParameterType::choice) {
        const auto choice = std::ranges::find(parameter.choices, text);
        if (choice == parameter.choices.end())
            refuse_value(parameter, "'" + text + "'" + suggestion(text, parameter.choices), place);
        return static_cast<double>(choice - parameter.choices.begin());
    }
    if (parameter.type == ParameterType::boolean) {
        if (text != "true" && text != "false") refuse_value(parameter, "'" + text + "'", place);
        return text == "true" ? 1 : 0;
    }
    const char* end    = text.data() + text.size();
    const auto  parsed = std::from_chars(text.data(), end, value);
    if (parsed.ec != std::errc() || parsed.ptr != end) refuse_value(parameter, "'" + text + "'", place);
    check_parameter(parameter, value, place);
    return value;
}

void check_parameter(const Parameter& parameter, double value, const std::string& place)
{
    const bool whole = parameter.type == ParameterType::real || value == std::floor(value);
    // Written so that NaN fails.
    if (!(value >= parameter.min && value <= parameter.max && whole)) {
        refuse_value(parameter, fmt::format("{}", value), place);
    }
}

std::string format_parameter(const Parameter& parameter, double value)
{
    switch (parameter.type) {
    case ParameterType::boolean: return value != 0 ? "true" : "false";
    case ParameterType::choice: return parameter.choices.at(static_cast<size_t>(value));
    default: return fmt::format("{}", value);
    }
}

std::vector<std::string> read_known(const TomlFile& file, const toml::node& node, const std::string& key,
                                    const std::string& kind, std::span<const std::string> known)
{
    std::vector<std::string> names = toml_texts(file, node, key);
    for (const std::string& name : names)
        if (std::ranges::count(known, name) == 0)
            throw_spec_error("{}: {}", toml_place(file, node), unknown_name(kind, name, known));
    return names;
}

std::string read_folder_id(const TomlFile& file, const std::filesystem::path& folder, const std::string& kind)
{
    std::string id = std::filesystem::weakly_canonical(folder).filename().string();
    if (const std::string fault = glsl_name_fault(id); !fault.empty())
        throw_spec_error("{}:1: the folder's name '{}' cannot be the {}'s id: {}", file.path, id, kind, fault);
    return id;
}

} // namespace ssrlab
