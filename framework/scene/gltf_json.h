// The glTF loader's view of the JSON before the parser sees it. Folder-internal.
#pragma once

#include "scene/gltf.h"

#include <nlohmann/json.hpp>

#include <string_view>

namespace ssrlab::gltf {

/// The array of that name; empty when there is none. Throws Failure where it is no array of objects, or too long.
const nlohmann::json& array_of(const Import& import, const nlohmann::json& object, const char* name);

/// A whole number of an object; throws Failure where it is none.
uint64_t count_of(const Import& import, const nlohmann::json& object, const char* key, const std::string& where,
                  uint64_t otherwise);

/// Stands before the data of every data URI that can be read.
inline constexpr std::string_view base64 = ";base64,";

/// Indices without a buffer view are zeros, of which a sparse part replaces some. Gives them any view for as long as the parser works,
/// and returns their accessors.
std::vector<size_t> give_indices_a_view(const Import& import, nlohmann::json& root);

/// Replaces the media types of data URIs by one that the parser knows; what the bytes are is told by themselves. Returns whether any
/// changed.
bool give_data_one_type(const Import& import, nlohmann::json& root);

/// Gives buffers the size of their data or file where that is more than they say. Returns whether any changed; throws Failure where
/// it is less, or where there is no such file.
bool give_buffers_their_size(const Import& import, nlohmann::json& root, const std::filesystem::path& folder);

/// Throws SpecError for required extensions that are not supported; warns of others that are used.
void check_extensions(Import& import, const nlohmann::json& root);

/// Throws SpecError where a mesh has no data but a compressed one, naming the extension and the cure.
void check_compressed_meshes(const Import& import, const nlohmann::json& root);

} // namespace ssrlab::gltf
