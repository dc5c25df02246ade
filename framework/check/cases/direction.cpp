// Hard cases, family "direction": where rays go.
#include "check/hard_case.h"
#include "core/pixel_index.h"

#include <cmath>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

std::optional<Expected> never_hits(const Setup&, const RayInput& ray) { return Expected{.status = ray.end_status}; }

/// A floor whose normals turn the mirror ray of every pixel into `direction`.
Setup floor_reflecting_to(glm::dvec3 direction, const TraceSettings& settings)
{
    Setup setup{{}, picture_of(bench_view(), {plane({0, -1, 0}, {0, 1, 0})}), settings, {}};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if (setup.gbuffer.depth[pixel_index({x, y}, setup.gbuffer.view.size_px)] > 0)
                reflect_to(setup.gbuffer, {x, y}, direction);
    return setup;
}

Relation farther(double max_distance_m)
{
    return {.name = fmt::format("with the maximum distance {} m", max_distance_m), .change = [=](Setup setup) {
                setup.settings.max_distance_m = max_distance_m;
                return setup;
            }};
}

HardCase along_the_view_axis()
{
    return {
        .name   = "along_the_view_axis",
        .breaks = "the ray never moves on screen: 0/0 in the border's t, 1/0 for a dominant axis, endless loops",
        .answer = "Visits nothing: its end status after at most one iteration. Also where rounding leaves a millionth "
                  "of a pixel of motion.",
        .setups =
            [] {
                Setup setup{{}, picture_of(bench_view(), [](glm::ivec2) { return 10.0; }), bench, {}};
                for (const double drift : {0.0, -0.0, 1e-7, -1e-7, 1e-6, -1e-6, 1e-30, -1e-30})
                    for (const glm::dvec2& at : {glm::dvec2(31.5, 31.5), glm::dvec2(0.5, 0.5), glm::dvec2(63.5, 20.5)})
                        setup.rays.push_back(rounded_to_float(
                            {{at, 0.01}, {drift, -drift, -0.005}, 10, TraceStatus::past_max_distance, glm::ivec2(at)}));
                return std::vector{setup};
            },
        .expected   = never_hits,
        .most_steps = [](const Setup&) { return 1; }};
}

HardCase toward_the_camera()
{
    return {.name   = "toward_the_camera",
            .breaks = "distance falls toward 0 along the ray, its projection runs to infinity",
            .answer = "A mirror across the view axis at Z = 10 sends every ray back: with a = X/Z the ray of pixel "
                      "(48.5, 32.5) leaves the right border at "
                      "s = (1 - a) / (1 + a) of the way, y = 32 + 0.5 / 16.5 * 32.",
            .setups =
                [] {
                    return std::vector{Setup{{}, picture_of(bench_view(), {plane({0, 0, -10}, {0, 0, 1})}), bench, {}}};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                Expected expected{.status = TraceStatus::left_screen};
                if (ray.pixel == glm::ivec2(48, 32)) expected.end_px = {64, 32 + 0.5 / 16.5 * 32};
                return expected;
            }};
}

HardCase through_the_near_plane()
{
    return {.name   = "through_the_near_plane",
            .breaks = "division by a distance of 0 or less; the end point is mirrored through the eye and the march "
                      "runs backwards",
            .answer =
                "Clipped at the near plane: the same bits whatever the maximum distance beyond it, infinity included.",
            .setups =
                [] {
                    return std::vector{
                        floor_reflecting_to({0, 0.1, 0.99498744}, boxes({.thickness_m = 1, .max_distance_m = 1000}))};
                },
            .relations = {farther(1e6), farther(3.4028234e38), farther(INFINITY)}};
}

HardCase behind_the_eye()
{
    return {.name   = "behind_the_eye",
            .breaks = "the end point lies behind the eye: its w is negative and both screen coordinates change sign",
            .answer = "As above, for rays that also move sideways.",
            .setups =
                [] {
                    return std::vector{
                        floor_reflecting_to({0.3, 0.05, 0.95}, boxes({.thickness_m = 1, .max_distance_m = 1000}))};
                },
            .relations = {farther(1e6), farther(INFINITY)}};
}

HardCase to_infinity()
{
    return {.name   = "to_infinity",
            .breaks = "infinity times 0, an end point at depth 0, t that underflows",
            .answer = "Ends at the vanishing point of its direction, 32 + 32 * 0.3 / 0.93273791 to the right and 32 * "
                      "0.2 / 0.93273791 up, and finds there what "
                      "stands on the way: the screen truth, for any maximum distance.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const double distance : {1e6, 1e9, 1e30, static_cast<double>(INFINITY)}) {
                        setups.push_back(floor_reflecting_to({0.3, 0.2, -0.93273791},
                                                             boxes({.thickness_m = 1, .max_distance_m = distance})));
                        setups.back().label = fmt::format("{} m", distance);
                        for (size_t post = 10 * 64 + 40; post < 30 * 64; post += 64) {
                            setups.back().gbuffer.depth[post]    = 0.01F;
                            setups.back().gbuffer.metallic[post] = 0;
                        }
                    }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput&) -> std::optional<Expected> {
                if (setup.settings.max_distance_m < 1e9) return std::nullopt;
                return Expected{.status = std::nullopt,
                                .end_px = glm::dvec2(32 + 32 * 0.3 / 0.93273791, 32 - 32 * 0.2 / 0.93273791)};
            }};
}

HardCase parallel_to_the_image()
{
    return {.name   = "parallel_to_the_image",
            .breaks = "depth does not change along the ray: v / v.z is infinite, 1 / dz too",
            .answer = "Columns left of 16 stand at Z = 2, the rest at 10; the ray runs left at Z = 5 from (48.5, 20.5) "
                      "by 48 px. With 3 m of thickness it hits column 15 at "
                      "t = 32.5 / 48; with 1 m it passes behind and leaves.",
            .setups =
                [] {
                    const View         view = bench_view();
                    std::vector<Setup> setups;
                    for (const double thickness : {3.5, 1.0}) {
                        const TraceSettings settings = boxes({.thickness_m = thickness, .max_distance_m = 100});
                        setups.push_back({fmt::format("thickness {} m", thickness),
                                          picture_of(view, [](glm::ivec2 p) { return p.x < 16 ? 2.0 : 10.0; }),
                                          settings,
                                          {level_ray(view, {48.5, 20.5}, {-48, 0}, 5)}});
                    }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput&) -> std::optional<Expected> {
                if (setup.settings.thickness_m < 3) return Expected{.status = TraceStatus::left_screen};
                return Expected{.pixel = glm::ivec2(15, 20), .t = 32.5 / 48};
            }};
}

HardCase objects_before_a_mirror()
{
    return {.name   = "objects_before_a_mirror",
            .breaks = "rays come toward the camera: a nearest-only pyramid skips nothing, tests that assume growing "
                      "distance fail",
            .answer = "The screen truth; a tilted mirror behind a ball and a post.",
            .setups = [] {
                return std::vector{Setup{
                    {},
                    picture_of(bench_view({97, 61}), {plane({0, 0, -10}, glm::normalize(glm::dvec3(0.2, 0.3, 1))),
                                                      sphere({0.5, 0.3, -5}, 1), box({-2, -3, -6}, {-1.8, 3, -5.8})}),
                    boxes({.thickness_m = 2, .max_distance_m = 100}),
                    {}}};
            }};
}

HardCase grazing()
{
    return {.name   = "grazing",
            .breaks = "the ray stays within one depth step of its own surface for many pixels: self-intersection",
            .answer = "A floor alone reflects nothing. On screen the floor's depth falls by k a pixel and its mirror "
                      "ray's by k/2 (both are linear in the row), so the ray is in front of every "
                      "later row, with k/4 to spare at the first.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const double height : {1.0, 1e-2, 1e-4})
                        setups.push_back({fmt::format("eye {} m above the floor", height),
                                          picture_of(bench_view({64, 256}, 1e-5), {plane({0, -height, 0}, {0, 1, 0})}),
                                          boxes({.thickness_m = 1, .max_distance_m = 1000}),
                                          {}});
                    return setups;
                },
            .expected = never_hits};
}

HardCase steep_in_depth()
{
    return {.name   = "steep_in_depth",
            .breaks = "the whole depth range passes within a few pixels; samples fall through",
            .answer = "The interval of a pixel holds every depth between its ends: hit in the first visited pixel, "
                      "(33, 32), where the surface's depth 0.5 lies inside 0.65 … 0.05.",
            .setups =
                [] {
                    const View view = bench_view();
                    Setup      setup{{},
                                picture_of(view, [](glm::ivec2) { return 0.2; }),
                                boxes({.thickness_m = 1e-4, .max_distance_m = 100}),
                                {}};
                    setup.rays = {
                        rounded_to_float({{32.5, 32.5, 0.95}, {1.5, 0, -0.9}, 1, TraceStatus::left_screen, {32, 32}})};
                    return std::vector{setup};
                },
            // From (32.5) with depth 0.95 - 0.6 per pixel: enters 33 at 0.65, reaches 0.5 at t = 0.5.
            .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(33, 32), .t = 0.5};
            }};
}

HardCase rising_level_falling()
{
    return {.name   = "rising_level_falling",
            .breaks = "the two ends of a pixel's depth interval come in either order",
            .answer = "A wall at Z = 2 right of column 40: rays at its depth, approaching from the front or from "
                      "behind within its thickness, hit (40, 20); all three at its border, t = 20 / 30.",
            .setups =
                [] {
                    const View view = bench_view();
                    Setup      setup{{},
                                picture_of(view, [](glm::ivec2 p) { return p.x >= 40 ? 2.0 : 0.0; }),
                                boxes({.thickness_m = 3, .max_distance_m = 100}),
                                {}};
                    for (const auto& [from, to] : {std::pair(2.5, 3.5), std::pair(3.0, 3.0), std::pair(3.5, 2.5)})
                        setup.rays.push_back(ray_between(view, {20.0 + 0.25, 20.5, from}, {50.25, 20.5, to}));
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(40, 20), .t = 19.75 / 30};
            }};
}

} // namespace

CaseFamily direction_cases()
{
    return {"direction",
            {along_the_view_axis(), toward_the_camera(), through_the_near_plane(), behind_the_eye(), to_infinity(),
             parallel_to_the_image(), objects_before_a_mirror(), grazing(), steep_in_depth(), rising_level_falling()}};
}

} // namespace ssrlab
