// Hard cases, family "depth": what stands in the depth buffer.
#include "check/hard_case.h"
#include "core/pixel_index.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

std::optional<Expected> never_hits(const Setup&, const RayInput& ray) { return Expected{.status = ray.end_status}; }

/// Rays from the left border across every row, at a constant distance.
void add_rows(Setup& setup, double distance_m)
{
    const glm::ivec2 size = setup.gbuffer.view.size_px;
    for (int y = 0; y < size.y; ++y)
        setup.rays.push_back(level_ray(setup.gbuffer.view, {0.5, y + 0.5}, {size.x - 0.5, 0}, distance_m));
}

float& depth_at(Setup& setup, glm::ivec2 p) { return setup.gbuffer.depth[pixel_index(p, setup.gbuffer.view.size_px)]; }

HardCase all_sky()
{
    return {.name   = "all_sky",
            .breaks = "the background's value compared as if it were a surface",
            .answer = "No hit, also for infinitely thick surfaces.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const double thickness : {1.0, static_cast<double>(INFINITY)}) {
                        setups.push_back({fmt::format("thickness {}", thickness),
                                          picture_of(bench_view({97, 64}), [](glm::ivec2) { return 0.0; }),
                                          boxes({.thickness_m = thickness, .max_distance_m = 100}),
                                          {}});
                        add_rows(setups.back(), 5);
                        // Ends at depth 0 exactly, where the background's depth would be.
                        setups.back().rays.push_back(rounded_to_float(
                            {{3.5, 3.5, 0.02}, {90, 50, -0.02}, INFINITY, TraceStatus::past_max_distance, {3, 3}}));
                    }
                    return setups;
                },
            .expected = never_hits};
}

HardCase one_object_in_the_sky()
{
    return {.name   = "one_object_in_the_sky",
            .breaks = "background in a cell of the pyramid hides or fakes what stands beside it",
            .answer = "A single pixel (40, 33) at Z = 4: the ray of row 33 hits it, no other does.",
            .setups =
                [] {
                    Setup setup{{},
                                picture_of(bench_view({97, 64}),
                                           [](glm::ivec2 p) { return p == glm::ivec2(40, 33) ? 4.0 : 0.0; }),
                                bench,
                                {}};
                    add_rows(setup, 4.5);
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                if (ray.pixel.y != 33) return Expected{.status = ray.end_status};
                return Expected{.pixel = glm::ivec2(40, 33), .t = 39.5 / 96.5};
            }};
}

HardCase unusable_texels()
{
    return {
        .name   = "unusable_texels",
        .breaks = "NaN compares false and makes min depend on the order; infinity gives NaN in the next step; negative "
                  "and > 1 mean nothing",
        .answer = "They are background: the same bits as with 0 in their place, at each of the four positions of a "
                  "pyramid cell, on the rays' way and off it.",
        .setups =
            [] {
                std::vector<Setup> setups;
                const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
                for (const auto& [name, value] : {std::pair("NaN", nan),
                                                  {"-NaN", -nan},
                                                  {"+inf", inf},
                                                  {"-inf", -inf},
                                                  {"-0", -0.0F},
                                                  {"-1", -1.0F},
                                                  {"5", 5.0F}}) {
                    Setup setup{name,
                                picture_of(bench_view({40, 16}), [](glm::ivec2 p) { return p.x == 38 ? 4.0 : 0.0; }),
                                bench,
                                {}};
                    for (const glm::ivec2& p :
                         {glm::ivec2(8, 4), glm::ivec2(17, 6), glm::ivec2(24, 9), glm::ivec2(31, 11)})
                        depth_at(setup, p) = value;
                    add_rows(setup, 4.5);
                    setups.push_back(setup);
                }
                return setups;
            },
        .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
            return Expected{.pixel = glm::ivec2(38, ray.pixel.y)};
        },
        .relations = {{.name = "with background instead", .change = [](Setup setup) {
                           for (float& depth : setup.gbuffer.depth)
                               if (!(depth > 0 && depth <= 1)) depth = 0;
                           return setup;
                       }}}};
}

HardCase tiny_depths()
{
    return {.name   = "tiny_depths",
            .breaks = "depths near the smallest float: denormals may be flushed to 0, products underflow",
            .answer = "Surfaces so far away are met by rays as far away or missed, as the screen truth says; nothing "
                      "becomes NaN. (Denormal depths may count as background: no ray of the case tests one.)",
            .setups =
                [] {
                    Setup setup{{},
                                picture_of(bench_view({40, 16}), [](glm::ivec2) { return 0.0; }),
                                boxes({.thickness_m = INFINITY, .max_distance_m = INFINITY}),
                                {}};
                    for (int y = 0; y < 16; ++y) {
                        depth_at(setup, {30, y}) = std::ldexp(1.0F, -20 - 6 * y); // 2^-20 … 2^-110
                        depth_at(setup, {20, y}) = y % 2 == 0 ? std::ldexp(1.0F, -140) : 0.0F;
                        const double depth       = std::ldexp(1.0, -20 - 6 * y);
                        setup.rays.push_back(rounded_to_float({{5.5, y + 0.5, 4 * depth},
                                                               {34, 0, -3.5 * depth},
                                                               INFINITY,
                                                               TraceStatus::past_max_distance,
                                                               {5, y}}));
                    }
                    return std::vector{setup};
                },
            // 4 - 3.5 t = 1 at t = 6/7, x = 34.6: in column 30, t = 24.5/34 … 25.5/34, the ray is still in front.
            .expected = never_hits};
}

HardCase far_and_infinitely_far()
{
    return {.name   = "far_and_infinitely_far",
            .breaks = "a wall at 100 km beside one at 1 m: relative and absolute epsilons fail at one of the two",
            .answer = "A ray that recedes from 1 m to infinity along a row meets the wall at Z: its depth 0.1 (1 - t) "
                      "equals 0.1 / Z at t = 1 - 1/Z, in the column where that is.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const double z : {2.0, 10.0, 1e3, 1e5}) {
                        setups.push_back({fmt::format("wall at {} m", z),
                                          picture_of(bench_view({1024, 4}), [=](glm::ivec2) { return z; }),
                                          boxes({.thickness_m = 10 * z, .max_distance_m = INFINITY}),
                                          {}});
                        for (int y = 0; y < 4; ++y)
                            setups.back().rays.push_back(rounded_to_float({{0.5, y + 0.5, 0.1},
                                                                           {1022.25, 0, -0.1},
                                                                           INFINITY,
                                                                           TraceStatus::past_max_distance,
                                                                           {0, y}}));
                    }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const double t = 1 - static_cast<double>(setup.gbuffer.depth[0]) / ray.origin_px_depth.z;
                return Expected{.pixel = glm::ivec2(0.5 + 1022.25 * t, ray.pixel.y), .t = t};
            }};
}

HardCase depth_runs_straight_on_screen()
{
    return {.name   = "depth_runs_straight_on_screen",
            .breaks = "interpolating distance instead of 1 / distance: in the middle of the screen way from 2 m to 50 "
                      "m a ray is at 3.846 m, not at 26",
            .answer = "From Z = 2 to 50, half way on screen: 2 / (1/2 + 1/50) = 3.8461538. A wall at 3.8461538 m is "
                      "met at t = 0.5.",
            .setups =
                [] {
                    const View view = bench_view({129, 9});
                    Setup setup{{}, picture_of(view, [](glm::ivec2) { return 2 / (1 / 2.0 + 1 / 50.0); }), bench, {}};
                    setup.rays = {ray_between(view, {4.7, 4.5, 2}, {124.7, 4.5, 50})};
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(64, 4), .t = 0.5};
            }};
}

HardCase equality_counts()
{
    return {
        .name   = "equality_counts",
        .breaks = "< for <= : a ray exactly on a surface, or exactly at a slab's back, passes through",
        .answer =
            "Numbers that are exact in any format. A level ray at depth 1/4 meets a front of 1/4, and a back of 1/4 "
            "(front 1/2, thickness such that the back is at half the depth); one step nearer or farther it does not.",
        .setups =
            [] {
                std::vector<Setup> setups;
                for (const float front : {0.25F, 0.5F}) {
                    // Relative thickness 1: the back is at depth / 2 exactly.
                    Setup setup{fmt::format("front {}", front),
                                picture_of(bench_view({40, 8}, 0.125), [](glm::ivec2) { return 0.0; }),
                                boxes({.thickness_m = 1, .thickness_relative = true, .max_distance_m = 100}),
                                {}};
                    for (int y = 0; y < 8; ++y) depth_at(setup, {30, y}) = front;
                    const float at = 0.25F, beyond = front == at ? std::nextafter(at, 1.0F) : std::nextafter(at, 0.0F);
                    for (const float depth : {at, beyond})
                        setup.rays.push_back(rounded_to_float(
                            {{5.5, 3.5, static_cast<double>(depth)}, {34, 0, 0}, 1, TraceStatus::left_screen, {5, 3}}));
                    setups.push_back(setup);
                }
                return setups;
            },
        .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
            if (ray.origin_px_depth.z != 0.25) return Expected{.status = ray.end_status};
            return Expected{.pixel = glm::ivec2(30, 3)};
        }};
}

HardCase level_at_the_surface()
{
    return {.name   = "level_at_the_surface",
            .breaks = "z0 (1 - t) + z1 t is not z0 where z0 = z1: a ray that keeps its depth is said to leave it, and "
                      "does so back and forth",
            .answer = "No thickness; a pole in each row at a depth of its own, and a ray that keeps exactly this "
                      "depth: every row is hit, at the pole's border.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (int k = 0; k < 16; ++k) {
                        Setup setup{{},
                                    picture_of(bench_view({131, 64}), [](glm::ivec2) { return 0.0; }),
                                    boxes({.thickness_m = 0, .max_distance_m = 100}),
                                    {}};
                        for (int y = 0; y < 64; ++y) {
                            const float depth =
                                0.1F + 0.013F * static_cast<float>(y) + 0.00071F * static_cast<float>(k);
                            depth_at(setup, {40 + y, y}) = depth;
                            setup.rays.push_back(rounded_to_float({{0.5, y + 0.5, static_cast<double>(depth)},
                                                                   {130, 0, 0},
                                                                   1,
                                                                   TraceStatus::left_screen,
                                                                   {0, y}}));
                        }
                        setups.push_back(setup);
                    }
                    return setups;
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                const int y = ray.pixel.y;
                return Expected{.pixel = glm::ivec2(40 + y % 80, y), .t = (39.5 + y % 80) / 130};
            }};
}

HardCase one_depth_step_apart()
{
    return {.name   = "one_depth_step_apart",
            .breaks = "two surfaces one step of the number format apart; an epsilon merges them",
            .answer = "Steps of 2^-24, thickness 0: a ray that falls through depths in front of the wall's depth d "
                      "meets it in the pixel where its interval holds d.",
            .setups =
                [] {
                    Setup setup{{},
                                picture_of(bench_view({64, 16}), [](glm::ivec2) { return 0.0; }),
                                boxes({.thickness_m = 0, .max_distance_m = 100}),
                                {}};
                    for (int y = 0; y < 16; ++y) {
                        for (int x = 0; x < 64; ++x)
                            depth_at(setup, {x, y}) = 0.75F + std::ldexp(static_cast<float>(y), -24);
                        // Two steps a pixel: one in front of the wall at the border between columns 31 and 32, one behind it at the next.
                        const double start = 0.75 + std::ldexp(y + 32.0, -24);
                        setup.rays.push_back(rounded_to_float({{16.5, y + 0.5, start},
                                                               {32, 0, -std::ldexp(64.0, -24)},
                                                               1,
                                                               TraceStatus::left_screen,
                                                               {16, y}}));
                    }
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(32, ray.pixel.y)};
            }};
}

} // namespace

CaseFamily depth_cases()
{
    return {"depth",
            {all_sky(), one_object_in_the_sky(), unusable_texels(), tiny_depths(), far_and_infinitely_far(),
             depth_runs_straight_on_screen(), equality_counts(), level_at_the_surface(), one_depth_step_apart()}};
}

} // namespace ssrlab
