// What is done with the bytes of one file: the functions that the program's commands call, with nothing in between.
// A target may throw SpecError or Failure, as the program may; whatever else happens is a finding.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace ssrlab::fuzz {

using Bytes = std::span<const unsigned char>;

void feed_toml(Bytes);                  // any TOML file, as text
void feed_experiment(Bytes);            // ssrlab run FILE.toml --dry-run
void feed_technique_manifest(Bytes);    // technique.toml
void feed_structure_manifest(Bytes);    // structure.toml
void feed_surface_manifest(Bytes);      // surface.toml
void feed_reprojection_manifest(Bytes); // reprojection.toml
void feed_recipe(Bytes);                // a scene's recipe, with the scene that it makes
void feed_views(Bytes);                 // FILE.gltf.views.toml
void feed_frame_convention(Bytes);      // FILE.exr.toml
void feed_frame(Bytes);                 // FILE.exr, a frame of another renderer
void feed_environment_exr(Bytes);       // a recipe's environment
void feed_environment_hdr(Bytes);
void feed_gltf(Bytes);  // .gltf and .glb, with the scene that it makes
void feed_obj(Bytes);   // a recipe's .obj, with the same bytes as its .mtl
void feed_image(Bytes); // a texture: PNG, JPEG, BMP, and TGA for what is none of these

/// A file (below $TMPDIR, or the folder for temporary files) that holds this until the next call with that name.
std::filesystem::path file_with(const std::string& name, Bytes bytes);
std::filesystem::path file_with(const std::string& name, const std::string& text);

} // namespace ssrlab::fuzz
