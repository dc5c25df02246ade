// The nearest surface behind the one that the G-buffer shows: its depth where it shows its back, so that what lies between the two is solid; else 0.
#include "gbuffer/scene_types.glsl"
#include "gbuffer/material.glsl"
#define DEPTH_BINDING 5
layout(set = 0, binding = 0, scalar) uniform Frame // as gbuffer.frag declares it
{
    mat4  world_to_view;
    vec3  eye_ws;
    int   orthographic;
    vec3  view_axis_ws;
    int   light_count;
    vec3  ambient;
    float layer_separation;
    ivec2 size_px;
};
#include "layout/load_depth.glsl"

layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 vertex_colour;
layout(location = 0) out float solid_back;

// Of depth: what lies nearer behind the first surface is the same surface.
const float same_surface = 1.0 / 65536.0;

void main()
{
    Coordinates at       = coordinates_of(uv);
    Material    material = materials[material_index];
    if (is_cut_out(material, base_colour_of(material, at, vertex_colour).a)) discard;
    float first = load_depth(ivec2(gl_FragCoord.xy));
    if (gl_FragCoord.z >= first - first * same_surface) discard;
    solid_back = gl_FrontFacing ? 0.0 : gl_FragCoord.z;
}
