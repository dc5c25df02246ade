// The glTF loader's view of the JSON before the parser sees it. Folder-internal.
#pragma once

#include "scene/gltf.h"

#include <nlohmann/json.hpp>

#include <string_view>

namespace ssrlab::gltf {

/// Returns the array of that name; empty if there is none. Throws Failure unless it holds objects, and not too many.
const nlohmann::json& array_of(const Import& import, const nlohmann::json& object, const char* name);

/// Returns a whole number of an object, `fallback` without the key. Throws Failure for any other value.
uint64_t count_of(const Import& import, const nlohmann::json& object, const char* key, const std::string& where,
                  uint64_t fallback);

/// Stands before the data of every data URI that can be read.
inline constexpr std::string_view base64 = ";base64,";

/// Gives accessors of indices without a buffer view some view while the parser runs, and returns these accessors. Their
/// indices are zeros, some replaced by sparse ones.
std::vector<size_t> give_indices_a_view(const Import& import, nlohmann::json& root);

/// Replaces the media types of data URIs by one that the parser knows (the format is told by the bytes), and escapes
/// what it would read wrongly in others. Returns whether any changed.
bool give_uris_one_form(const Import& import, nlohmann::json& root);

/// Gives buffers the size of their data or file where it is larger than stated. Returns whether any changed. Throws
/// Failure where it is smaller, or the file is missing.
bool give_buffers_their_size(const Import& import, nlohmann::json& root, const std::filesystem::path& folder);

/// Throws SpecError for required extensions that are not supported; warns of others that are used.
void check_extensions(Import& import, const nlohmann::json& root);

/// Throws SpecError where a mesh has no data but a compressed one, naming the extension and the cure.
void check_compressed_meshes(const Import& import, const nlohmann::json& root);

} // namespace ssrlab::gltf
