// The plane of a pixel as the gradient of its depth: the change of depth from one pixel to the next along x and y.
// Depth is linear on screen where a surface is flat, so the gradient describes the plane exactly.
#pragma once

#include "core/gbuffer_image.h"

namespace ssrlab {

/// Packs both components with 8 significant bits each, rounded to nearest, into the upper and lower half of a word; a
/// value that is not finite becomes NaN. shaders/surfaces/plane/stored.glsl unpacks it.
uint32_t  pack_gradient(glm::vec2 gradient);
glm::vec2 unpack_gradient(uint32_t packed);

/// Derives missing gradients from the normals (docs/reference/hit_contract.md), rounded as pack_gradient() rounds; NaN
/// where a normal is unusable. A G-buffer that has gradients stays as it is.
void complete_gradients(GBufferImage& image);

} // namespace ssrlab
