// Reading of manifests: what all kinds of folders have in common. Folder-internal.
#pragma once

#include "core/toml_reading.h"
#include "trace/parameter.h"

#include <algorithm>
#include <filesystem>
#include <span>

namespace ssrlab {

/// Returns the value of a required key; throws SpecError "PLACE: OWNER has no 'KEY'".
const toml::node& manifest_key(const TomlFile& file, const toml::table& table, const std::string& key,
                               const std::string& owner);
/// Calls read(key, node) in the order of the file's lines, which toml++ does not keep.
template <typename Read> void for_each_in_order(const toml::table& table, const Read& read)
{
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
    std::ranges::sort(entries, {}, [](const auto& entry) { return entry.first->source().begin; });
    for (const auto& [key, node] : entries) read(*key, *node);
}

/// Reads name, summary and, if present, cite. `owner`: "the technique", "the structure" …
template <typename Item> void read_about(const TomlFile& file, const std::string& owner, Item& item)
{
    item.name    = toml_text(file, manifest_key(file, file.root, "name", owner), "name");
    item.summary = toml_text(file, manifest_key(file, file.root, "summary", owner), "summary");
    if (const toml::node* node = file.root.get("cite")) item.cite = toml_texts(file, *node, "cite");
}

/// Returns the table [parameters] in the order of its lines; empty if there is none.
std::vector<Parameter> read_parameters(const TomlFile& file);
/// Returns a list of texts; throws SpecError if one of them is not in `known`.
std::vector<std::string> read_known(const TomlFile& file, const toml::node& node, const std::string& key,
                                    const std::string& kind, std::span<const std::string> known);
/// Returns the folder's name, its id; throws SpecError if shaders cannot use it as a name. `kind`: "technique" …
std::string read_folder_id(const TomlFile& file, const std::filesystem::path& folder, const std::string& kind);

} // namespace ssrlab
