// Where data lies in memory, and how it is read and written. This is the one shader file that knows drivers: all others load and store. Each trick
// and its gain: docs/performance.md. A shader names what it needs before it includes this file: READS_DEPTH, WRITES_DEPTH, READS_CELLS, CELL_PAIRS
// (after size_px, the image's size).
#include "layout/shared.h"
#ifndef SSRLAB_MEMORY_LAYOUT
#define SSRLAB_MEMORY_LAYOUT

// ---- Workgroups
// A launch is folded into rows. A CPU device gives the upper rows to one thread and the lower rows to another: neighbours in a list go to different
// threads, since they cost about the same.
uint unfold_group(uvec2 group, uint rows)
{
    uint upper = (rows + 1) / 2;
    uint row   = group.y < upper ? 2 * group.y : 2 * (group.y - upper) + 1;
    return row * LAUNCH_ROW_GROUPS + group.x;
}

// Number of this workgroup in a launch over a list.
#define work_group() unfold_group(gl_WorkGroupID.xy, gl_NumWorkGroups.y)

// ---- Buffers of texels
// Buffers are read as texels: lavapipe loads a texel once for each lane, and needs a dozen instructions a lane for a word of a storage buffer. It stores
// a texel word by word, each in a loop over its lanes, but 64 bits of a storage buffer at once: texels are stored so where the device has 64-bit
// integers and its storage buffers are large enough (STORES_64_BITS).
#ifdef STORES_64_BITS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
uint64_t to_stored(uvec2 words) { return packUint2x32(words); }
u64vec2  to_stored(uvec4 words) { return u64vec2(packUint2x32(words.xy), packUint2x32(words.zw)); }
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { uint64_t name##_texels[]; };
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, scalar) writeonly buffer name { u64vec2 name##_texels[]; };
#define STORE_TEXEL(name, index, words) name##_texels[index] = to_stored(words)
#else
uvec4 to_stored(uvec2 words) { return uvec4(words, 0, 0); }
uvec4 to_stored(uvec4 words) { return words; }
#define STORED_TEXELS_2(place, name) layout(set = 0, binding = place, rg32ui) uniform writeonly uimageBuffer name;
#define STORED_TEXELS_4(place, name) layout(set = 0, binding = place, rgba32ui) uniform writeonly uimageBuffer name;
#define STORE_TEXEL(name, index, words) imageStore(name, int(index), to_stored(words))
#endif

// The buffers of structures are declared through these (framework/render/structure_passes.cpp): load_NAME(index), store_NAME(index, value).
#define LOADED_BUFFER(place, name, type, format, from_bits, words)                     \
    layout(set = 0, binding = place, format) uniform readonly uimageBuffer name##_loaded; \
    type load_##name(int index) { return from_bits(imageLoad(name##_loaded, index).words); }
#define STORED_BUFFER_1(place, name, type, to_bits)                                    \
    layout(set = 0, binding = place, r32ui) uniform writeonly uimageBuffer name##_stored; \
    void store_##name(int index, type value) { imageStore(name##_stored, index, uvec4(to_bits(value))); }
#define STORED_BUFFER_2(place, name, type, to_bits) \
    STORED_TEXELS_2(place, name##_stored)           \
    void store_##name(int index, type value) { STORE_TEXEL(name##_stored, index, to_bits(value)); }
#define STORED_BUFFER_4(place, name, type, to_bits) \
    STORED_TEXELS_4(place, name##_stored)           \
    void store_##name(int index, type value) { STORE_TEXEL(name##_stored, index, to_bits(value)); }
// Doubles have no texel format.
#define LOADED_DOUBLES(place, name, type)                                                            \
    layout(set = 0, binding = place, scalar) readonly buffer name##_loaded { type name##_elements[]; }; \
    type load_##name(int index) { return name##_elements[index]; }
#define STORED_DOUBLES(place, name, type)                                                                    \
    layout(set = 0, binding = place, scalar) writeonly buffer name##_stored { type name##_stored_elements[]; }; \
    void store_##name(int index, type value) { name##_stored_elements[index] = value; }
#endif

// ---- Depth and the cells above it
// One buffer holds the depth of every pixel, BACKGROUND_DEPTH where there is nothing, as level 0, and above it two words for each cell of each level
// (layout/shared.h says in what order: strips one cache line wide, rows as a binary heap). A structure may fill the cells.
#if (defined(READS_DEPTH) || defined(WRITES_DEPTH) || defined(READS_CELLS) || defined(CELL_PAIRS)) && !defined(SSRLAB_CELL_LAYOUT)
#define SSRLAB_CELL_LAYOUT

// Levels above 0: until one row of cells is left.
int pyramid_levels()
{
    return findMSB(2 * size_px.y - 1);
}

int pyramid_root = 1 << pyramid_levels(), pyramid_height = pyramid_rows(pyramid_root, size_px.y);

// Of the cell of a level that holds a pixel, or at level 0 of the two pixels of which it is one.
int cell_index(ivec2 pixel, int level)
{
    return pixel_to_cell_index(pixel.x, pixel.y, level, pyramid_root, pyramid_height);
}

// Of the two words of a pixel with its plane.
int plane_index(ivec2 pixel)
{
    return planes_first(size_px.x, pyramid_height) + strip_index(pixel.x, pixel.y, planes_rows(size_px.y));
}

int depth_word(ivec2 pixel)
{
    return 2 * cell_index(pixel, 0) + (pixel.x & 1);
}
#endif

#ifndef DEPTH_BINDING
#define DEPTH_BINDING 1
#endif
#if defined(READS_DEPTH) && !defined(SSRLAB_READS_DEPTH)
#define SSRLAB_READS_DEPTH
layout(set = 0, binding = DEPTH_BINDING, r32f) uniform readonly imageBuffer depth_words;

float load_depth(ivec2 pixel)
{
    return imageLoad(depth_words, depth_word(pixel)).x;
}
#endif

#if defined(WRITES_DEPTH) && !defined(SSRLAB_WRITES_DEPTH)
#define SSRLAB_WRITES_DEPTH
layout(set = 0, binding = DEPTH_BINDING, r32f) uniform writeonly imageBuffer depth_words;

STORED_TEXELS_2(PLANES_BINDING, StoredPlanes)

// gradient: as framework/core/plane_gradient.h packs it.
void store_depth(ivec2 pixel, float depth, uint gradient)
{
    imageStore(depth_words, depth_word(pixel), vec4(depth));
    STORE_TEXEL(StoredPlanes, plane_index(pixel), uvec2(floatBitsToUint(depth), gradient));
}
#endif

#if defined(READS_CELLS) && !defined(SSRLAB_READS_CELLS)
#define SSRLAB_READS_CELLS
layout(set = 0, binding = 3, rg32ui) uniform readonly uimageBuffer depth_cells;

// The two words of the cell of a level that holds a pixel. At level 0 the depths of two pixels, or with planes the pixel's depth and gradient. Pixels and
// cells are read alike, since the lanes of a group stand on different levels.
#ifdef PIXEL_PLANES
int leaf_rows = planes_rows(size_px.y), leaf_first = planes_first(size_px.x, pyramid_height) - (pyramid_root << STRIP_BITS);

// plane_index() at level 0, cell_index() above, with one multiplication.
uvec2 load_cell(ivec2 pixel, int level)
{
    bool leaf  = level == 0;
    int  index = strip_index(pixel.x >> level, (pyramid_root | pixel.y) >> level, leaf ? leaf_rows : pyramid_height) + (leaf ? leaf_first : 0);
    return imageLoad(depth_cells, index).xy;
}

// What load_cell() says of this pixel at level 0.
float depth_in(uvec2 words, ivec2 pixel) { return uintBitsToFloat(words.x); }
#else
uvec2 load_cell(ivec2 pixel, int level)
{
    return imageLoad(depth_cells, cell_index(pixel, level)).xy;
}

float depth_in(uvec2 words, ivec2 pixel) { return uintBitsToFloat((pixel.x & 1) != 0 ? words.y : words.x); }
#endif
#endif

#if defined(CELL_PAIRS) && !defined(SSRLAB_CELL_PAIRS)
#define SSRLAB_CELL_PAIRS
layout(set = 0, binding = 10, rgba32ui) uniform readonly uimageBuffer cell_pairs;

// Two cells side by side, or four pixels. x: even (a multiple of four for pixels). first_row: the row of the heap with which the cells' level begins.
int pair_index(ivec2 cell, int first_row)
{
    return strip_index(cell.x, first_row + cell.y, pyramid_height) >> 1;
}

uvec4 load_pair(int index)
{
    return imageLoad(cell_pairs, index);
}

// The gradients of four pixels in a row, x a multiple of four; 0 without planes.
uvec4 load_gradients(ivec2 pixel)
{
#ifdef PIXEL_PLANES
    int first = plane_index(pixel) >> 1;
    return uvec4(load_pair(first).yw, load_pair(first + 1).yw);
#else
    return uvec4(0);
#endif
}

STORED_TEXELS_4(11, StoredCells)

void store_pair(int index, uvec4 cells)
{
    STORE_TEXEL(StoredCells, index, cells);
}
#endif
