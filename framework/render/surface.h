// A surface model is a folder: surface.toml says what it is and what it needs of the G-buffer, meeting.glsl and held.glsl what a pixel holds
// (shaders/surfaces/README.md).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

struct Surface {
    std::string              id; // the folder's name: a value of the setting `surface`
    std::string              name;
    std::string              summary;
    std::vector<std::string> cite;
    bool                     needs_gradient = false; // of the plane of each pixel
    bool                     needs_solid    = false; // where what lies behind a pixel ends
    std::vector<std::string> defines;                // macros that shaders are compiled with
    std::filesystem::path    folder;
};

/// Reads folder/surface.toml; throws SpecError with file and line.
Surface load_surface(const std::filesystem::path& folder);

/// Those of the project, then those in the directories of techniques, as list_techniques() finds them.
std::vector<Surface> list_surfaces(std::span<const std::filesystem::path> extra_dirs);

/// The surface model of that id; throws SpecError listing the known ones.
const Surface& find_surface(std::span<const Surface> surfaces, const std::string& id);

} // namespace ssrlab
