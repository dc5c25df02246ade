// A surface model is a folder: surface.toml says what it is and what it needs of the G-buffer; meeting.glsl and held.glsl say what a pixel
// holds around its depth sample (shaders/surfaces/README.md).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
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

/// Those of the tree, then those in $SSRLAB_TECHNIQUES; read once per program. Throws SpecError when two share an id.
std::span<const Surface> all_surfaces();

/// The surface model of that id; throws SpecError listing the known ones.
const Surface& find_surface(std::string_view id);

} // namespace ssrlab
