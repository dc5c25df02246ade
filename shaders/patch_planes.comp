// The plane above each patch of 2^PATCH_BITS pixels square: depth is linear on screen where a surface is flat, and no front of the patch lies
// nearer than its plane. Three words: how much nearer it gets each pixel to the right and each pixel down, and its depth at the centre of
// the first pixel.
#include "shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 1, r32f) uniform readonly image2D depth_image;
layout(set = 0, binding = 14, r32f) uniform writeonly imageBuffer PatchPlanes;

const float no_surface = -1e30;

float depth_at(ivec2 pixel)
{
    return imageLoad(depth_image, pixel).x;
}

// How much nearer b is a pixel; nothing where one of the two is no surface.
float slope(float a, float b, int way_px)
{
    return a > 0.0 && b > 0.0 && way_px > 0 ? (b - a) / float(way_px) : 0.0;
}

void main()
{
    ivec2 size_px = imageSize(depth_image), patches = ((size_px - 1) >> PATCH_BITS) + 1, place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, patches))) return;
    ivec2 first = place << PATCH_BITS, way = min(ivec2((1 << PATCH_BITS) - 1), size_px - 1 - first);
    float corner = depth_at(first);
    vec2  gradient = vec2(slope(corner, depth_at(first + ivec2(way.x, 0)), way.x), slope(corner, depth_at(first + ivec2(0, way.y)), way.y));
    float height = no_surface;
    // Down the columns, so that reads of different cache lines are under way at once.
    for (int i = 0; i < 1 << (2 * PATCH_BITS); ++i)
    {
        ivec2 local = min(ivec2(i >> PATCH_BITS, i & ((1 << PATCH_BITS) - 1)), way);
        float depth = depth_at(first + local);
        height      = depth > 0.0 ? max(height, depth - dot(gradient, vec2(local))) : height;
    }
    int word = 3 * (place.y * patches.x + place.x);
    imageStore(PatchPlanes, word, vec4(gradient.x));
    imageStore(PatchPlanes, word + 1, vec4(gradient.y));
    imageStore(PatchPlanes, word + 2, vec4(height));
}
