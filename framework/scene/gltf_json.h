// The glTF loader's view of the JSON before the parser sees it. Folder-internal.
#pragma once

#include "scene/gltf.h"

#include <nlohmann/json.hpp>

namespace ssrlab::gltf {

/// The array of that name; empty when there is none. Throws Failure where it is no array of objects, or too long.
const nlohmann::json& array_of(const Import& import, const nlohmann::json& object, const char* name);

/// Throws Failure for required extensions that are not supported; warns of others that are used.
void check_extensions(Import& import, const nlohmann::json& root);

/// Throws Failure where a mesh has no data but a compressed one, naming the extension and the cure.
void check_compressed_meshes(const Import& import, const nlohmann::json& root);

} // namespace ssrlab::gltf
