// Gives a reflection to the pixels that reflect and were not traced, from the 2 x 2 traced pixels about them: bilinear, and by how much
// those are the same surface. B. Wronski 2014, "GDC follow-up: Screenspace reflections filtering and up-sampling".
// In place: what is read was traced, what is written was not.
#include "api/view.glsl"
#include "rays/reflecting.glsl"
#include "pass/parameters"
#include "passes/blocks.glsl"
#include "passes/camera.glsl"
#include "passes/mean_reflection.glsl"
#include "passes/directional_albedo.glsl"
#include "rays/tiles.glsl"
#include "layout/frame_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 4, rgba16f) uniform image2D reflection_image;
layout(set = 0, binding = 5, r32ui) uniform readonly uimage2D block_pixel_image;

const float vanishing = 1e-4;

struct Surface
{
    vec3  position_vs, normal_vs;
    float reflectivity;
};

Surface surface_at(ivec2 pixel)
{
    vec4 normal   = imageLoad(normal_image, pixel);
    vec4 material = imageLoad(material_image, pixel);
    Surface surface;
    surface.position_vs  = px_to_vs(vec3(vec2(pixel) + 0.5, load_depth(pixel)));
    surface.normal_vs    = normalize(normal.xyz);
    float cosine         = max(0.0, dot(surface.normal_vs, to_camera_vs(surface.position_vs)));
    float f0             = mix(imageLoad(dielectric_image, pixel).x, dot(material.rgb, vec3(0.2126, 0.7152, 0.0722)), material.a);
    surface.reflectivity = directional_albedo(vec3(f0), normal.w, cosine).x;
    return surface;
}

// 1 for the same surface. Depths are compared along the normal: a floor that recedes is one surface.
float similarity(Surface a, Surface b)
{
    float weight = 1.0;
    if (upsampling_depth)
    {
        float step_m = abs(dot(a.normal_vs, b.position_vs - a.position_vs));
        weight *= exp(-step_m / (upsampling_depth_tolerance * -a.position_vs.z));
    }
    if (upsampling_normal) weight *= pow(max(0.0, dot(a.normal_vs, b.normal_vs)), 32.0);
    if (upsampling_reflectivity)
        weight *= exp(-abs(a.reflectivity - b.reflectivity) / upsampling_reflectivity_tolerance);
    return weight;
}

// A bilinear mean of pictures: colours count by their weight.
vec4 upsampled(ivec2 pixel)
{
    Surface own    = surface_at(pixel);
    ivec2   centre = ivec2((block_px - 1) / 2); // of a block that reflects everywhere, this pixel is traced
    ivec2   blocks = imageSize(block_pixel_image);
    vec2    place  = vec2(pixel - centre) / float(block_px);
    ivec2   corner = ivec2(floor(place));
    vec2    share  = place - vec2(corner);

    vec4  sum = vec4(0), closest = vec4(0);
    float total = 0.0, best = -1.0;
    for (int i = 0; i < 4; ++i)
    {
        ivec2 step  = ivec2(i & 1, i >> 1);
        ivec2 block = corner + step;
        bool  known = all(greaterThanEqual(block, ivec2(0))) && all(lessThan(block, blocks));
        uint  found = known ? imageLoad(block_pixel_image, block).x : NO_PIXEL;
        if (found != NO_PIXEL)
        {
            ivec2 from   = unpack_pixel(found);
            vec4  traced = imageLoad(reflection_image, from);
            float alike  = similarity(own, surface_at(from));
            vec2  near   = mix(1.0 - share, share, vec2(step));
            float weight = (upsampling_distance ? near.x * near.y : 1.0) * alike;
            sum += weight * vec4(traced.rgb * traced.a, traced.a);
            total += weight;
            closest = alike > best ? traced : closest;
            best    = max(best, alike);
        }
    }
    if (total < vanishing) return closest;
    return mean_reflection(sum, total);
}

void main()
{
    ivec2 pixel;
    if (!listed_pixel(pixel)) return;
    if (any(greaterThanEqual(pixel, size_px)) || !reflects(pixel)) return;
    if (imageLoad(reflection_image, pixel).a >= 0.0) return; // traced
    imageStore(reflection_image, pixel, upsampled(pixel));
}
