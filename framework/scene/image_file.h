// Textures from encoded images.
#pragma once

#include "scene/scene.h"

#include <span>
#include <string>

namespace ssrlab {

/// Decodes PNG, JPEG or what else OpenImageIO reads, to 8-bit RGBA with row 0 on top. `name` is for messages only.
/// Throws Failure when it cannot be decoded, SpecError when it is larger than 16384 pixels a side.
Texture decode_image(std::span<const unsigned char> bytes, const std::string& name);

/// Mean of the alpha channel, 0..1.
float mean_alpha(const Texture& texture);

} // namespace ssrlab
