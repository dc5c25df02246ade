// Models as assimp reads them, before any repair.
#pragma once

#include "scene/model.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct FileMaterial {
    std::string name, texture; // as the file names it; empty: none
    std::string other_maps;    // what else it has pictures of, "opacity, bump"; empty: nothing
    glm::vec3   diffuse{0.8F}, specular{0}, emissive{0};
    float       exponent = 0, opacity = 1;
    float       metallic = -1, roughness = -1; // < 0: the file does not say
    bool        is_default = false;            // assimp's own, of meshes without a material
};

struct FileMesh : Mesh {
    bool has_colours = false; // of vertices
};

struct FileModel {
    std::vector<FileMaterial> materials;
    std::vector<FileMesh>     meshes; // in the file's order, placed; normals and texture coordinates as they are there
    std::vector<std::string>  warnings; // of what assimp skips without a word
};

/// Reads a model in a child process: assimp 5.2.5 crashes or hangs on damaged files. Throws Failure with its name.
FileModel read_model_file(const std::filesystem::path& file);

} // namespace ssrlab
