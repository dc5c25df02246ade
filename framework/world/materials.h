// Materials as shaders read them.
#pragma once

#include "gpu/resources.h"
#include "scene/scene.h"

#include <array>
#include <span>

namespace ssrlab {

inline constexpr uint32_t textures_per_material = 4;

/// Returns base colour, metallic-roughness, normal and emissive.
std::array<const TextureUse*, textures_per_material> texture_uses(const Material& material);

/// Uploads them as shaders/layout/material.glsl reads them.
Buffer upload_materials(Gpu& gpu, std::span<const Material> materials);

} // namespace ssrlab
