// The grid of occupied cells on the device: how far rays go through empty cells.
#pragma once

#include "world/occupancy.h"
#include "world/world.h"

#include <array>

namespace ssrlab {

/// A grid, and on the device which of its cells and blocks of cells are occupied: a bit each, x fastest, then y.
/// A block of a level is 4 blocks of the level below wide; level 0 are the cells.
inline constexpr size_t grid_levels = 4; // GRID_LEVELS of shaders/world/grid_walk.comp
struct DeviceGrid {
    Occupancy                         grid;
    Buffer                            occupied;
    std::array<uint32_t, grid_levels> first_words{}; // of each level
};
DeviceGrid upload_grid(Gpu& gpu, Occupancy grid);

struct GridWalk {
    std::vector<float> met_m;  // of each ray: along its direction, where it is first in an occupied cell; +inf: nowhere
    double             ms = 0; // of the device
};

/// Walks rays of unit direction through the grid, from t_min to t_max. No ray meets geometry before met_m.
GridWalk walk_grid(Gpu& gpu, const DeviceGrid& grid, std::span<const WorldRay> rays);

} // namespace ssrlab
