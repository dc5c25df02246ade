// Depth as tracers read it, with room for two words a cell of each level above it. Folder-internal.
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

/// The depth of every pixel as level 0, and the cells above it, in strips; behind them every pixel's depth with its
/// plane (shaders/layout/cell_places.glsl, plane_places.glsl).
struct DepthBuffer {
    glm::ivec2           size_px{0, 0};
    Buffer               cells;           // as texels: both words of a cell, or the depths of two pixels
    vk::raii::BufferView words = nullptr; // as texels: each word
    vk::raii::BufferView pairs = nullptr; // as texels: two cells, or four pixels
};

/// Without content.
DepthBuffer make_depth_buffer(Gpu& gpu, glm::ivec2 size_px);
/// gradients: of each pixel, packed (core/plane_gradient.h); empty: level planes.
void write_depth(Gpu& gpu, DepthBuffer& buffer, std::span<const float> depth, std::span<const uint32_t> gradients);
std::vector<float> read_depth(Gpu& gpu, const DepthBuffer& buffer);

} // namespace ssrlab
