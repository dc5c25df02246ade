// What the manifests of techniques and structures have in common. Folder-internal.
#pragma once

#include "core/toml_reading.h"
#include "render/parameter.h"

#include <filesystem>
#include <span>

namespace ssrlab {

/// The value of a required key; throws SpecError "PLACE: OWNER has no 'KEY'".
const toml::node& manifest_key(const TomlFile& file, const toml::table& table, const std::string& key,
                               const std::string& owner);
/// The table [parameters], in the order of its lines; empty without one.
std::vector<Parameter> read_parameters(const TomlFile& file);
/// A list of which every text must be known.
std::vector<std::string> read_known(const TomlFile& file, const toml::node& node, const std::string& key,
                                    const std::string& kind, std::span<const std::string> known);
/// The id of a folder: its name, which shaders use. `kind`: "technique" or "structure".
std::string read_folder_id(const TomlFile& file, const std::filesystem::path& folder, const std::string& kind);

} // namespace ssrlab
