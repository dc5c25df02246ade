// One direction of a separable Gaussian over the reflection, its radius from the reflector's roughness. B. Wronski 2014, GDC
// follow-up: Screenspace reflections filtering and up-sampling: holes weigh less, and look farther for what they lack (push-pull).
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/blocks.glsl"
#include "rays/tiles.glsl"
#include "layout/frame_shared.h"
#include "passes/mean_reflection.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#ifdef ALONG_X
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D reflection_image;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D filtered_image;
#define SOURCE reflection_image
#define TARGET filtered_image
const ivec2 axis = ivec2(1, 0);
#else
layout(set = 0, binding = 4, rgba16f) uniform readonly image2D filtered_image;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D reflection_image;
#define SOURCE filtered_image
#define TARGET reflection_image
const ivec2 axis = ivec2(0, 1);
#endif

#ifdef BLOCKS
// At the resolution of the rays: a step is a block, and only the pixels that were traced are read and written.
layout(set = 0, binding = 6, r32ui) uniform readonly uimage2D block_pixel_image;
const int step_px = block_px;
#else
const int step_px = 1;
#endif

const int taps_a_side = 64;

// In steps.
float blur_radius(ivec2 pixel, bool hole)
{
    float roughness = imageLoad(normal_image, pixel).w;
    return max(0.0, blur_bias + blur_scale * roughness) * float(size_px.y) / float(step_px) * (hole ? hole_blur_scale : 1.0);
}

struct Sum
{
    vec3  colour;
    float weight, trusted;
};

vec4 reflection_at(ivec2 place)
{
#ifdef BLOCKS
    uint traced = imageLoad(block_pixel_image, clamp(place, ivec2(0), (size_px - 1) / block_px)).x;
    return traced == NO_PIXEL ? vec4(0, 0, 0, -1) : imageLoad(SOURCE, unpack_pixel(traced));
#else
    return imageLoad(SOURCE, clamp(place, ivec2(0), size_px - 1));
#endif
}

void add(inout Sum sum, vec4 sampled, float gauss)
{
    float weight  = sampled.a < 0.0 ? 0.0 : sampled.a > 0.0 ? gauss : gauss * blur_hole_weight;
    float trusted = weight * max(sampled.a, 0.0);
    sum.colour += sampled.rgb * trusted;
    sum.trusted += trusted;
    sum.weight += weight;
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel) || any(greaterThanEqual(pixel, size_px))) return;
    vec4  own    = imageLoad(SOURCE, pixel);
    float radius = own.a < 0.0 ? 0.0 : blur_radius(pixel, own.a == 0.0);
    // Half a step reaches no neighbour: what is smooth stays as it is, to the last bit.
    int   taps = radius < 0.5 ? 0 : min(taps_a_side, int(ceil(radius)));
    float stride = radius / float(max(taps, 1));
    ivec2 place  = pixel / step_px;
    // exp(-(2 i / taps)^2 / 2), as the radius is two standard deviations, by products: K. Turkowski 2007, GPU Gems 3, chapter 40.
    float gauss = 1.0, factor = exp(-2.0 / float(max(taps * taps, 1))), ratio = factor * factor;
    Sum   sum = Sum(vec3(0), 0.0, 0.0);
    add(sum, own, gauss);
    for (int i = 1; i <= taps; ++i)
    {
        gauss *= factor;
        factor *= ratio;
        ivec2 offset = axis * int(round(float(i) * stride));
        add(sum, reflection_at(place - offset), gauss);
        add(sum, reflection_at(place + offset), gauss);
    }
    vec4 blurred = mean_reflection(vec4(sum.colour, sum.trusted), sum.weight);
    imageStore(TARGET, pixel, taps == 0 ? own : blurred);
}
