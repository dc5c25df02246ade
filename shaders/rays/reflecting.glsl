// Which pixels reflect: those with a surface, a usable normal and a material that reflects. After view.glsl.
#include "layout/load_depth.glsl"
#include "layout/frame_shared.h"
#include "layout/normal_image.glsl"
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D material_image;  // rgb = base colour, a = metallic
layout(set = 0, binding = 60, r32f) uniform readonly image2D dielectric_image;  // reflectance at normal incidence of what is not metal

layout(constant_id = CONSTANT_DIELECTRIC_MIN_F0) const float dielectric_min_f0 = 0.0;
layout(constant_id = CONSTANT_DIELECTRIC_MAX_ROUGHNESS) const float dielectric_max_roughness = 0.0;
#include "rays/material_reflects.glsl"

bool is_surface(float depth, vec3 normal)
{
    return depth > 0.0 && any(notEqual(normal, vec3(0))) && !any(isnan(normal)) && !any(isinf(normal));
}

bool has_surface(ivec2 pixel)
{
    return is_surface(load_depth(pixel), imageLoad(normal_image, pixel).xyz);
}

bool material_reflects(ivec2 pixel)
{
    return MATERIAL_REFLECTS(imageLoad(material_image, pixel).a, imageLoad(dielectric_image, pixel).x,
                             imageLoad(normal_image, pixel).w);
}

bool reflects(ivec2 pixel)
{
    return has_surface(pixel) && material_reflects(pixel);
}
