// Images to and from disk, by OpenImageIO.
#pragma once

#include "core/image.h"

namespace ssrlab {

/// Encodes the first three channels as sRGB red, green and blue; a missing one repeats the last.
std::vector<uint8_t> to_srgb8(const Image& image);

/// Writes .exr (float, all channels, linear, metadata as attributes) or .png (first three channels, sRGB, 8 bit), first
/// under a temporary name. Throws Failure with path and reason, SpecError for another extension.
void write_image(const std::filesystem::path& path, const Image& image);

/// Reads an image. The order of its channels is arbitrary: find them by name. Throws Failure.
Image read_image(const std::filesystem::path& path);

} // namespace ssrlab
