// Scene data as the G-buffer and shadow passes read it; frame/gpu_scene.cpp fills the same layouts.
struct Material
{
    vec4  base_colour;   // linear
    vec3  emissive;      // linear radiance
    float metallic;
    float roughness;
    float dielectric_f0; // reflectance at normal incidence where it is not metal
    float normal_scale;
    float alpha_cutoff;  // < 0: no alpha mask
    int   double_sided;
    ivec4 uv_set;        // base colour, metallic-roughness, normal, emissive
    mat3  uv_transform[4];
};

layout(push_constant, scalar) uniform Draw
{
    mat4 world_to_clip;
    uint material_index;
    uint object_id;
};
