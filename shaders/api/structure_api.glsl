// What the shaders of a structure and the techniques that read it share: where elements lie in a buffer of each size rule. After api/camera.glsl.
// A buffer NAME of the manifest has load_NAME(index); in the structure's own passes also store_NAME(index, value); with `count` elements each, NAME_count.
#include "layout/load_cell.glsl"
#include "layout/workgroups.glsl"
#include "api/ray_group.glsl"

// per = "pixel"
int pixel_index(ivec2 pixel) { return pixel.y * size_px.x + pixel.x; }

// per = "tile": the tile that holds a pixel.
int tile_index(ivec2 pixel, int tile_px) { return (pixel.y / tile_px) * ((size_px.x - 1) / tile_px + 1) + pixel.x / tile_px; }

// per = "cell": the cell of a level >= 1 that holds a pixel.
int level_cell_index(ivec2 pixel, int level) { return ((pyramid_root | pixel.y) >> level) * (((size_px.x - 1) >> 1) + 1) + (pixel.x >> level); }

// Cells of a level; level 0 is the pixels.
ivec2 level_size(int level) { return ((size_px - 1) >> level) + 1; }
