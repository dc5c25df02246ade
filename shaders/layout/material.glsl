// A material of the scene, as framework/world/materials.cpp fills it.
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
    ivec4 texture_index; // base colour, metallic-roughness, normal, emissive; -1: none
    ivec4 uv_set;
    mat3  uv_transform[4];
};
