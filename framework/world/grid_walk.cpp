#include "world/grid_walk.h"

#include "gpu/timed_run.h"

#include <bit>
#include <limits>

namespace ssrlab {
namespace {

constexpr size_t level_bits = 2; // LEVEL_BITS of the shader

/// shaders/world/grid_walk.comp, scalar layout.
struct GridPush {
    glm::vec3                         low_ws;
    glm::vec3                         cells_per_m;
    glm::ivec3                        cells;
    std::array<uint32_t, grid_levels> first_words;
};

/// The blocks of a level that hold an occupied cell.
std::vector<uint32_t> occupied_blocks(const Occupancy& grid, size_t level)
{
    const int             shift  = static_cast<int>(level_bits * level);
    const glm::ivec3      blocks = ((grid.cells - 1) >> shift) + 1;
    std::vector<uint32_t> bits((size_t(blocks.x) * size_t(blocks.y) * size_t(blocks.z) + 31) / 32);
    for (size_t word = 0; word < grid.occupied.size(); ++word)
        for (uint32_t left = grid.occupied[word]; left != 0; left &= left - 1) {
            const size_t cell = 32 * word + size_t(std::countr_zero(left));
            const auto   x = cell % size_t(grid.cells.x), y = cell / size_t(grid.cells.x) % size_t(grid.cells.y),
                       z       = cell / size_t(grid.cells.x) / size_t(grid.cells.y);
            const size_t block = ((z >> shift) * size_t(blocks.y) + (y >> shift)) * size_t(blocks.x) + (x >> shift);
            bits[block / 32] |= 1U << block % 32;
        }
    return bits;
}

} // namespace

DeviceGrid upload_grid(Gpu& gpu, Occupancy grid)
{
    DeviceGrid            device;
    std::vector<uint32_t> words;
    for (size_t level = 0; level < grid_levels; ++level) {
        const std::vector<uint32_t> bits = occupied_blocks(grid, level);
        device.first_words[level]        = static_cast<uint32_t>(words.size());
        words.insert(words.end(), bits.begin(), bits.end());
    }
    device.occupied = make_buffer_with<uint32_t>(gpu, words);
    device.grid     = std::move(grid);
    return device;
}

GridWalk walk_grid(Gpu& gpu, const DeviceGrid& device, std::span<const WorldRay> rays)
{
    const Occupancy& grid = device.grid;
    GridWalk         walk;
    walk.met_m.assign(rays.size(), std::numeric_limits<float>::infinity());
    if (rays.empty() || grid.cells.x == 0) return walk;
    const WorldRayList list = make_ray_list(gpu, rays);
    const Buffer       met  = make_buffer(gpu, rays.size() * sizeof(float));
    const ComputePass  pass = make_compute_pass(
         gpu, compile_shader(gpu, {.file = "world/grid_walk.comp"}),
         {{"Occupied", device.occupied}, {"WorldRays", list.rays}, {"WorldLaunch", list.launch}, {"MetDistances", met}},
         {}, sizeof(GridPush));
    const GridPush values{glm::vec3(grid.low_ws), glm::vec3(1.0 / grid.cell_m), grid.cells, device.first_words};
    walk.ms    = time_second_run_ms(gpu, [&](const Commands& commands) {
        push(commands, pass, values);
        dispatch_indirect(commands, pass, list.launch);
    });
    walk.met_m = download_as<float>(gpu, met, rays.size());
    return walk;
}

} // namespace ssrlab
