// A 3 x 3 filter over what neighbouring pixels reflect: the third pass that J. Somerville Roberts, "Screen Space Reflections",
// recommends against noise. Pixels that do not reflect have no part in it.
#include "layout/numbers.h"
#include "pass/parameters"
#include "rays/tiles.glsl"
#include "passes/mean_reflection.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D reflection_image; // a < 0: reflects nothing
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D filtered_image;

vec4 neighbours[9];
int  count = 0; // of neighbours, the pixel itself included

void read_neighbours(ivec2 pixel)
{
    ivec2 size = imageSize(reflection_image);
    for (int i = 0; i < 9; ++i)
    {
        ivec2 next = pixel + ivec2(i % 3, i / 3) - 1;
        if (all(greaterThanEqual(next, ivec2(0))) && all(lessThan(next, size)))
        {
            vec4 value = imageLoad(reflection_image, next);
            if (value.a >= 0.0) neighbours[count++] = value;
        }
    }
}

// The mean of the pictures: colours count by their weight.
vec4 mean()
{
    vec4 sum = vec4(0);
    for (int i = 0; i < count; ++i) sum += vec4(neighbours[i].rgb * neighbours[i].a, neighbours[i].a);
    return mean_reflection(sum, float(count));
}

float brightness(vec4 value)
{
    return dot(value.rgb, vec3(0.2126, 0.7152, 0.0722)) * value.a;
}

// The neighbour of median brightness, of two the darker one: a reflection that is there, not one made up of three channels.
vec4 median()
{
    vec4 found = vec4(0);
    for (int i = 0; i < count; ++i)
    {
        float own  = brightness(neighbours[i]);
        int   rank = 0;
        for (int k = 0; k < count; ++k)
        {
            float other = brightness(neighbours[k]);
            rank += int(other < own || (other == own && k < i));
        }
        found = rank == (count - 1) / 2 ? neighbours[i] : found;
    }
    return found;
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel)) return;
    if (any(greaterThanEqual(pixel, imageSize(reflection_image)))) return;
    vec4 own = imageLoad(reflection_image, pixel);
    read_neighbours(pixel);
    imageStore(filtered_image, pixel, own.a < 0.0 ? own : filter_3x3 == filter_3x3_box3 ? mean() : median());
}
