#include "scene/toml_table.h"

#include "core/error.h"
#include "scene/image_file.h"

#include <cmath>
#include <cstdio>

namespace ssrlab {
namespace {

std::string place_of(const std::string& file, const toml::node& node)
{
    return fmt::format("{}:{}", file, node.source().begin.line);
}

std::optional<double> to_number(const toml::node& node)
{
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

} // namespace

toml::table parse_toml_file(const std::filesystem::path& file)
{
    const std::vector<unsigned char> bytes = read_regular_file(file, 16U << 20U);
    try {
        return toml::parse(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file.string());
    } catch (const toml::parse_error& error) {
        throw_spec_error("{}:{}: {}", file.string(), error.source().begin.line, error.description());
    }
}

TomlTable::TomlTable(const toml::table& table, std::string file, std::string what)
    : table_(&table), file_(std::move(file)), what_(std::move(what))
{
}

const toml::node* TomlTable::find(const char* key)
{
    known_.insert(key);
    return table_->get(key);
}

bool TomlTable::has(const char* key) const { return table_->contains(key); }

std::string TomlTable::place() const { return place_of(file_, *table_); }

void TomlTable::fail(const std::string& message) const { throw_spec_error("{}: {}: {}", place(), what_, message); }

void TomlTable::fail(const char* key, const std::string& message) const
{
    const toml::node* node = table_->get(key);
    throw_spec_error("{}: {}: '{}' {}", node != nullptr ? place_of(file_, *node) : place(), what_, key, message);
}

std::optional<std::string> TomlTable::text(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_string()) fail(key, "must be a text in quotes");
    return node->value<std::string>();
}

std::optional<bool> TomlTable::flag(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_boolean()) fail(key, "must be true or false");
    return node->value<bool>();
}

std::optional<double> TomlTable::number(const char* key, double min, double max)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<double> value = to_number(*node);
    if (!value || *value < min || *value > max) fail(key, fmt::format("must be a number in [{:g}, {:g}]", min, max));
    return value;
}

std::optional<glm::dvec3> TomlTable::to_vector(const toml::node& node) const
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

std::optional<glm::dvec3> TomlTable::vector(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const std::optional<glm::dvec3> value = to_vector(*node);
    if (!value) fail(key, "must be three finite numbers: [x, y, z]");
    return value;
}

std::optional<glm::dvec3> TomlTable::colour(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    std::optional<glm::dvec3> value = to_vector(*node);
    if (const std::optional<double> grey = to_number(*node)) value = glm::dvec3(*grey);
    if (!value || value->x < 0 || value->y < 0 || value->z < 0)
        fail(key, "must be three numbers >= 0, [red, green, blue], or one for grey");
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
        fail(key, "must be [x, y, z] or a list of such positions");
    return result;
}

std::optional<glm::ivec2> TomlTable::size_px(const char* key)
{
    const std::optional<std::string> value = text(key);
    if (!value) return std::nullopt;
    glm::ivec2 size{0, 0};
    char       rest = 0;
    if (std::sscanf(value->c_str(), "%5dx%5d%c", &size.x, &size.y, &rest) != 2 || size.x < 1 || size.y < 1)
        fail(key, "must be a size in pixels such as \"1280x720\"");
    return size;
}

std::optional<size_t> TomlTable::choice(const char* key, const std::vector<std::string>& names)
{
    const std::optional<std::string> value = text(key);
    if (!value) return std::nullopt;
    std::string list;
    for (size_t i = 0; i < names.size(); ++i) {
        if (*value == names[i]) return i;
        list += (i == 0 ? "" : ", ") + names[i];
    }
    fail(key, fmt::format("is '{}' but must be one of {}", *value, list));
}

std::optional<TomlTable> TomlTable::table(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table()) fail(key, "must be a table: { key = value, ... }");
    return TomlTable(*node->as_table(), file_, key);
}

std::vector<TomlTable> TomlTable::tables(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) return {};
    std::vector<TomlTable> result;
    if (const toml::array* array = node->as_array())
        for (const toml::node& item : *array)
            if (item.is_table()) result.emplace_back(*item.as_table(), file_, fmt::format("[[{}]]", key));
    if (!node->is_array() || result.size() != node->as_array()->size())
        fail(key, fmt::format("must be tables: [[{}]]", key));
    return result;
}

void TomlTable::refuse_unknown_keys() const
{
    for (const auto& [key, node] : *table_) {
        const std::string name(key.str());
        if (known_.contains(name)) continue;
        std::string list;
        for (const std::string& known : known_) list += (list.empty() ? "" : ", ") + known;
        throw_spec_error("{}: {}: unknown key '{}'; accepted are {}", place_of(file_, node), what_, name, list);
    }
}

} // namespace ssrlab
