// Hard cases, family "surface": what stands in the picture.
#include "check/hard_case.h"

#include <cmath>
#include <random>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

std::optional<Expected> always_hits(const Setup&, const RayInput&) { return Expected{.status = TraceStatus::hit}; }
std::optional<Expected> never_hits(const Setup&, const RayInput& ray) { return Expected{.status = ray.end_status}; }

HardCase one_pixel_poles()
{
    return {.name   = "one_pixel_poles",
            .breaks = "a step longer than a pixel passes them",
            .answer = "Poles at Z = 4, rays at Z = 5 (constant): hit iff the thickness reaches 1 m. Vertical, "
                      "horizontal and dotted (every third pixel).",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const double thickness : {0.99, 1.01}) {
                        Setup setup{fmt::format("thickness {} m", thickness),
                                    picture_of(bench_view({95, 61}),
                                               [](glm::ivec2 p) {
                                                   return p.x == 20 || p.y == 40 || (p.x == 70 && p.y % 3 == 0) ? 4.0
                                                                                                                : 10.0;
                                               }),
                                    boxes({.thickness_m = thickness, .max_distance_m = 100}),
                                    {}};
                        for (int y = 0; y < 61; ++y)
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {90.5, y + 0.5}, {-90.5, 0}, 5));
                        for (int x = 0; x < 95; ++x)
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {x + 0.5, 5.5}, {0, 55.5}, 5));
                        setups.push_back(setup);
                    }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                if (setup.settings.thickness_m < 1) return Expected{.status = ray.end_status};
                const glm::ivec2 p = ray.pixel;
                if (ray.delta_px_depth.x < 0)
                    return Expected{.pixel = p.y == 40 ? glm::ivec2(89, 40) : glm::ivec2(p.y % 3 == 0 ? 70 : 20, p.y)};
                return Expected{.pixel = glm::ivec2(p.x, p.x == 20 || p.x == 70 ? 6 : 40)};
            }};
}

HardCase watertight_walls()
{
    return {
        .name   = "watertight_walls",
        .breaks = "a ray slips through a wall one pixel thick where it crosses a corner",
        .answer =
            "Every ray crosses the wall: a row, a column, a staircase whose steps share sides. No ray gets through.",
        .setups =
            [] {
                std::vector<Setup> setups;
                for (const std::string kind : {"row", "column", "staircase"}) {
                    const auto wall = [=](glm::ivec2 p) {
                        return kind == "row"      ? p.y == 100
                               : kind == "column" ? p.x == 100
                                                  : p.x + p.y == 200 || p.x + p.y == 201;
                    };
                    Setup                                  setup{kind,
                                picture_of(bench_view({201, 201}), [=](glm::ivec2 p) { return wall(p) ? 4.0 : 0.0; }),
                                bench,
                                {}};
                    std::mt19937                           random(7);
                    std::uniform_real_distribution<double> low(1, 98), high(103, 200), any(1, 200);
                    for (int i = 0; i < 4000; ++i) {
                        const double a = low(random), b = low(random), c = high(random), d = high(random);
                        glm::dvec2   from(any(random), a), to(any(random), c);
                        if (kind == "column") from = {a, any(random)}, to = {c, any(random)};
                        if (kind == "staircase") from = {a, b}, to = {c, d};
                        if (i % 2 == 1) std::swap(from, to);
                        setup.rays.push_back(level_ray(setup.gbuffer.view, from, to - from, 4.5));
                    }
                    setups.push_back(setup);
                }
                return setups;
            },
        .expected = always_hits};
}

HardCase depth_discontinuity()
{
    return {.name   = "depth_discontinuity",
            .breaks = "the ray's interval spans the gap between two surfaces",
            .answer = "Columns right of 32 at Z = 2, the rest at 10; thickness 1. Along a row: at Z = 1.5 in front of "
                      "all, leaves; at 2.5 hits (33, 20) at its border; at 5 passes behind, leaves.",
            .setups =
                [] {
                    Setup setup{
                        {}, picture_of(bench_view(), [](glm::ivec2 p) { return p.x > 32 ? 2.0 : 10.0; }), bench, {}};
                    for (const double z : {1.5, 2.5, 5.0})
                        setup.rays.push_back(level_ray(setup.gbuffer.view, {10.5, 20.5}, {53.5, 0}, z));
                    return std::vector{setup};
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const double z = depth_to_distance(setup.gbuffer.view, ray.origin_px_depth.z);
                if (z < 2 || z > 4) return Expected{.status = ray.end_status};
                return Expected{.pixel = glm::ivec2(33, 20), .t = 22.5 / 53.5};
            }};
}

HardCase sphere_on_floor()
{
    return {.name   = "sphere_on_floor",
            .breaks = "rays of a few pixels at the contact point; the underside is hidden",
            .answer = "The screen truth. On the axis, floor rows 41.5, 45.5 and 50.5 reflect the sphere's rows 37.358, "
                      "34.325 and 29.253 (sphere of radius 1 at (0, 0, -5), floor at -1).",
            .setups =
                [] {
                    return std::vector{
                        Setup{{},
                              picture_of(bench_view({65, 64}), {sphere({0, 0, -5}, 1), plane({0, -1, 0}, {0, 1, 0})}),
                              bench,
                              {}}};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                if (ray.pixel.x != 32) return std::nullopt;
                // One depth per pixel: rows where the sphere's slope moves the hit into the next row are left to the truth.
                if (ray.pixel.y == 45) return Expected{.pixel = glm::ivec2(32, 34)};
                if (ray.pixel.y == 50) return Expected{.pixel = glm::ivec2(32, 29)};
                return std::nullopt;
            }};
}

HardCase convex_mirror()
{
    return {.name   = "convex_mirror",
            .breaks = "neighbouring pixels stand in front of the tangent ray: self-intersection",
            .answer = "A convex body does not reflect itself: no hit from any of its pixels.",
            .setups =
                [] {
                    return std::vector{Setup{{},
                                             picture_of(bench_view({128, 128}), {sphere({0, 0, -3}, 1.5)}),
                                             boxes({.thickness_m = 0.1, .max_distance_m = 100}),
                                             {}}};
                },
            .expected = never_hits};
}

HardCase floating_beam()
{
    return {.name   = "floating_beam",
            .breaks = "what lies behind a thin object is unknown: stopping there loses the rest of the picture, an "
                      "infinite slab hangs a curtain from it",
            .answer =
                "The screen truth: a thin beam over a mirror floor before a wall; rays pass behind the beam and go on.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const double thickness : {0.05, 0.5, 3.0})
                    setups.push_back(
                        {fmt::format("thickness {} m", thickness),
                         picture_of(bench_view({128, 96}), {plane({0, -1, 0}, {0, 1, 0}), plane({0, 0, -10}, {0, 0, 1}),
                                                            box({-3, -0.1, -4.1}, {3, 0.1, -4})}),
                         boxes({.thickness_m = thickness, .max_distance_m = 100}),
                         {}});
                return setups;
            }};
}

HardCase contact_points()
{
    return {.name   = "contact_points",
            .breaks = "the hit lies in the pixel next to the start: offsets and first steps jump over it",
            .answer = "The screen truth: boxes standing on a mirror floor; their lowest row is reflected by the "
                      "floor's row below it.",
            .setups = [] {
                return std::vector{
                    Setup{{},
                          picture_of(bench_view({128, 96}),
                                     {plane({0, -1, 0}, {0, 1, 0}), box({-2, -1, -6}, {-1, 1, -5}),
                                      box({0.3, -1, -4}, {0.5, -0.4, -3.8}), box({1, -1, -9}, {3, 2, -7})}),
                          bench,
                          {}}};
            }};
}

HardCase plates_within_one_thickness()
{
    return {.name   = "plates_within_one_thickness",
            .breaks = "two surfaces share the slab: which one is reported must not depend on the search",
            .answer = "Plates at 4.0 (columns from 30) and 4.2 m (from 40), thickness 0.5: a ray that comes level at "
                      "4.3 hits the first one it meets, (30, 20).",
            .setups =
                [] {
                    Setup setup{
                        {},
                        picture_of(bench_view(), [](glm::ivec2 p) { return p.x >= 40   ? 4.2
                                                                           : p.x >= 30 ? 4.0
                                                                                       : 0.0; }),
                        boxes({.thickness_m = 0.5, .max_distance_m = 100}),
                        {}};
                    setup.rays = {level_ray(setup.gbuffer.view, {5.5, 20.5}, {58, 0}, 4.3)};
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(30, 20)};
            }};
}

} // namespace

CaseFamily surface_cases()
{
    return {"surface",
            {one_pixel_poles(), watertight_walls(), depth_discontinuity(), sphere_on_floor(), convex_mirror(),
             floating_beam(), contact_points(), plates_within_one_thickness()}};
}

} // namespace ssrlab
