// Images to and from disk, by OpenImageIO.
#pragma once

#include "core/image.h"

namespace ssrlab {

/// sRGB-encoded: the first three channels as red, green and blue; a missing one repeats the last.
std::vector<uint8_t> to_srgb8(const Image& image);

/// .exr: float, all channels, linear, metadata as attributes. .png: the first three channels, sRGB-encoded, 8 bit.
/// Written beside and renamed, so that a partial file never carries the final name. Throws Failure with path and reason, SpecError for another ending.
void write_image(const std::filesystem::path& path, const Image& image);

/// Channels are found by name, so their order in the file does not matter. Throws Failure.
Image read_image(const std::filesystem::path& path);

} // namespace ssrlab
