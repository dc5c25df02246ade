// Models as assimp reads them, before any repair.
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

/// Reads a model in a child process: assimp 5.2.5 crashes or hangs on damaged files. Throws Failure with its name.
FileModel read_model_file(const std::filesystem::path& file);

} // namespace ssrlab
