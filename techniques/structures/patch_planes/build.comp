// The base plane of each patch of pixels, and its occluders. The base plane is linear on screen, as depth is where a surface is flat. Every depth in
// the patch lies behind this plane, except the occluders: they are so much nearer that a ray could pass between the two, behind a slab. Four numbers:
// how much nearer the plane gets each pixel to the right and each pixel down, its depth at the centre of the first pixel, and the least key of the
// occluders (surface/held.glsl, back_key), or 0. Any choice of a base plane is correct; a good one is useful.
#include "api/view.glsl"
#include "api/slab.glsl"
#include "api/held.glsl"
#include "surface/order.glsl"
#include "layout/load_depth.glsl"
#include "layout/cell_pairs.glsl"
#include "layout/load_gradients.glsl"
#include "structure/buffers"
#include "patch.glsl"
#if PATCH_BITS != STRIP_BITS + 1
#error a patch is as wide as a strip: its rows are adjacent in memory
#endif

layout(local_size_x = 8, local_size_y = 8) in;

#ifdef IN_FRONT
const int sample_rows = 2; // packets that stay in front of everything pass behind nothing
#else
const int sample_rows = 4;
#endif
const int   side_px = 1 << PATCH_BITS, quads = side_px / 4, samples = sample_rows * sample_rows;
const float none = 1e30;
// Of depth: how far a sample may lie off a plane that holds it, and how much the lines through its neighbours may bend there.
const float on_plane = 1.0 / 4096, most_bent = 1.0 / 100000;

// Of the rows of samples the one in the middle of its share of the patch, or of the columns of four pixels the one that place lies in.
int sample_row(int number) { return (2 * number + 1) * side_px / (2 * sample_rows); }
int sample_quad(int number) { return sample_row(number) / 4; }

// Floats as integers, whose min() and max() cost less: the bits of those above 0 order like the floats, those of background are greater than any.
// Fronts below 0 keep a plane at 0, which is above them; nothing at all leaves it below everything.
const uint nothing = 0x7149F2CAu; // floatBitsToUint(none)
const int  no_front = 0x80000000;

// The key of a pixel, or of one of its layers, that stands so much nearer than the base plane that it is an occluder; else `nothing`.
uint occluder_bits(Held held, float depth, float plane_rise, float stands)
{
#ifdef IN_FRONT
    return nothing;
#else
    float key = back_key(held, depth);
    return key > 0.0 && key - plane_rise > stands ? floatBitsToUint(key) : nothing;
#endif
}

// The front of one that is no occluder, above a plane of this gradient.
int height_bits(Held held, float depth, float plane_rise, vec2 gradient, uint occluder)
{
    return occluder == nothing && depth > 0.0 ? floatBitsToInt(front_above(held, gradient) - plane_rise) : no_front;
}

void main()
{
    ivec2 patches = ((size_px - 1) >> PATCH_BITS) + 1, place = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(place, patches))) return;
    ivec2 first = place << PATCH_BITS;
    ivec2 last = min(ivec2(side_px), size_px - first) - 1;
    int   first_quad = depth_word(first) >> 2; // its rows follow each other in memory

    // Samples lie in the third of their four pixels, between the neighbours to the left and right, or farther left in a patch that is narrower.
    // Of other columns a neighbour beside the picture is background: no plane goes through those samples.
    vec3  depths[samples]; // y: the sample's
    vec2  beside[samples]; // above and below it
    vec2  at[sample_rows], spans[sample_rows]; // of columns and rows: where samples lie, and how far their neighbours are apart
    ivec3 picks[sample_rows]; // of the four pixels of a column: left neighbour, sample, right neighbour
    for (int column = 0; column < sample_rows; ++column)
    {
        int inside = sample_quad(column) == 0 ? min(last.x, 3) : 3, pick = max(inside - 1, 0);
        picks[column]   = ivec3(max(pick - 1, 0), pick, min(pick + 1, inside));
        at[column].x    = float(4 * sample_quad(column) + pick);
        spans[column].x = float(max(picks[column].z - picks[column].x, 1));
    }
    for (int row = 0; row < sample_rows; ++row)
    {
        int y = max(min(sample_row(row), last.y - 1), 0), above = max(y - 1, 0), below = min(y + 1, last.y);
        at[row].y    = float(y);
        spans[row].y = float(max(below - above, 1));
        for (int column = 0; column < sample_rows; ++column)
        {
            int   quad = first_quad + sample_quad(column), word = 4 * quad + picks[column].y, i = row * sample_rows + column;
            uvec4 four = load_pair(quad + y * quads);
            depths[i]  = uintBitsToFloat(uvec3(four[picks[column].x], four[picks[column].y], four[picks[column].z]));
            beside[i]  = vec2(LOAD_TEXEL(depth_words, word + above * side_px).x, LOAD_TEXEL(depth_words, word + below * side_px).x);
        }
    }

    // The farthest of the planes through a sample and its neighbours that hold another sample: occluders stand before the base plane, not behind it.
    vec2  gradient = vec2(0);
    float base = none, corner = 0; // the plane's depth in the middle of the patch, and in its first pixel
    for (int i = 0; i < samples; ++i)
    {
        int   column = i % sample_rows, row = i / sample_rows;
        float depth = depths[i].y, x = at[column].x, y = at[row].y;
        vec2  before = vec2(depths[i].x, beside[i].x), after = vec2(depths[i].z, beside[i].y);
        vec2  span = vec2(spans[column].x, spans[row].y), slope = (after - before) / span;
        vec2  bent = abs(before + after - 2 * depth) * (span - 1); // not with one neighbour
        float zero = depth - slope.x * x - slope.y * y, middle = zero + (slope.x + slope.y) * float(side_px - 1) / 2;
        float nearest_off = none;
        for (int j = 0; j < samples; ++j)
        {
            float off = abs(depths[j].y - (zero + slope.x * at[j % sample_rows].x) - slope.y * at[j / sample_rows].y);
            nearest_off = j != i && off < nearest_off ? off : nearest_off;
        }
        bool farther = bent.x + bent.y < depth * most_bent && nearest_off < depth * on_plane && middle < base;
        gradient     = farther ? slope : gradient;
        corner       = farther ? zero : corner;
        base         = farther ? middle : base;
    }

    // How much nearer than the base plane the key of a pixel is whose back lies there.
    float nearest = key_of_back(base);
    bool  passes  = base < none && nearest >= base;
    float stands  = passes ? corner + nearest - base : none;
    uint before = nothing;
    int  height = no_front;
    // Down the columns, so that reads of different cache lines are under way at once.
    for (int column = 0; column < quads; ++column)
    {
        vec4 across = gradient.x * vec4(4 * column + ivec4(0, 1, 2, 3));
        for (int row = 0; row < side_px; ++row)
        {
            int   y     = min(row, last.y);
            uvec4 bits  = load_pair(first_quad + y * quads + column), befores;
            vec4  depth = uintBitsToFloat(bits), plane_rise = gradient.y * float(y) + across;
            uvec4 gradients = load_gradients(first + ivec2(4 * column, y));
            ivec4 heights;
            for (int k = 0; k < 4; ++k)
            {
                ivec2 pixel = first + ivec2(4 * column + k, y);
                Held held  = held_by(pixel, 0, depth[k], gradients[k]);
                befores[k] = occluder_bits(held, depth[k], plane_rise[k], stands);
                heights[k] = height_bits(held, depth[k], plane_rise[k], gradient, befores[k]);
#if LAYERS > 1
                for (int layer = 1; layer < LAYERS; ++layer)
                {
                    uvec2 words   = pixel.x < size_px.x ? load_layer(pixel, layer) : uvec2(0);
                    float further = uintBitsToFloat(words.x);
                    Held  behind  = held_by(pixel, layer, further, words.y);
                    uint  key     = occluder_bits(behind, further, plane_rise[k], stands);
                    befores[k]    = min(befores[k], key);
                    heights[k]    = max(heights[k], height_bits(behind, further, plane_rise[k], gradient, key));
                }
#endif
            }
            before = min(before, min(min(befores.x, befores.y), min(befores.z, befores.w)));
            height = max(height, max(max(heights.x, heights.y), max(heights.z, heights.w)));
        }
    }
    float top    = height == no_front ? -none : intBitsToFloat(max(height, 0));
    float offset = top + dot(abs(gradient), vec2(side_px)) / (1 << 20); // what rounding moved it by, and will where it is used
    store_planes(place.y * patches.x + place.x, vec4(gradient, offset, before < nothing ? uintBitsToFloat(before) : 0.0));
}
