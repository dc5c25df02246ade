// Depth in the layout that tracers read, with two words for each cell of the levels above it. Folder-internal.
#pragma once

#include "gpu/compute.h"

#include <span>
#include <vector>

namespace ssrlab {

/// Returns the number of levels above level 0, the pixels: levels are added until one row of cells is left.
int pyramid_levels(glm::ivec2 size_px);
/// Returns the row of the buffer where level 0 begins; level L begins at that row >> L (shaders/layout/shared.h).
int pyramid_root(glm::ivec2 size_px);
/// Returns the size of the buffer that holds all levels, in cells, rounded up to whole strips.
glm::ivec2 pyramid_size(glm::ivec2 size_px);
/// Returns the index of the cell of `level` that contains `pixel`; at level 0, of the pair of pixels.
size_t cell_index(glm::ivec2 size_px, glm::ivec2 pixel, int level);
/// Returns the number of cells of a level in x and y.
glm::ivec2 level_size(glm::ivec2 size_px, int level);

/// Depths as level 0 and the cells above them, in strips, followed by the depth and plane of each pixel
/// (shaders/layout/cell_places.glsl, plane_places.glsl).
struct DepthBuffer {
    glm::ivec2           size_px{0, 0};
    Buffer               cells;              // as texels: both words of a cell, or the depths of two pixels
    vk::raii::BufferView words    = nullptr; // as texels: each word
    vk::raii::BufferView pairs    = nullptr; // as texels: two cells, or four pixels
    uint64_t             cells_id = 0;       // of the cells above the pixels, which structures store
};

/// Returns it by the names under which shaders read depths and cells and store cells.
Bindings depth_bindings(const DepthBuffer& depth);

/// Returns the bytes of `cells`.
size_t depth_buffer_bytes(glm::ivec2 size_px);
/// Returns a buffer with undefined content.
DepthBuffer make_depth_buffer(Gpu& gpu, glm::ivec2 size_px);
/// Writes depths, row-major. `gradients`: one per pixel, packed (core/plane_gradient.h); empty: level planes.
void write_depth(Gpu& gpu, DepthBuffer& buffer, std::span<const float> depth, std::span<const uint32_t> gradients);
std::vector<float> read_depth(Gpu& gpu, const DepthBuffer& buffer);

} // namespace ssrlab
