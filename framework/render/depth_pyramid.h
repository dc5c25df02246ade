// Depth as tracers read it, and the pyramid that is built on it, in one buffer. Folder-internal.
#pragma once

#include "gpu/resources.h"

#include <span>
#include <vector>

namespace ssrlab {

/// Where the levels >= 1 of a pyramid lie in one atlas, side by side, or one above the other where the picture is taller than wide.
/// Level L begins at side - (side >> (L - 1)), side being the atlas's width or height. Its width is a power of two; where
/// there is a level it is even, and so is the column where each begins.
struct PyramidAtlas {
    glm::ivec2 size{0, 0};      // cells
    int        levels  = 0;     // above level 0, which is the picture itself
    bool       stacked = false; // one above the other

    glm::ivec2 first_cell(int level) const;
};
PyramidAtlas pyramid_atlas(glm::ivec2 size_px);
/// Cells of a level.
glm::ivec2 level_size(glm::ivec2 size_px, int level);

/// Level 0 is the depth of every pixel, row by row, two in the place of a cell; then comes the atlas, row by row.
struct DepthPyramid {
    glm::ivec2           size_px{0, 0};
    Buffer               cells;           // as texels: both words of a cell (shaders/pyramid_cell.glsl), or two pixels
    vk::raii::BufferView words = nullptr; // as texels: each word
    vk::raii::BufferView pairs = nullptr; // as texels: two cells, or four pixels
};
/// Level 0 in pairs of pixels: rows of whole cell pairs, and an even number of rows.
glm::ivec2 pixel_pairs(glm::ivec2 size_px);

/// Without content.
DepthPyramid       make_depth_pyramid(Gpu& gpu, glm::ivec2 size_px);
void               write_depth(Gpu& gpu, DepthPyramid& pyramid, std::span<const float> depth);
std::vector<float> read_depth(Gpu& gpu, const DepthPyramid& pyramid);

} // namespace ssrlab
