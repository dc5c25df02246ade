#include "gbuffer/scene_types.glsl"
#include "gbuffer/material.glsl"

layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 vertex_colour;

// Discards the fragment where the material's alpha mask cuts it out.
void discard_cut_out()
{
    Coordinates at       = coordinates_of(uv);
    Material    material = materials[material_index];
    if (is_cut_out(material, base_colour_of(material, at, vertex_colour).a)) discard;
}
