// Depth as tracers read it, and the pyramid that is built on it, in one buffer. Folder-internal.
#pragma once

#include "gpu/resources.h"

#include <span>
#include <vector>

namespace ssrlab {

/// The levels of a pyramid, one below another: level_row() of shaders/shared.h. Level 0 is the picture, two pixels in the place of a cell.
struct PyramidAtlas {
    glm::ivec2 size{0, 0}; // cells; whole strips
    int        levels = 0; // above level 0
};
PyramidAtlas pyramid_atlas(glm::ivec2 size_px);
/// Where a cell lies in the buffer, or at level 0 the two pixels of which this is one.
size_t cell_index(glm::ivec2 size_px, glm::ivec2 cell, int level);
/// Cells of a level.
glm::ivec2 level_size(glm::ivec2 size_px, int level);

/// The depth of every pixel and what is known of cells: an atlas in strips.
struct DepthPyramid {
    glm::ivec2           size_px{0, 0};
    Buffer               cells;           // as texels: both words of a cell (shaders/pyramid_cell.glsl), or two pixels
    vk::raii::BufferView words = nullptr; // as texels: each word
    vk::raii::BufferView pairs = nullptr; // as texels: two cells, or four pixels
};

/// Without content.
DepthPyramid       make_depth_pyramid(Gpu& gpu, glm::ivec2 size_px);
void               write_depth(Gpu& gpu, DepthPyramid& pyramid, std::span<const float> depth);
std::vector<float> read_depth(Gpu& gpu, const DepthPyramid& pyramid);

} // namespace ssrlab
