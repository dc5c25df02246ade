// What more C++ (through shared.h) and GLSL must agree on: shaders around the trace, and variants of it.

// Of a frame with all its layers.
#define MAX_LAYERS 4
#define MAX_IMAGE_PX (1 << PIXEL_BITS)

// Invocations of a workgroup of a structure's pass per ray group: GpuInfo::lanes of them (GROUP_LANES) share a group.
#define RAY_GROUP_INVOCATIONS 64

// Tiles that a workgroup classifies, side by side (shaders/rays/classification.comp, classification_by_pixel.comp).
#define CLASSIFIED_TILES 32
#define CLASSIFIED_TILES_BY_PIXEL 16

// Specialization constants. Technique parameters start at CONSTANT_PARAMETERS, in the order of technique.toml's names.
#define CONSTANT_RAY_OFFSET_M 4
#define CONSTANT_EVERY_SURFACE 7
#define CONSTANT_RAYS_PER_WORKGROUP 8
#define CONSTANT_TRACE_BLOCK_PX 9
#define CONSTANT_COUNTS_PIXELS 10
#define CONSTANT_RAYS_PER_PIXEL 11
#define CONSTANT_FRONT_SLOPE 12
#define CONSTANT_FRONT_SCALE 13
#define CONSTANT_FRONT_SHIFT 14
#define CONSTANT_DIELECTRIC_MIN_F0 15
#define CONSTANT_DIELECTRIC_MAX_ROUGHNESS 16
#define CONSTANT_LOBE_RAYS 17
#define CONSTANT_PARAMETERS 32
#define CONSTANT_PASSES 64        // the passes' parameters, in the order of frame/passes/all_passes.cpp
#define CONSTANT_REPROJECTION 256 // those of the reprojection strategy

// What became of a pixel's history (framework/frame/frame_history.h, HistoryCounts).
#define HISTORY_ACCUMULATED 0
#define HISTORY_UNSEEN 1
#define HISTORY_OFF_IMAGE 2
#define HISTORY_OTHER_DEPTH 3
#define HISTORY_OTHER_NORMAL 4
#define HISTORY_OTHER_HIT 5
#define HISTORY_CLAMPED 6
#define HISTORY_COUNTS 7

// Sub-pixel offsets are centres of a grid of this many cells per side.
#define OFFSET_CELLS 256

// A block without a pixel that reflects.
#define NO_PIXEL 0xFFFFFFFFu

// Roughness histogram of the reflecting pixels: bin 0 holds roughness 0, the others share (0, 1].
#define ROUGHNESS_BINS 16

// Of the split-sum (DFG) table, in roughness and in cosine.
#define DFG_TABLE_ENTRIES 32
