// Which channel of an EXR holds what: names as Blender, Unreal, Unity and glTF viewers write them.
#pragma once

#include "scene/exr_file.h"

#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// One number per pixel that a frame has. docs/reference/frame_files.md lists the names that are recognised.
inline constexpr const char* frame_quantities[] = {
    "depth",       "normal.x",   "normal.y",   "normal.z",      "roughness",     "smoothness",    "metallic",
    "specular.R",  "specular.G", "specular.B", "base_colour.R", "base_colour.G", "base_colour.B", "lit.R",
    "lit.G",       "lit.B",      "radiance.R", "radiance.G",    "radiance.B",    "highlight.R",   "highlight.G",
    "highlight.B", "object_id",  "gradient.x", "gradient.y",    "solid_back",    "dielectric_f0"};

/// All channels whose name says that they hold the quantity; those of one layer that could be it in several ways come once.
std::vector<ExrChannel> find_quantity(std::span<const ExrChannel> channels, const std::string& quantity);

/// What a normal channel's name says: "world", "view", or nothing.
std::string normal_space_of(const std::string& channel);

} // namespace ssrlab
