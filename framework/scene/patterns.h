// Procedural textures of base colour and gloss that repeat without a seam.
#pragma once

#include "scene/scene.h"

namespace ssrlab {

enum class Pattern : unsigned {
    wet_asphalt, // dark grain of roughness 0.5 to 0.85, and puddles of roughness 0.02 over two fifths of it
    marble,      // slabs, two by two to a repeat, light and dark by turns, with veins; roughness 0.05, joints 0.6
    oak,         // planks along u, two by twelve to a repeat, varnished: roughness 0.12 to 0.24
    brick,       // four by twelve to a repeat, staggered; roughness 0.9
    concrete,    // polished: roughness 0.08 to 0.3
};

/// Green of `gloss` is roughness, blue is metallic (0).
struct PatternTextures {
    Texture base_colour, gloss;
};
PatternTextures make_pattern(Pattern pattern);

} // namespace ssrlab
