// What every pass that draws the scene is given; frame/gpu_scene.h has the same push constants.
#include "layout/material.glsl"

layout(push_constant, scalar) uniform Draw
{
    mat4 world_to_clip;
    uint material_index;
    uint object_id;
};
