#include "world/occupancy.h"

#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double slack    = 1e-3; // of a cell: wider than any rounding of a place in the grid

size_t cell_index(const Occupancy& grid, glm::ivec3 cell)
{
    return (size_t(cell.z) * size_t(grid.cells.y) + size_t(cell.y)) * size_t(grid.cells.x) + size_t(cell.x);
}

bool is_occupied(const Occupancy& grid, glm::ivec3 cell)
{
    const size_t index = cell_index(grid, cell);
    return (grid.occupied[index / 32] >> index % 32 & 1U) != 0;
}

void occupy(Occupancy& grid, glm::ivec3 cell)
{
    const size_t index = cell_index(grid, cell);
    grid.occupied[index / 32] |= 1U << index % 32;
}

bool all_finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// The three edges of a triangle seen along one axis, against unit squares.
struct FlatEdges {
    int        u = 0, v = 0;      // the other axes
    glm::dvec2 inward[3]{};       // normals of the edges
    double     farthest_out[3]{}; // of the centre of a square that touches, times the length of the normal
    bool       known = false;     // false: seen from the side, the triangle has no inside

    FlatEdges(const glm::dvec3 (&corners)[3], glm::dvec3 normal, int axis) : u((axis + 1) % 3), v((axis + 2) % 3)
    {
        known = normal[axis] != 0;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 from = corners[k], along = corners[(k + 1) % 3] - from;
            inward[k]       = (normal[axis] > 0 ? 1.0 : -1.0) * glm::dvec2(-along[v], along[u]);
            farthest_out[k] = glm::dot(inward[k], glm::dvec2(from[u], from[v])) -
                              (0.5 + slack) * (std::abs(inward[k].x) + std::abs(inward[k].y));
        }
    }
    bool may_touch(glm::dvec3 centre) const
    {
        if (!known) return true;
        for (int k = 0; k < 3; ++k)
            if (glm::dot(inward[k], glm::dvec2(centre[u], centre[v])) < farthest_out[k]) return false;
        return true;
    }
};

/// Marks the cells that a triangle touches, its corners in units of cells: column by column along the axis that it faces
/// most (M. Schwarz, H.-P. Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs").
void mark(Occupancy& grid, const glm::dvec3 (&corners)[3])
{
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]), size = glm::abs(normal);
    if (normal == glm::dvec3(0)) return; // no area: nothing meets it
    const glm::dvec3 low  = glm::min(glm::min(corners[0], corners[1]), corners[2]) - slack;
    const glm::dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]) + slack;
    const glm::ivec3 last = grid.cells - 1, first = glm::clamp(glm::ivec3(glm::floor(low)), glm::ivec3(0), last),
                     end   = glm::clamp(glm::ivec3(glm::floor(high)), glm::ivec3(0), last);
    const FlatEdges seen[] = {{corners, normal, 0}, {corners, normal, 1}, {corners, normal, 2}};
    const int       axis   = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int       u = seen[axis].u, v = seen[axis].v;
    const double    reach = (0.5 + slack) * (size[u] + size[v]) / size[axis] + slack; // of the plane in a column
    glm::ivec3      cell;
    for (cell[v] = first[v]; cell[v] <= end[v]; ++cell[v])
        for (cell[u] = first[u]; cell[u] <= end[u]; ++cell[u]) {
            glm::dvec3 centre = glm::dvec3(cell) + 0.5;
            if (!seen[axis].may_touch(centre)) continue;
            const double at =
                corners[0][axis] -
                (normal[u] * (centre[u] - corners[0][u]) + normal[v] * (centre[v] - corners[0][v])) / normal[axis];
            const int top = std::min(end[axis], static_cast<int>(std::floor(at + reach)));
            for (cell[axis] = std::max(first[axis], static_cast<int>(std::floor(at - reach))); cell[axis] <= top;
                 ++cell[axis]) {
                centre[axis] = cell[axis] + 0.5;
                if (seen[(axis + 1) % 3].may_touch(centre) && seen[(axis + 2) % 3].may_touch(centre))
                    occupy(grid, cell);
            }
        }
}

} // namespace

Occupancy make_occupancy(const Scene& scene, int side)
{
    Occupancy  grid;
    glm::dvec3 low(infinity), high(-infinity);
    const auto corner = [&](const Draw& draw, uint32_t i) {
        return glm::dvec3(scene.vertices[scene.indices[draw.first_index + i]].position_ws);
    };
    for (const Draw& draw : scene.draws)
        for (uint32_t i = 0; i < draw.index_count; ++i) {
            if (!all_finite(corner(draw, i))) continue;
            low  = glm::min(low, corner(draw, i));
            high = glm::max(high, corner(draw, i));
        }
    if (!(low.x <= high.x)) return grid;
    // Not so flat that the rounding of a place, a share of the longest side, grows beyond the slack.
    const glm::dvec3 extent = glm::max(high - low, glm::dvec3(0.1 * glm::length(high - low) + 1e-9));
    grid.cells              = glm::ivec3(side);
    grid.cell_m             = extent * (1 + 1e-3) / double(side);
    grid.low_ws             = (low + high) / 2.0 - grid.cell_m * (double(side) / 2);
    grid.occupied.assign((size_t(side) * size_t(side) * size_t(side) + 31) / 32, 0);
    for (const Draw& draw : scene.draws)
        for (uint32_t i = 0; i + 2 < draw.index_count; i += 3) {
            glm::dvec3 corners[3];
            for (uint32_t k = 0; k < 3; ++k) corners[k] = (corner(draw, i + k) - grid.low_ws) / grid.cell_m;
            if (all_finite(corners[0]) && all_finite(corners[1]) && all_finite(corners[2])) mark(grid, corners);
        }
    return grid;
}

double across_cell_m(const Occupancy& grid, glm::dvec3 direction)
{
    const glm::dvec3 cells_per_m = glm::abs(direction) / grid.cell_m;
    return 1 / std::max({cells_per_m.x, cells_per_m.y, cells_per_m.z});
}

double first_occupied(const Occupancy& grid, glm::dvec3 origin_ws, glm::dvec3 direction_ws, double from_m, double to_m)
{
    if (grid.cells.x == 0) return infinity;
    const glm::dvec3 origin = (origin_ws - grid.low_ws) / grid.cell_m, rate = direction_ws / grid.cell_m;
    double           t = from_m, t_end = to_m;
    for (int axis : {0, 1, 2}) {
        const double size = grid.cells[axis];
        if (rate[axis] == 0) {
            if (origin[axis] < 0 || origin[axis] > size) return infinity;
            continue;
        }
        const double a = -origin[axis] / rate[axis], b = (size - origin[axis]) / rate[axis];
        t     = std::max(t, std::min(a, b));
        t_end = std::min(t_end, std::max(a, b));
    }
    if (!(t <= t_end)) return infinity;
    // From the cell of the first point on, across one border after another; the cells beside a point on a border hold
    // the slack.
    glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(origin + t * rate)), glm::ivec3(0), grid.cells - 1);
    while (true) {
        if (is_occupied(grid, cell)) return t;
        int    next_axis = 0;
        double next_t    = infinity;
        for (int axis : {0, 1, 2}) {
            if (rate[axis] == 0) continue;
            const double border = (double(cell[axis] + (rate[axis] > 0 ? 1 : 0)) - origin[axis]) / rate[axis];
            if (border < next_t) {
                next_t    = border;
                next_axis = axis;
            }
        }
        if (!(next_t <= t_end)) return infinity;
        t = std::max(t, next_t);
        cell[next_axis] += rate[next_axis] > 0 ? 1 : -1;
        if (cell[next_axis] < 0 || cell[next_axis] >= grid.cells[next_axis]) return infinity;
    }
}

std::vector<glm::dvec3> free_places(const Occupancy& grid, glm::dvec3 low_ws, glm::dvec3 high_ws, int side)
{
    std::vector<glm::dvec3> places;
    for (int z = 0; z < side; ++z)
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const glm::dvec3 at = low_ws + (high_ws - low_ws) * (glm::dvec3(x, y, z) + 0.5) / double(side);
                if (!may_meet(grid, at, {1, 0, 0}, 0, 0)) places.push_back(at);
            }
    return places;
}

bool may_meet(const Occupancy& grid, glm::dvec3 origin_ws, glm::dvec3 direction_ws, double from_m, double to_m)
{
    return first_occupied(grid, origin_ws, direction_ws, from_m, to_m) < infinity;
}

} // namespace ssrlab
