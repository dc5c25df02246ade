// TOML whose mistakes are reported with file and line. Header only: those who include it link toml++.
#pragma once

#include "core/error.h"
#include "core/files.h"
#include "core/names.h"
#include "core/toml_text.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

struct TomlFile {
    std::string path; // as messages show it
    std::string text;
    toml::table root;
};

inline TomlFile parse_toml(const std::string& path, std::string text)
{
    TomlFile file{path, std::move(text), {}};
    check_toml_text(file.path, file.text);
    try {
        file.root = toml::parse(file.text);
    } catch (const toml::parse_error& error) {
        throw_spec_error("{}:{}: {}", file.path, error.source().begin.line, error.description());
    }
    return file;
}

inline TomlFile read_toml(const std::filesystem::path& path)
{
    if (!std::filesystem::exists(path)) throw_spec_error("{}: no such file", short_path(path));
    const std::vector<unsigned char> bytes = read_regular_file(path, 16U << 20U);
    return parse_toml(short_path(path), std::string(bytes.begin(), bytes.end()));
}

/// "experiments/steps.toml:7"
inline std::string toml_place(const TomlFile& file, const toml::node& node)
{
    return fmt::format("{}:{}", file.path, node.source().begin.line);
}

/// Describes a value, for "expected …, got …".
inline std::string toml_found(const toml::node& node)
{
    if (const auto* value = node.as_string()) return fmt::format("the string \"{}\"", value->get());
    if (const auto* value = node.as_integer()) return fmt::format("the integer {}", value->get());
    if (const auto* value = node.as_floating_point())
        return std::isnan(value->get()) ? "nan, which is not a number" : fmt::format("the number {}", value->get());
    if (const auto* value = node.as_boolean()) return fmt::format("{}", value->get());
    if (const auto* list = node.as_array()) return fmt::format("a list of {}", list->size());
    if (node.is_table()) return "a table";
    return "a date or time";
}

[[noreturn]] inline void toml_refuse(const TomlFile& file, const toml::node& node, const std::string& name,
                                     const std::string& expected)
{
    throw_spec_error("{}: '{}' must be {}, got {}", toml_place(file, node), name, expected, toml_found(node));
}

inline void toml_known_keys(const TomlFile& file, const toml::table& table, const std::string& kind,
                            std::span<const std::string> known)
{
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        if (std::ranges::find(known, name) != known.end()) continue;
        throw_spec_error("{}:{}: {}", file.path, key.source().begin.line, unknown_name(kind, name, known));
    }
}

inline std::string toml_text(const TomlFile& file, const toml::node& node, const std::string& name)
{
    const auto* value = node.as_string();
    if (value == nullptr || value->get().empty()) toml_refuse(file, node, name, "a non-empty string");
    return value->get();
}

inline bool toml_bool(const TomlFile& file, const toml::node& node, const std::string& name)
{
    if (!node.is_boolean()) toml_refuse(file, node, name, "true or false");
    return node.as_boolean()->get();
}

/// Integers count as numbers; NaN does not.
inline double toml_number(const TomlFile& file, const toml::node& node, const std::string& name)
{
    const auto* real  = node.as_floating_point();
    const auto* whole = node.as_integer();
    if (whole != nullptr) return static_cast<double>(whole->get());
    if (real == nullptr || std::isnan(real->get())) toml_refuse(file, node, name, "a number");
    return real->get();
}

inline int64_t toml_integer(const TomlFile& file, const toml::node& node, const std::string& name)
{
    if (!node.is_integer()) toml_refuse(file, node, name, "an integer");
    return node.as_integer()->get();
}

/// Returns a value, or all values of a list. An empty list would silently sweep nothing.
inline std::vector<const toml::node*> toml_values(const TomlFile& file, const toml::node& node, const std::string& name)
{
    std::vector<const toml::node*> values;
    if (const toml::array* list = node.as_array()) {
        for (const toml::node& element : *list) values.push_back(&element);
    } else {
        values.push_back(&node);
    }
    if (values.empty()) throw_spec_error("{}: '{}' is an empty list", toml_place(file, node), name);
    return values;
}

inline std::vector<std::string> toml_texts(const TomlFile& file, const toml::node& node, const std::string& name)
{
    if (!node.is_array()) toml_refuse(file, node, name, "a list of strings");
    std::vector<std::string> texts;
    for (const toml::node& element : *node.as_array()) texts.push_back(toml_text(file, element, name));
    return texts;
}

inline const toml::table& toml_table(const TomlFile& file, const toml::node& node, const std::string& name)
{
    if (!node.is_table()) toml_refuse(file, node, name, "a table");
    return *node.as_table();
}

} // namespace ssrlab
