// A surface model is a folder: surface.toml says what it needs of the G-buffer, meeting.glsl and held.glsl what a pixel
// holds around its depth sample (shaders/surfaces/README.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct Surface {
    std::string              id; // the folder's name: a value of the setting `surface`
    std::string              name;
    std::string              summary;
    std::vector<std::string> cite;
    bool                     needs_gradient = false; // the slope of each pixel's plane
    bool                     needs_solid    = false; // where the solid behind each pixel ends
    std::vector<std::string> defines;                // macros that shaders are compiled with
    std::filesystem::path    folder;                 // of the manifest
    std::filesystem::path    shaders;                // of the GLSL files
};

/// Reads folder/surface.toml; throws SpecError with file and line.
Surface load_surface(const std::filesystem::path& folder);

} // namespace ssrlab
