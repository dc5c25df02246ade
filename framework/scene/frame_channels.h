// Recognises channels of an EXR by the names that Blender, Unreal, Unity and glTF viewers write.
#pragma once

#include "scene/exr_file.h"

#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// One number per pixel of a frame. docs/reference/frame_files.md lists the recognised names.
inline constexpr const char* frame_quantities[] = {
    "depth",       "normal.x",      "normal.y",     "normal.z",      "roughness",     "smoothness",    "metallic",
    "specular.R",  "specular.G",    "specular.B",   "base_colour.R", "base_colour.G", "base_colour.B", "lit.R",
    "lit.G",       "lit.B",         "radiance.R",   "radiance.G",    "radiance.B",    "highlight.R",   "highlight.G",
    "highlight.B", "emission.R",    "emission.G",   "emission.B",    "object_id",     "gradient.x",    "gradient.y",
    "solid_back",  "dielectric_f0", "diffuse_share"};

/// Returns all channels whose name says that they hold the quantity, without duplicates within a layer.
std::vector<ExrChannel> find_quantity(std::span<const ExrChannel> channels, const std::string& quantity);

/// Returns the space that a normal channel's name states: "world", "view", or empty.
std::string normal_space_of(const std::string& channel);

} // namespace ssrlab
