#include "harness/write_experiment.h"

#include "core/toml_reading.h"

#include <sstream>

namespace ssrlab {
namespace {

void insert(toml::table& table, const Parameter& parameter, double value)
{
    switch (parameter.type) {
    case ParameterType::boolean: table.insert(parameter.name, value != 0); return;
    case ParameterType::integer: table.insert(parameter.name, static_cast<int64_t>(value)); return;
    case ParameterType::choice: table.insert(parameter.name, format_parameter(parameter, value)); return;
    default: table.insert(parameter.name, value); return;
    }
}

toml::table changed_values(const Run& run, std::span<const Setting> known, const Technique& technique)
{
    toml::table changed;
    for (const Setting& setting : known)
        if (const double value = setting.get(run.settings); value != setting.default_value)
            insert(changed, setting, value);
    for (const Parameter& parameter : technique.parameters)
        if (const double value = run.values.at(parameter.name); value != parameter.default_value)
            insert(changed, parameter, value);
    return changed;
}

/// Adds a value to a list that has each once.
template <typename Value> void add(toml::array& list, const Value& value)
{
    for (const toml::node& node : list)
        if (node.value<Value>() == value) return;
    list.push_back(value);
}

toml::array& list_in(toml::table& table, const std::string& name)
{
    table.insert(name, toml::array{});
    return *table[name].as_array();
}

} // namespace

std::string experiment_text(const std::string& name, std::span<const Run> pictures, std::span<const Run> settings,
                            std::span<const Setting> known, std::span<const Technique> techniques,
                            const std::string& measure)
{
    toml::table root, views, tables;
    root.insert("name", name);
    for (const Run& picture : pictures) {
        add(list_in(root, "scenes"), picture.scene);
        add(list_in(root, "sizes"), size_text(picture.size_px));
        add(list_in(root, "frames"), int64_t(picture.at.frame));
        add(list_in(views, picture.scene), picture.view);
    }
    for (const Run& run : settings)
        list_in(tables, run.technique).push_back(changed_values(run, known, find_technique(techniques, run.technique)));
    root.insert("views", std::move(views));
    root.insert("techniques", std::move(tables));
    std::ostringstream text;
    text << toml::default_formatter{root, toml::format_flags::none} << "\n";
    return text.str() + (measure.empty() ? "" : "\n[measure]\n" + measure);
}

} // namespace ssrlab
