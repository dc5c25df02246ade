// Numbers, and places in memory, that C++ and GLSL must agree on. Included by both.
#ifndef SSRLAB_SHARED_H
#define SSRLAB_SHARED_H
#ifdef __cplusplus
#include "frame_shared.h"
#endif

// Why a ray stopped (core/trace_result.h has the same list with its meaning).
#define TRACE_NOT_TRACED 0
#define TRACE_HIT 1
#define TRACE_LEFT_SCREEN 2
#define TRACE_PAST_MAX_DISTANCE 3
#define TRACE_OUT_OF_STEPS 4
#define TRACE_FACING_AWAY 5
#define TRACE_STOPPED 6
#define TRACE_IMPOSSIBLE 7

#ifdef __cplusplus
#define SHARED_FUNCTION inline
#else
#define SHARED_FUNCTION
#endif

// A pixel and a small number in one uint: x in bits 0..13, y in 14..27, the number in 28..31.
#define PIXEL_BITS 14
#define MAX_IMAGE_PX (1 << PIXEL_BITS)

// How a ray ended, as that number: its status (0 ... 7), but that of a hit or a stop in a layer behind the first tells the layer, too.
#define MAX_LAYERS 4
SHARED_FUNCTION int number_to_layer(int number) { return number < 8 ? 0 : (number >> 1) - 3; }
SHARED_FUNCTION int number_to_status(int number) { return number < 8 ? number : (number & 1) == 0 ? TRACE_HIT : TRACE_STOPPED; }
SHARED_FUNCTION int status_to_number(int status, int layer) { return layer == 0 ? status : 6 + 2 * layer + (status == TRACE_HIT ? 0 : 1); }

// Rays are traced in groups of this many; a launch is a grid no wider than so many groups.
#define RAYS_PER_GROUP 64
#define LAUNCH_ROW_GROUPS 256

// Invocations of a workgroup of a structure's pass per ray group: GpuInfo::lanes of them (GROUP_LANES in shaders) share a group.
#define RAY_GROUP_INVOCATIONS 64

// What becomes of a ray that meets a pixel from behind (core/trace_result.h, Behind).
#define BEHIND_HIT 0
#define BEHIND_PASS 1
#define BEHIND_STOP 2

// Specialization constants; frame_shared.h has more. Technique parameters start at CONSTANT_PARAMETERS, in the order of technique.toml's names.
#define CONSTANT_SLAB_SLOPE 0
#define CONSTANT_SLAB_SCALE 1
#define CONSTANT_SLAB_SHIFT 2
#define CONSTANT_MAX_DISTANCE_M 3
#define CONSTANT_RAY_OFFSET_M 4
#define CONSTANT_BEHIND 5
#define CONSTANT_ORTHOGRAPHIC 6
#define CONSTANT_FRONT_SLOPE 12
#define CONSTANT_FRONT_SCALE 13
#define CONSTANT_FRONT_SHIFT 14
#define CONSTANT_PARAMETERS 32

// Background in the depth that tracers read: nearer than nothing, so that no interval touches it.
#define BACKGROUND_DEPTH -1.0

// ---- The depth pyramid. Its rows are a binary heap: the picture's row y is row root + y, where the root is the power of two that covers the
// picture's height, and the cells above a row lie in the row of half its number. Level 0 holds two pixels in the place of a cell. All lies
// in strips of 2^STRIP_BITS cells' width: a row of one is a cache line, and what a ray meets on its way up or down the picture follows in memory.
#define STRIP_BITS 3

// With a row below the picture, which holds background as all beside it does; odd, so that the strips' cache lines do not compete for the same
// places.
SHARED_FUNCTION int pyramid_rows(int root, int height_px) { return (root + height_px + 1) | 1; }

SHARED_FUNCTION int strip_index(int x, int row, int rows)
{
    return (((x >> STRIP_BITS) * rows + row) << STRIP_BITS) + (x & ((1 << STRIP_BITS) - 1));
}

// Of the cell of a level that holds a pixel, or at level 0 of the two pixels of which it is one.
SHARED_FUNCTION int pixel_to_cell_index(int x_px, int y_px, int level, int root, int rows)
{
    return strip_index(x_px >> (level > 1 ? level : 1), (root | y_px) >> level, rows);
}

#endif
