// Which pixels reflect: those with a surface, a usable normal and some metal. After view.glsl.
#include "layout/load_depth.glsl"
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D normal_image;   // xyz = view-space normal, w = roughness
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D material_image; // rgb = base colour, a = metallic

bool is_surface(float depth, vec3 normal)
{
    return depth > 0.0 && any(notEqual(normal, vec3(0))) && !any(isnan(normal)) && !any(isinf(normal));
}

bool has_surface(ivec2 pixel)
{
    return is_surface(load_depth(pixel), imageLoad(normal_image, pixel).xyz);
}

bool is_metallic(ivec2 pixel)
{
    return imageLoad(material_image, pixel).a > 0.0;
}

bool reflects(ivec2 pixel)
{
    return has_surface(pixel) && is_metallic(pixel);
}
