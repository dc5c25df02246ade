// What a triangle is made of at one point: vertices interpolated, textures at their finest level
// (framework/world/world.cpp fills the buffers).
#include "layout/material.glsl"

struct Vertex
{
    vec3 position_ws;
    vec3 normal_ws;
    vec4 tangent_ws;
    vec2 uv0, uv1;
    vec4 colour;
    vec3 bounced; // radiance of a white diffuse surface
};

struct WorldTexture
{
    ivec2 size_px; // 0: none
    uint  first;
    uint  flags; // wrap u, wrap v: two bits each (0 repeat, 1 mirrored, 2 clamped); nearest; sRGB
};

layout(set = 0, binding = 42, scalar) readonly buffer Vertices { Vertex vertices[]; };
layout(set = 0, binding = 43, scalar) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 44, scalar) readonly buffer Materials { Material materials[]; };
layout(set = 0, binding = 45, scalar) readonly buffer Textures { WorldTexture textures[]; };
layout(set = 0, binding = 46, scalar) readonly buffer Texels { uint texels[]; };

// A point on a triangle, by the first of its three indices.
struct TrianglePoint
{
    uint first_index;
    vec3 weights; // of the three corners
};

Vertex corner_of(TrianglePoint point, int i) { return vertices[indices[point.first_index + i]]; }

vec2 uv_at(TrianglePoint point, int set)
{
    vec2 uv = vec2(0);
    for (int i = 0; i < 3; ++i)
    {
        Vertex corner = corner_of(point, i);
        uv += point.weights[i] * (set == 1 ? corner.uv1 : corner.uv0);
    }
    return uv;
}

int wrapped(int i, int size, uint mode)
{
    if (mode == 2u) return clamp(i, 0, size - 1);
    int period = mode == 0u ? size : 2 * size;
    int inside = (i % period + period) % period;
    return inside < size ? inside : period - 1 - inside;
}

vec3 srgb_to_linear(vec3 value)
{
    return mix(value / 12.92, pow((value + 0.055) / 1.055, vec3(2.4)), greaterThan(value, vec3(0.04045)));
}

vec4 texel_of(WorldTexture image, ivec2 at)
{
    ivec2 inside = ivec2(wrapped(at.x, image.size_px.x, image.flags & 3u),
                         wrapped(at.y, image.size_px.y, image.flags >> 2 & 3u));
    vec4  value  = unpackUnorm4x8(texels[image.first + inside.y * image.size_px.x + inside.x]);
    return (image.flags & 32u) != 0u ? vec4(srgb_to_linear(value.rgb), value.a) : value;
}

// use: 0 base colour, 1 metallic-roughness, 2 normal, 3 emissive. White where there is no texture.
vec4 sample_texture(Material material, int use, TrianglePoint point)
{
    if (material.texture_index[use] < 0) return vec4(1);
    WorldTexture image = textures[material.texture_index[use]];
    if (image.size_px.x == 0) return vec4(1);
    vec2 at_px = (material.uv_transform[use] * vec3(uv_at(point, material.uv_set[use]), 1.0)).xy * vec2(image.size_px);
    if (!all(lessThan(abs(at_px), vec2(1e8)))) return texel_of(image, ivec2(0));
    if ((image.flags & 16u) != 0u) return texel_of(image, ivec2(floor(at_px)));
    vec2  low  = floor(at_px - 0.5);
    vec2  part = at_px - 0.5 - low;
    ivec2 at   = ivec2(low);
    return mix(mix(texel_of(image, at), texel_of(image, at + ivec2(1, 0)), part.x),
               mix(texel_of(image, at + ivec2(0, 1)), texel_of(image, at + ivec2(1, 1)), part.x), part.y);
}

vec4 base_colour_at(Material material, TrianglePoint point)
{
    vec4 colour = vec4(0);
    for (int i = 0; i < 3; ++i) colour += point.weights[i] * corner_of(point, i).colour;
    return material.base_colour * colour * sample_texture(material, 0, point);
}
