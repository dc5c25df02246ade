#include "scene/toml_table.h"

#include "core/size.h"

#include <cmath>

namespace ssrlab {
namespace {

std::optional<double> to_number(const toml::node& node)
{
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<glm::dvec3> to_vector(const toml::node& node)
{
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != 3) return std::nullopt;
    glm::dvec3 result(0);
    for (int i = 0; i < 3; ++i) {
        const std::optional<double> value = to_number((*array)[static_cast<size_t>(i)]);
        if (!value) return std::nullopt;
        result[i] = *value;
    }
    return result;
}

} // namespace

TomlTable::TomlTable(const TomlFile& file, const toml::table& table, std::string what)
    : file_(&file), table_(&table), what_(std::move(what))
{
}

const toml::node* TomlTable::find(const char* key)
{
    known_.insert(key);
    return table_->get(key);
}

bool TomlTable::has(const char* key) const { return table_->contains(key); }

std::string TomlTable::place() const { return toml_place(*file_, *table_); }

std::string TomlTable::place(const char* key) const
{
    const toml::node* node = table_->get(key);
    return node != nullptr ? toml_place(*file_, *node) : place();
}

void TomlTable::fail(const std::string& message) const { throw_spec_error("{}: {}: {}", place(), what_, message); }

void TomlTable::fail(const char* key, const std::string& message) const
{
    throw_spec_error("{}: {}: '{}' {}", place(key), what_, key, message);
}

void TomlTable::refuse(const char* key, const std::string& expected) const
{
    fail(key, fmt::format("must be {}, got {}", expected, toml_found(*table_->get(key))));
}

std::optional<std::string> TomlTable::text(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_string()) refuse(key, "a text in quotes");
    return node->value<std::string>();
}

std::optional<bool> TomlTable::flag(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_boolean()) refuse(key, "true or false");
    return node->value<bool>();
}

std::optional<double> TomlTable::number(const char* key, double min, double max)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<double> value = to_number(*node);
    if (!value || *value < min || *value > max) refuse(key, fmt::format("a number in [{:g}, {:g}]", min, max));
    return value;
}

std::optional<double> TomlTable::any_number(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_number()) refuse(key, "a number");
    return node->value<double>();
}

std::optional<glm::dvec3> TomlTable::vector(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    std::optional<glm::dvec3> value = to_vector(*node);
    if (!value) refuse(key, "three finite numbers, [x, y, z]");
    return value;
}

std::optional<glm::dvec3> TomlTable::colour(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    std::optional<glm::dvec3> value = to_vector(*node);
    if (const std::optional<double> grey = to_number(*node)) value = glm::dvec3(*grey);
    if (!value || value->x < 0 || value->y < 0 || value->z < 0)
        refuse(key, "three numbers >= 0, [red, green, blue], or one for grey");
    return value;
}

std::vector<glm::dvec3> TomlTable::vectors(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    if (const std::optional<glm::dvec3> value = to_vector(*node)) return {*value};
    std::vector<glm::dvec3> result;
    if (const toml::array* array = node->as_array())
        for (const toml::node& item : *array)
            if (const std::optional<glm::dvec3> value = to_vector(item)) result.push_back(*value);
    if (result.empty() || result.size() != node->as_array()->size())
        refuse(key, "[x, y, z] or a list of such positions");
    return result;
}

std::vector<std::string> TomlTable::texts(const char* key)
{
    const toml::node* node = find(key);
    return node == nullptr ? std::vector<std::string>() : toml_texts(*file_, *node, key);
}

std::optional<glm::ivec2> TomlTable::size_px(const char* key)
{
    const std::optional<std::string> value = text(key);
    if (!value) return std::nullopt;
    std::optional<glm::ivec2> size = parse_size(*value);
    if (!size || size->x < 1 || size->y < 1) refuse(key, "a size in pixels such as \"1280x720\"");
    return size;
}

std::optional<size_t> TomlTable::choice(const char* key, const std::vector<std::string>& names)
{
    const std::optional<std::string> value = text(key);
    if (!value) return std::nullopt;
    const auto name = std::ranges::find(names, *value);
    if (name == names.end())
        fail(key, fmt::format("must be one of {}, got {}{}", fmt::join(names, ", "), toml_found(*table_->get(key)),
                              suggestion(*value, names)));
    return static_cast<size_t>(name - names.begin());
}

std::optional<TomlTable> TomlTable::table(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) refuse(key, "a table, { key = value, ... }");
    return TomlTable(*file_, *node->as_table(), key);
}

std::vector<TomlTable> TomlTable::tables(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    std::vector<TomlTable> result;
    if (const toml::array* array = node->as_array())
        for (const toml::node& item : *array)
            if (item.is_table()) result.emplace_back(*file_, *item.as_table(), fmt::format("[[{}]]", key));
    if (!node->is_array() || result.size() != node->as_array()->size()) refuse(key, fmt::format("tables, [[{}]]", key));
    return result;
}

void TomlTable::refuse_unknown_keys() const
{
    const std::vector<std::string> known(known_.begin(), known_.end());
    toml_known_keys(*file_, *table_, "key of " + what_, known);
}

} // namespace ssrlab
