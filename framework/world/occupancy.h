// A coarse grid of the cells that hold geometry: a ray through empty cells meets nothing.
#pragma once

#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace ssrlab {

struct Occupancy {
    glm::dvec3            low_ws{0}; // of the grid, a little outside of the scene
    glm::dvec3            cell_m{1};
    glm::ivec3            cells{0}; // along each axis; 0: the scene has no triangles
    std::vector<uint32_t> occupied; // a bit a cell, x fastest, then y
};

/// Returns the grid, with `side` cells along each axis. Conservative: a cell is empty only if no triangle comes nearer
/// to it than a thousandth of a cell. Floats round the places of a ray by less (shaders/world/grid_walk.comp).
Occupancy make_occupancy(const Scene& scene, int side = 512);

/// Returns how far a point moves along a unit direction from one side of a cell to the opposite one.
double across_cell_m(const Occupancy& grid, glm::dvec3 direction);

/// Returns the middles of side³ equal parts of a box that lie in empty cells of the grid.
std::vector<glm::dvec3> free_places(const Occupancy& grid, glm::dvec3 low_ws, glm::dvec3 high_ws, int side);

/// Returns whether a ray may meet geometry between two distances along a direction: never false where it does. to_m may
/// be +inf.
bool may_meet(const Occupancy& grid, glm::dvec3 origin_ws, glm::dvec3 direction_ws, double from_m, double to_m);

/// Returns how far along the direction a ray first is in a cell that holds geometry, at least from_m; +inf: nowhere up
/// to to_m.
double first_occupied(const Occupancy& grid, glm::dvec3 origin_ws, glm::dvec3 direction_ws, double from_m, double to_m);

} // namespace ssrlab
