// The ground of each patch of 2^PATCH_BITS pixels square, and what stands before it. The ground is a plane, linear on screen as depth is where a
// surface is flat. No front of the patch lies nearer than that plane but those that stand before it: so much nearer that a ray could
// pass between the two, behind a slab. Four numbers: how much nearer the plane gets each pixel to the right and each pixel down, its depth at the
// centre of the first pixel, and the farthest depth of what stands before it, or 0. Any choice of ground is correct; a good one is useful.
#include "view.glsl"
#include "depth.glsl"
#include "slab.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_BEAMS_IN_FRONT) const int beams_in_front = 0;
layout(set = 0, binding = 3, rgba32ui) uniform readonly uimageBuffer cell_pairs; // four pixels a texel
layout(set = 0, binding = 14, rgba32f) uniform writeonly imageBuffer PatchPlanes;

const int   side_px = 1 << PATCH_BITS, sample_rows = beams_in_front != 0 ? 2 : 4, samples = sample_rows * sample_rows;
const float none = 1e30;
// Of depth: how far a sample may lie off a plane that holds it, and how much the line through its neighbours may bend there.
const float on_plane = 1.0 / 4096, most_bent = 1.0 / 100000;

// From a pixel whose x is a multiple of four to the right.
vec4 load_four_depths(ivec2 pixel)
{
    return uintBitsToFloat(imageLoad(cell_pairs, depth_word(pixel) >> 2));
}

// Where in the patch a sample lies: its neighbours lie in the patch, too, unless that is too small.
ivec2 sample_at(int number, ivec2 way)
{
    ivec2 place = (ivec2(number % sample_rows, number / sample_rows) * 2 + 1) * side_px / (2 * sample_rows), low = min(ivec2(1), way);
    return clamp(place, low, max(way - 1, low));
}

void main()
{
    ivec2 patches = ((size_px - 1) >> PATCH_BITS) + 1, place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, patches))) return;
    ivec2 first = place << PATCH_BITS, way = min(ivec2(side_px - 1), size_px - 1 - first);

    // The farthest of the planes through a sample and its neighbours that hold another sample: things stand before the ground, not behind it.
    float depths[samples];
    for (int i = 0; i < samples; ++i) depths[i] = load_depth(first + sample_at(i, way));
    vec2  gradient = vec2(0);
    float ground = none, corner = 0; // the plane's depth in the middle of the patch, and in its first pixel
    for (int i = 0; i < samples; ++i)
    {
        ivec2 local = sample_at(i, way), low = max(local - 1, ivec2(0)), high = min(local + 1, way);
        vec2  last = vec2(load_depth(first + ivec2(low.x, local.y)), load_depth(first + ivec2(local.x, low.y)));
        vec2  next = vec2(load_depth(first + ivec2(high.x, local.y)), load_depth(first + ivec2(local.x, high.y)));
        vec2  span = vec2(max(high - low, ivec2(1))), slope = (next - last) / span;
        vec2  bent = abs(last + next - 2 * depths[i]) * (span - 1); // not with one neighbour
        float zero = depths[i] - dot(slope, vec2(local)), middle = zero + dot(slope, vec2(side_px - 1) / 2);
        int   held = 0;
        for (int j = 0; j < samples; ++j)
            held += int(abs(depths[j] - zero - dot(slope, vec2(sample_at(j, way)))) < depths[i] * on_plane);
        bool farther = bent.x + bent.y < depths[i] * most_bent && held > 1 && middle < ground;
        gradient     = farther ? slope : gradient;
        corner       = farther ? zero : corner;
        ground       = farther ? middle : ground;
    }

    // How much nearer a front is whose slab ends at the ground.
    float nearest = (ground + slab_shift) / (slab_scale - ground * slab_slope);
    bool  passes  = ground < none && nearest > ground;
    float stands  = passes ? corner + nearest - ground : none;
    float height = -none, before = none;
    // Beams that stay in front of everything pass behind nothing. Down the columns, so that reads of different cache lines are under way at once.
    for (int i = 0; i < side_px * side_px / 4; ++i)
    {
        ivec2 local = min(ivec2(i >> PATCH_BITS << 2, i & (side_px - 1)), way & ivec2(~3, ~0));
        vec4  depth = load_four_depths(first + local), x = float(local.x) + vec4(0, 1, 2, 3);
        vec4  front = depth - gradient.x * x - gradient.y * float(local.y);
        for (int k = 0; k < 4; ++k)
        {
            bool surface = local.x + k <= way.x && depth[k] > 0.0, is_before = beams_in_front == 0 && front[k] > stands;
            before       = surface && is_before && depth[k] < before ? depth[k] : before;
            height       = surface && !is_before && front[k] > height ? front[k] : height;
        }
    }
    height += dot(abs(gradient), vec2(side_px)) / (1 << 20); // what rounding moved it by, and will where it is used
    imageStore(PatchPlanes, place.y * patches.x + place.x, vec4(gradient, height, before < none ? before : 0.0));
}
