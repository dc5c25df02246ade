// What the manifests of techniques and structures have in common. Folder-internal.
#pragma once

#include "core/toml_reading.h"
#include "trace/parameter.h"

#include <algorithm>
#include <filesystem>
#include <span>

namespace ssrlab {

/// The value of a required key; throws SpecError "PLACE: OWNER has no 'KEY'".
const toml::node& manifest_key(const TomlFile& file, const toml::table& table, const std::string& key,
                               const std::string& owner);
/// Calls read(key, node) in the order of the lines: toml++ does not keep it; its positions do.
template <typename Read> void for_each_in_order(const toml::table& table, const Read& read)
{
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (const auto& [key, node] : table) entries.emplace_back(&key, &node);
    std::ranges::sort(entries, {}, [](const auto& entry) { return entry.first->source().begin; });
    for (const auto& [key, node] : entries) read(*key, *node);
}

/// What an item says of itself: name, summary and, if it has one, cite. `owner`: "the technique" or "the structure".
template <typename Item> void read_about(const TomlFile& file, const std::string& owner, Item& item)
{
    item.name    = toml_text(file, manifest_key(file, file.root, "name", owner), "name");
    item.summary = toml_text(file, manifest_key(file, file.root, "summary", owner), "summary");
    if (const toml::node* node = file.root.get("cite")) item.cite = toml_texts(file, *node, "cite");
}

/// The table [parameters], in the order of its lines; empty without one.
std::vector<Parameter> read_parameters(const TomlFile& file);
/// A list of which every text must be known.
std::vector<std::string> read_known(const TomlFile& file, const toml::node& node, const std::string& key,
                                    const std::string& kind, std::span<const std::string> known);
/// The id of a folder: its name, which shaders use. `kind`: "technique" or "structure".
std::string read_folder_id(const TomlFile& file, const std::filesystem::path& folder, const std::string& kind);

} // namespace ssrlab
