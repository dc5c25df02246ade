// Further cameras that look everywhere, placed by the rays that are still open: where those went, and from where that
// can be seen.
#include "core/error.h"
#include "core/stopwatch.h"
#include "frame/passes/pass_helpers.h"
#include "sources/cube_rays.h"
#include "world/grid_walk.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ssrlab {
namespace {

constexpr size_t most_samples    = 1000; // rays that are asked about each candidate
constexpr int    candidates_side = 7;    // candidates along each axis of the bounds of these rays

/// Where a ray probably ends: in the first occupied cell behind what is clear of it.
struct Target {
    glm::dvec3 at_ws, toward_ws; // the side that the ray sees faces this way, unit
    size_t     ray;
};

std::vector<Target> targets_of(const Occupancy& grid, std::span<const OpenRay> rays)
{
    std::vector<Target> targets;
    const size_t        step = std::max<size_t>(1, rays.size() / most_samples);
    for (size_t k = 0; k < rays.size(); k += step) {
        const OpenRay& ray = rays[k];
        // The reflecting surface itself lies in the first cell.
        const double from_m = std::max(ray.clear_m, 1.5 * across_cell_m(grid, ray.direction_ws));
        const double met_m  = first_occupied(grid, ray.origin_ws, ray.direction_ws, from_m, ray.reach_m);
        if (std::isfinite(met_m)) targets.push_back({ray.origin_ws + met_m * ray.direction_ws, -ray.direction_ws, k});
    }
    return targets;
}

/// Does a camera probably see a target, and from the side that the ray saw?
bool probably_sees(const Occupancy& grid, glm::dvec3 eye_ws, const Target& target)
{
    const glm::dvec3 to_eye = eye_ws - target.at_ws;
    const double     away_m = glm::length(to_eye), cell_m = across_cell_m(grid, to_eye / away_m);
    if (!(away_m >= cell_m) || glm::dot(to_eye, target.toward_ws) <= 0.2 * away_m) return false;
    return !may_meet(grid, target.at_ws, to_eye / away_m, 2 * cell_m, away_m);
}

/// The place that sees most of what no place before it sees; those are removed from the targets. Empty when none sees
/// any.
std::optional<glm::dvec3> best_place(const Occupancy& grid, std::span<const glm::dvec3> places,
                                     std::vector<Target>& targets)
{
    std::optional<glm::dvec3> best;
    size_t                    most = 0;
    for (const glm::dvec3& place : places) {
        size_t seen = 0, left = targets.size();
        for (const Target& target : targets) {
            if (seen + left-- <= most) break; // it cannot become the best
            seen += probably_sees(grid, place, target);
        }
        if (seen <= most) continue;
        most = seen;
        best = place;
    }
    if (best) std::erase_if(targets, [&](const Target& target) { return probably_sees(grid, *best, target); });
    return best;
}

std::vector<glm::dvec3> placed_by_rays(const Occupancy& grid, std::span<const OpenRay> rays, size_t count)
{
    std::vector<Target>     targets = targets_of(grid, rays);
    std::vector<glm::dvec3> eyes_ws;
    if (targets.empty()) return eyes_ws;
    glm::dvec3 low_ws = targets[0].at_ws, high_ws = low_ws;
    for (const Target& target : targets)
        for (const glm::dvec3& end_ws : {target.at_ws, rays[target.ray].origin_ws}) {
            low_ws  = glm::min(low_ws, end_ws);
            high_ws = glm::max(high_ws, end_ws);
        }
    const std::vector<glm::dvec3> places = free_places(grid, low_ws, high_ws, candidates_side);
    for (size_t view = 0; view < count; ++view)
        if (const auto place = best_place(grid, places, targets)) eyes_ws.push_back(*place);
    return eyes_ws;
}

/// The first of the scene's cameras that stand elsewhere.
std::vector<glm::dvec3> placed_by_scene(const SourceContext& context, size_t count)
{
    constexpr double        elsewhere_m = 1e-6;
    std::vector<glm::dvec3> eyes_ws     = {glm::dvec3(glm::inverse(context.image.view.world_to_view)[3])};
    for (const Camera& camera : context.stage.scene.cameras) {
        const auto stands_there = [&](const glm::dvec3& eye_ws) {
            return glm::distance(eye_ws, glm::dvec3(camera.position_ws)) < elsewhere_m;
        };
        if (eyes_ws.size() <= count && std::ranges::none_of(eyes_ws, stands_there))
            eyes_ws.emplace_back(camera.position_ws);
    }
    eyes_ws.erase(eyes_ws.begin()); // the picture's own
    if (eyes_ws.size() < count)
        throw_failure("source 'views': place = scene needs {} cameras beside the picture's own; '{}' has {}", count,
                      context.stage.scene.name, eyes_ws.size());
    return eyes_ws;
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn turn;
    for (const OpenRay& ray : rays) turn.answers.push_back({.kind = AnswerKind::open, .clear_m = ray.clear_m});
    const auto                    count = static_cast<size_t>(context.parameters.at("count"));
    const Occupancy*              grid  = context.parameters.at("place") == 0 ? &grid_of(context.stage).grid : nullptr;
    const Stopwatch               placing;
    const std::vector<glm::dvec3> eyes = grid ? placed_by_rays(*grid, rays, count) : placed_by_scene(context, count);
    turn.merge_ms                      = 1000 * placing.seconds();
    for (const glm::dvec3& eye_ws : eyes) {
        CubeOfFrames cube{moved_to(context.image.view, eye_ws), static_cast<int>(context.parameters.at("size_px"))};
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
            .summary    = "Further cameras that look everywhere, placed by where the open rays went, or by hand",
            .parameters = {integer_parameter("count", 1, 1, 8, "cameras"),
                           choice_parameter({"place", "rays, scene"}, 0,
                                            "where they see most of what is open, or the scene's next cameras"),
                           integer_parameter("size_px", 512, 16, 4096, "width and height of each of a camera's faces")},
            .answer     = answer};
}

} // namespace ssrlab
