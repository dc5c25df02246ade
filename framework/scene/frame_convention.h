// What the numbers of a frame file mean: FILE.exr.toml beside it, or the attributes that ssrlab writes.
#pragma once

#include "scene/exr_file.h"

#include "core/view.h"

#include <optional>

namespace ssrlab {

enum class DepthKind { reversed, standard, distance, ray_distance };

struct FrameConvention {
    std::string                        place; // the file that says it, for messages
    View                               view;
    bool                               has_axes = false; // the view's directions in the world are known
    std::optional<DepthKind>           depth;
    double                             device_far_m = 0;   // of device depth; infinity: none
    double                             unit_m       = 1;   // of distances in the file
    double                             background_m = 1e6; // a distance from which on nothing is there
    std::optional<double>              background;         // a value of depth where nothing is, in the file's units
    std::string                        normal_space;       // "view", "world" or empty: the channel's name says it
    bool                               unsigned_normals = false; // 0 … 1 stands for -1 … 1
    glm::dvec3                         normal_sign{1};           // per axis, in the space of the file
    std::map<std::string, std::string> channels;                 // quantity -> "CHANNEL" or "FILE:CHANNEL"
    std::map<std::string, double>      values;                   // quantity -> the same for every pixel
    std::filesystem::path              reference;                // a picture of the true reflections, or empty
};

/// Throws SpecError with file and line.
FrameConvention read_convention(const ExrFile& file);

/// Returns the path of the file beside an EXR that says what its numbers mean. It need not exist.
std::filesystem::path convention_file(const std::filesystem::path& exr);

} // namespace ssrlab
