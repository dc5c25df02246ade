// The loaders behind load_scene(); each turns one kind of file into a Model.
#pragma once

#include "scene/model.h"

#include <filesystem>

namespace ssrlab {

/// glTF 2.0, .glb or .gltf. Throws Failure naming file and JSON path for anything damaged or not supported.
Model load_gltf(const std::filesystem::path& file);
/// Its cameras and their paths alone: reads no triangle and no picture.
Model load_gltf_views(const std::filesystem::path& file);

/// Anything that assimp reads (OBJ, 3DS, PLY, ...): triangles and materials; its lights and cameras are left out.
Model import_model(const std::filesystem::path& file);

/// A recipe; see experiments/scenes/README.md. Throws SpecError with file and line for mistakes in it.
Model load_recipe(const std::filesystem::path& file);

/// Returns the summary of a recipe; empty if it cannot be read.
std::string recipe_summary(const std::filesystem::path& file);

/// The [[view]] tables of a file.
std::vector<Camera> load_views(const std::filesystem::path& file);

/// Returns the folders that are searched for recipes; the first match wins.
std::vector<std::filesystem::path> recipe_folders();

/// Returns the file of a scene's name: a path, or a recipe of these folders. Empty if it is built in or unknown.
std::filesystem::path find_scene_file(const std::string& name);

/// Returns every file that decides how the scene looks, with all that a recipe, glTF, OBJ or MTL names.
std::vector<std::filesystem::path> scene_files(const std::string& name);

/// Whether a scene's name is that of a frame of another renderer (load_frame.h).
bool is_frame(const std::string& name);

/// ".OBJ" is ".obj".
std::string lower_extension(const std::filesystem::path& file);

/// Resolves `reference` of a recipe: a path (relative to `folder`), package:PKG/path or sweethome3d:MODEL.
std::filesystem::path find_data(const std::string& reference, const std::filesystem::path& folder);

} // namespace ssrlab
