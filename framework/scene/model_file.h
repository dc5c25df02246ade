// What assimp makes of a model's file, before anything is repaired.
#pragma once

#include "scene/model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct FileMaterial {
    std::string name, texture; // as the file names it; empty: none
    glm::vec3   diffuse{0.8F}, specular{0}, emissive{0};
    float       exponent = 0, opacity = 1;
};

struct FileModel {
    std::vector<FileMaterial> materials;
    std::vector<Mesh>         meshes; // in the file's order, placed; normals and texture coordinates as they are there
};

/// Reads it in a process of its own: assimp 5.2.5 crashes on damaged files, or never ends. Throws Failure with the file's name.
FileModel read_model_file(const std::filesystem::path& file);

} // namespace ssrlab
