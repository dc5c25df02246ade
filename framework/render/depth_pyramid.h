// Depth as tracers read it, and the pyramid that is built on it, in one buffer. Folder-internal.
#pragma once

#include "gpu/resources.h"

#include <span>
#include <vector>

namespace ssrlab {

/// Levels above 0, which is the picture itself, two pixels in the place of a cell: until one row of cells is left.
int pyramid_levels(glm::ivec2 size_px);
/// The row in which level 0 begins; a level begins there halved as often (shaders/layout/shared.h).
int pyramid_root(glm::ivec2 size_px);
/// Cells of all levels; whole strips.
glm::ivec2 pyramid_size(glm::ivec2 size_px);
/// Where the cell of a level that holds a pixel lies in the buffer, or at level 0 the two pixels of which it is one.
size_t cell_index(glm::ivec2 size_px, glm::ivec2 pixel, int level);
/// Cells of a level.
glm::ivec2 level_size(glm::ivec2 size_px, int level);

/// The depth of every pixel and what is known of cells, in strips.
struct DepthPyramid {
    glm::ivec2           size_px{0, 0};
    Buffer               cells;           // as texels: both words of a cell (shaders/pyramid_cell.glsl), or two pixels
    vk::raii::BufferView words = nullptr; // as texels: each word
    vk::raii::BufferView pairs = nullptr; // as texels: two cells, or four pixels
    Buffer               patch_planes;    // four floats a patch (shaders/patch_planes.comp)
};

/// Without content.
DepthPyramid       make_depth_pyramid(Gpu& gpu, glm::ivec2 size_px);
void               write_depth(Gpu& gpu, DepthPyramid& pyramid, std::span<const float> depth);
std::vector<float> read_depth(Gpu& gpu, const DepthPyramid& pyramid);

} // namespace ssrlab
