// One level of what cones look up (passes/cone.glsl): colour, and the share of a cell that is empty in front of its surfaces.
// Y. Uludag 2014, "Hi-Z Screen-Space Cone-Traced Reflections", GPU Pro 5. Cells lie as in depth_pyramid.comp.
#include "api/view.glsl"
#include "layout/load_depth.glsl"
#include "pass/parameters"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D radiance_image;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D highlight_image;
layout(set = 0, binding = 4, rgba16f) uniform image2D cone_pyramid; // colour, visibility
layout(set = 0, binding = 5, rg32f) uniform image2D cone_ranges;    // distances of the nearest and the farthest surface, in metres
layout(push_constant, scalar) uniform Push
{
    ivec2 source_size; // cells of the level below
    ivec2 size;        // cells of this level
    int   row;         // where it begins
};

const float background_m = 1e30;

#ifdef FROM_PIXELS
vec4 source_colour(ivec2 cell)
{
    vec4 light = imageLoad(radiance_image, cell);
    if (hit_shading == hit_shading_lit) light += imageLoad(highlight_image, cell);
    return vec4(light.rgb, 1);
}

vec2 source_range(ivec2 cell)
{
    float depth = load_depth(cell);
    return vec2(depth > 0.0 ? depth_to_distance(depth) : background_m);
}
#else
vec4 source_colour(ivec2 cell)
{
    return imageLoad(cone_pyramid, cell + ivec2(0, 2 * row));
}

vec2 source_range(ivec2 cell)
{
    return imageLoad(cone_ranges, cell + ivec2(0, 2 * row)).xy;
}
#endif

// A tent over 4 x 4 cells: boxes would show their edges.
vec3 mean_colour(ivec2 cell)
{
    vec3 sum = vec3(0);
    for (int y = -1; y <= 2; ++y)
        for (int x = -1; x <= 2; ++x)
        {
            ivec2 at     = clamp(2 * cell + ivec2(x, y), ivec2(0), source_size - 1);
            float weight = (x == 0 || x == 1 ? 0.375 : 0.125) * (y == 0 || y == 1 ? 0.375 : 0.125);
            sum += weight * source_colour(at).rgb;
        }
    return sum;
}

void main()
{
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(cell, size))) return;
    vec2  range = vec2(background_m, 0);
    vec4  nearest_m, below;
    for (int i = 0; i < 4; ++i)
    {
        // At the image's edge a part that is not there counts like the one beside it.
        ivec2 part  = min(2 * cell + ivec2(i & 1, i >> 1), source_size - 1);
        vec2  own   = source_range(part);
        range       = vec2(min(range.x, own.x), max(range.y, own.y));
        nearest_m[i] = own.x;
        below[i]     = source_colour(part).a;
    }
    // What lies in one plane hides nothing.
    vec4  empty      = range.x < range.y ? (nearest_m - range.x) / (range.y - range.x) : vec4(1);
    float visibility = dot(empty * below, vec4(0.25));
    imageStore(cone_ranges, cell + ivec2(0, row), vec4(range, 0, 0));
    imageStore(cone_pyramid, cell + ivec2(0, row), vec4(mean_colour(cell), visibility));
}
