// Further cameras that look everywhere, placed by the rays that are still open: where those went, and from where that
// can be seen.
#include "core/stopwatch.h"
#include "frame/passes/pass_helpers.h"
#include "sources/cube_rays.h"
#include "world/occupancy.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ssrlab {
namespace {

constexpr size_t most_samples    = 2000; // rays that are asked about each candidate
constexpr int    candidates_side = 7;    // candidates along each axis of the scene's bounds

/// Where a ray probably ends: in the first occupied cell behind what is clear of it.
struct Target {
    glm::dvec3 at_ws, toward_ws; // the side that the ray sees faces this way, unit
    size_t     ray;
};

std::vector<Target> targets_of(const Occupancy& grid, std::span<const OpenRay> rays)
{
    std::vector<Target> targets;
    const size_t        step   = std::max<size_t>(1, rays.size() / most_samples);
    const double        cell_m = std::max({grid.cell_m.x, grid.cell_m.y, grid.cell_m.z});
    for (size_t k = 0; k < rays.size(); k += step) {
        const OpenRay& ray = rays[k];
        // The reflecting surface itself lies in the first cell.
        const double from_m = std::max(ray.clear_m, 1.5 * cell_m);
        const double met_m  = first_occupied(grid, ray.origin_ws, ray.direction_ws, from_m, ray.reach_m);
        if (std::isfinite(met_m)) targets.push_back({ray.origin_ws + met_m * ray.direction_ws, -ray.direction_ws, k});
    }
    return targets;
}

/// Does a camera probably see a target, and from the side that the ray saw?
bool probably_sees(const Occupancy& grid, glm::dvec3 eye_ws, const Target& target)
{
    const glm::dvec3 to_eye = eye_ws - target.at_ws;
    const double     away_m = glm::length(to_eye), cell_m = std::max({grid.cell_m.x, grid.cell_m.y, grid.cell_m.z});
    if (away_m < cell_m || glm::dot(to_eye, target.toward_ws) <= 0.2 * away_m) return false;
    return !may_meet(grid, target.at_ws, to_eye / away_m, 2 * cell_m, away_m);
}

/// Places that are not inside of something, evenly over the grid.
std::vector<glm::dvec3> candidates(const Occupancy& grid)
{
    std::vector<glm::dvec3> places;
    const glm::dvec3        size = grid.cell_m * glm::dvec3(grid.cells);
    for (int z = 0; z < candidates_side; ++z)
        for (int y = 0; y < candidates_side; ++y)
            for (int x = 0; x < candidates_side; ++x) {
                const glm::dvec3 at = grid.low_ws + size * (glm::dvec3(x, y, z) + 0.5) / double(candidates_side);
                if (!may_meet(grid, at, {1, 0, 0}, 0, 0)) places.push_back(at);
            }
    return places;
}

/// The place that sees most of what no place before it sees; those are removed from the targets. Empty when none sees
/// any.
std::optional<glm::dvec3> best_place(const Occupancy& grid, std::span<const glm::dvec3> places,
                                     std::vector<Target>& targets)
{
    std::optional<glm::dvec3> best;
    size_t                    most = 0;
    for (const glm::dvec3& place : places) {
        const auto seen = static_cast<size_t>(
            std::ranges::count_if(targets, [&](const Target& target) { return probably_sees(grid, place, target); }));
        if (seen <= most) continue;
        most = seen;
        best = place;
    }
    if (best) std::erase_if(targets, [&](const Target& target) { return probably_sees(grid, *best, target); });
    return best;
}

View view_from(const View& frame, glm::dvec3 eye_ws)
{
    View view             = frame;
    view.world_to_view[3] = glm::dvec4(glm::dmat3(frame.world_to_view) * -eye_ws, 1);
    return view;
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    if (!context.occupancy) context.occupancy = std::make_shared<const Occupancy>(make_occupancy(context.stage.scene));
    const Occupancy& grid = *context.occupancy;
    SourceTurn       turn;
    for (const OpenRay& ray : rays) turn.answers.push_back({.kind = AnswerKind::open, .clear_m = ray.clear_m});
    const Stopwatch               placing;
    const std::vector<glm::dvec3> places  = candidates(grid);
    std::vector<Target>           targets = targets_of(grid, rays);
    std::vector<glm::dvec3>       eyes;
    for (int view = 0; view < static_cast<int>(context.parameters.at("count")); ++view)
        if (const auto place = best_place(grid, places, targets)) eyes.push_back(*place);
    turn.merge_ms = 1000 * placing.seconds();
    for (const glm::dvec3& eye_ws : eyes) {
        CubeOfFrames cube{view_from(context.image.view, eye_ws), static_cast<int>(context.parameters.at("size_px"))};
        ask_elsewhere(context, rays, turn.answers,
                      [&](const TraceSettings& settings, RayStart start, std::span<const OpenRay> open) {
                          return trace_in_cube(context, cube, settings, start, open, turn);
                      });
    }
    return turn;
}

} // namespace

Source views_source()
{
    return {.id         = "views",
            .summary    = "Further cameras that look everywhere, placed by where the open rays went",
            .parameters = {integer_parameter("count", 1, 1, 8, "cameras"),
                           integer_parameter("size_px", 512, 16, 4096, "width and height of each of a camera's faces")},
            .answer     = answer};
}

} // namespace ssrlab
