#include "world/materials.glsl"

#define MASKED_BIT 0x80000000u

// Is the triangle there, at this point of it?
bool passes_mask(uint first_index, uint material, vec2 barycentric)
{
    if ((material & MASKED_BIT) == 0) return true;
    Material masked = materials[material & ~MASKED_BIT];
    vec3 weights = vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    return base_colour_at(masked, TrianglePoint(first_index, weights)).a >= masked.alpha_cutoff;
}
