// The plane that a pixel is a piece of, as the gradient of its depth: how much depth changes from one pixel to the next along x and y. Depth is linear on
// screen where a surface is flat, so a gradient describes its plane exactly.
#pragma once

#include "core/gbuffer_image.h"

namespace ssrlab {

/// Both components with 8 significant bits, rounded to nearest, in the upper and lower half of a word; not finite: NaN. shaders/surfaces/plane/stored.glsl
/// unpacks it.
uint32_t  pack_gradient(glm::vec2 gradient);
glm::vec2 unpack_gradient(uint32_t packed);

/// Gives a G-buffer without gradients those of its normals (docs/reference/hit_contract.md), as pack_gradient() keeps them; NaN where a normal is not usable. One that
/// has gradients stays as it is.
void complete_gradients(GBufferImage& image);

} // namespace ssrlab
