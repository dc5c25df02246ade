// Hard cases, family "motion": the same scene a fraction of a pixel on, doubled, turned over.
#include "check/hard_case.h"
#include "core/pixel_index.h"
#include "scene/sequence.h"

#include <algorithm>

namespace ssrlab {
namespace {

std::vector<Shape> yard()
{
    return {plane({0, -1, 0}, {0, 1, 0}), plane({0, 0, -10}, {0, 0, 1}), sphere({0.7, -0.2, -5}, 0.8),
            box({-2, -1, -6}, {-1.9, 1.5, -5.9})};
}

HardCase sub_pixel_jitter()
{
    return {.name   = "sub_pixel_jitter",
            .breaks = "the picture is sampled at other points in every frame: hits flicker where the answer hangs on a "
                      "fraction of a pixel",
            .answer = "The screen truth in each of 16 phases (Halton 2, 3). How much answers change between phases is "
                      "the sampling's doing; a technique may not add to it.",
            .setups = [] {
                std::vector<Setup> setups;
                for (int phase = 1; phase <= 16; ++phase) {
                    View view = bench_view({96, 64});
                    view.centre_px += jitter_px({phase - 1, 16});
                    setups.push_back({fmt::format("phase {}", phase),
                                      picture_of(view, yard()),
                                      boxes({.thickness_m = 0.5, .max_distance_m = 100}),
                                      {}});
                }
                return setups;
            }};
}

constexpr int bar_columns[] = {40, 41, 52, 20};

/// Mirrors in the first column send level rays along their rows to a bar.
Setup row_mirrors_and_bar(int column)
{
    Setup setup{fmt::format("bar in column {}", column),
                picture_of(bench_view(), [=](glm::ivec2 p) { return p.x == 0        ? 4.5
                                                                    : p.x == column ? 4.0
                                                                                    : 0.0; }),
                boxes({.thickness_m = 1, .max_distance_m = 100}),
                {}};
    for (int y = 0; y < 64; ++y) {
        reflect_to(setup.gbuffer, {0, y}, {1, 0, 0});
        setup.gbuffer.metallic[pixel_index({column, y}, setup.gbuffer.view.size_px)] = 0;
    }
    return setup;
}

HardCase previous_frame()
{
    return {.name   = "previous_frame",
            .breaks = "depth, a pyramid or hits of the frame before are read: what moved is found where it was",
            .answer = "A bar stands in another column in each frame. Every row's level ray hits it there, column - "
                      "0.5 of 63.5 px away.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const int column : bar_columns) setups.push_back(row_mirrors_and_bar(column));
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const auto row    = setup.gbuffer.depth.begin() + ptrdiff_t{64} * ray.pixel.y;
                const auto column = std::find_if(row + 1, row + 64, [](float depth) { return depth > 0; }) - row;
                return Expected{.pixel = glm::ivec2(column, ray.pixel.y),
                                .t     = (static_cast<double>(column) - 0.5) / 63.5};
            },
            .in_order = true};
}

/// Twice the resolution, each pixel repeated four times.
Setup doubled(const Setup& setup)
{
    Setup            result = setup;
    const glm::ivec2 size   = setup.gbuffer.view.size_px;
    View             view   = setup.gbuffer.view;
    view.size_px *= 2;
    view.centre_px *= 2.0;
    view.focal_px *= 2.0;
    result.gbuffer = picture_of(view, [](glm::ivec2) { return 0.0; });
    for (int y = 0; y < 2 * size.y; ++y)
        for (int x = 0; x < 2 * size.x; ++x)
            result.gbuffer.depth[pixel_index({x, y}, 2 * size)] =
                setup.gbuffer.depth[pixel_index({x / 2, y / 2}, size)];
    for (RayInput& ray : result.rays)
        for (int axis : {0, 1}) {
            ray.origin_px_depth[axis] *= 2;
            ray.delta_px_depth[axis] *= 2;
            ray.pixel[axis] *= 2;
        }
    return result;
}

HardCase resolution_doubling()
{
    return {
        .name   = "resolution_doubling",
        .breaks = "epsilons and strides in pixels",
        .answer = "Each pixel split in four, the same rays: the hit lies in the same pixel. The borders that remain "
                  "are crossed at the same t, bit for bit, and the new ones lie between. "
                  "(Start pixels are background: three quarters of them would become visitable.)",
        .setups =
            [] {
                Setup setup{{},
                            picture_of(bench_view({127, 93}),
                                       [](glm::ivec2 p) {
                                           return p.x < 4 || p.y < 4 ? 0.0 : (p.x * 7 + p.y * 13) % 61 == 0 ? 4.0 : 0.0;
                                       }),
                            boxes({.thickness_m = 1, .max_distance_m = 100}),
                            {}};
                for (int i = 0; i < 500; ++i) {
                    const bool       from_left = i % 2 == 0;
                    const double     a = (i * 37 % 500) / 500.0, b = (i * 211 % 500) / 500.0;
                    const glm::dvec2 from = from_left ? glm::dvec2(2.25, 1 + 91 * a) : glm::dvec2(1 + 125 * a, 2.75),
                                     to   = from_left ? glm::dvec2(126, 1 + 91 * b) : glm::dvec2(1 + 125 * b, 92);
                    setup.rays.push_back(level_ray(setup.gbuffer.view, from, to - from, 4.5));
                }
                return std::vector{setup};
            },
        .relations = {{.name = "at twice the resolution", .change = doubled, .back = [](RayOutcome outcome) {
                           outcome.hit_pixel /= 2;
                           return outcome;
                       }}}};
}

HardCase unrelated_pixels()
{
    return {.name   = "unrelated_pixels",
            .breaks = "a search that looks beside the ray: neighbours, coarse levels, filtered depth",
            .answer = "What stands in pixels that the ray does not cross changes nothing: the same bits with "
                      "everything else filled.",
            .setups =
                [] {
                    Setup setup{{},
                                picture_of(bench_view({64, 64}), [](glm::ivec2 p) { return p.x == 50 ? 4.0 : 0.0; }),
                                boxes({.thickness_m = 1, .max_distance_m = 100}),
                                {}};
                    setup.rays = {level_ray(setup.gbuffer.view, {3.5, 20.5}, {60, 0}, 4.5)};
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(50, 20)};
            },
            .relations = {{.name = "with every other row filled", .change = [](Setup setup) {
                               for (size_t i = 0; i < setup.gbuffer.depth.size(); ++i)
                                   if (i / 64 != 20) setup.gbuffer.depth[i] = i % 3 == 0 ? 0.9F : 0.022F;
                               return setup;
                           }}}};
}

} // namespace

CaseFamily motion_cases()
{
    return {"motion", {sub_pixel_jitter(), previous_frame(), resolution_doubling(), unrelated_pixels()}};
}

} // namespace ssrlab
