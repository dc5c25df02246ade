// Hard cases, family "size": images whose halves are not whole.
#include "check/hard_case.h"
#include "core/pixel_index.h"

#include <algorithm>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

constexpr glm::ivec2 sizes[] = {{1, 1},     {1, 2},    {2, 1},     {3, 3},     {1, 97},    {97, 1},    {17, 31},
                                {127, 131}, {64, 64},  {63, 65},   {65, 63},   {255, 257}, {641, 359}, {1366, 3},
                                {1921, 5},  {5, 1081}, {16384, 1}, {1, 16384}, {16384, 3}, {8193, 2}};

HardCase last_row_and_column()
{
    return {.name   = "last_row_and_column",
            .breaks = "sizes rounded down lose the pyramid's last row and column; sizes rounded up read beyond them",
            .answer = "Three pixels stand: the right end of the first row, the lower end of the first column, the last "
                      "pixel. The rays from the first pixel's centre to theirs find them, at any size.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const glm::ivec2& size : sizes) {
                        const glm::ivec2              last = size - 1;
                        const std::vector<glm::ivec2> ends = {{last.x, 0}, {0, last.y}, last};
                        Setup                         setup{fmt::format("{}x{}", size.x, size.y),
                                    picture_of(bench_view(size),
                                                                       [&](glm::ivec2 p) {
                                                   return std::ranges::count(ends, p) > 0 && p != glm::ivec2(0) ? 4.0
                                                                                                                                        : 0.0;
                                               }),
                                    bench,
                                    {}};
                        for (const glm::ivec2& end : ends)
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {0.5, 0.5}, end, 4.5));
                        setups.push_back(setup);
                    }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const glm::ivec2 end(glm::round(glm::dvec2(ray.delta_px_depth)));
                if (end == glm::ivec2(0)) return Expected{.status = ray.end_status};
                // In two columns or rows the ray to the last pixel may end in one of its neighbours first.
                if (glm::min(setup.gbuffer.view.size_px.x, setup.gbuffer.view.size_px.y) == 2 && end.x > 0 && end.y > 0)
                    return std::nullopt;
                return Expected{.pixel = end};
            }};
}

HardCase crossings_of_odd_sizes()
{
    return {.name   = "crossings_of_odd_sizes",
            .breaks = "cells of the pyramid that are cut by the image's border",
            .answer = "The screen truth along rays that cross the whole image, from each pixel of the first row to one "
                      "of the last and from left to right.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const glm::ivec2& size : sizes) {
                    const auto hash = [](glm::ivec2 p) {
                        return (static_cast<uint32_t>(p.x) * 2654435761u ^ static_cast<uint32_t>(p.y) * 2246822519u) >>
                               9;
                    };
                    Setup setup{fmt::format("{}x{}", size.x, size.y),
                                picture_of(bench_view(size),
                                           [&](glm::ivec2 p) { return hash(p) % 97 == 0 ? 3.0 + hash(p) % 3 : 0.0; }),
                                bench,
                                {}};
                    for (int i = 0; i < 64; ++i) {
                        const glm::dvec2 end(glm::dvec2(size) - 1.0);
                        const double     a = i / 63.0, b = ((i * 29) % 64) / 63.0;
                        setup.rays.push_back(
                            level_ray(setup.gbuffer.view, {0.5 + a * end.x, 0.5}, {(b - a) * end.x, end.y}, 4.25));
                        setup.rays.push_back(
                            level_ray(setup.gbuffer.view, {0.5, 0.5 + a * end.y}, {end.x, (b - a) * end.y}, 4.25));
                    }
                    setups.push_back(setup);
                }
                return setups;
            }};
}

/// Mirrors at the left and upper border send their rays along rows and columns, level at 4.5 m, to walls 4 m away at the right and lower one.
Setup rows_and_columns(glm::ivec2 size)
{
    const glm::ivec2 last = size - 1;
    const auto on_border  = [](int a, int border, int b, int b_last) { return a == border && b > 0 && b < b_last; };
    Setup      setup{fmt::format("{}x{}", size.x, size.y),
                picture_of(bench_view(size),
                                [&](glm::ivec2 p) {
                               if (on_border(p.x, 0, p.y, last.y) || on_border(p.y, 0, p.x, last.x)) return 4.5;
                               return on_border(p.x, last.x, p.y, last.y) || on_border(p.y, last.y, p.x, last.x) ? 4.0
                                                                                                                      : 0.0;
                           }),
                bench,
                {}};
    for (int y = 1; y < last.y; ++y) reflect_to(setup.gbuffer, {0, y}, {1, 0, 0});
    for (int x = 1; x < last.x; ++x) reflect_to(setup.gbuffer, {x, 0}, {0, -1, 0});
    for (size_t i = 0; i < setup.gbuffer.depth.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, size);
        if (pixel.x > 0 && pixel.y > 0) setup.gbuffer.metallic[i] = 0;
    }
    return setup;
}

HardCase last_cells()
{
    return {.name   = "last_cells",
            .breaks = "a pyramid of a size that is no power of two: size >> level loses the last cells, sizes rounded "
                      "up read beyond them; rays parallel to an axis never cross the other one's borders",
            .answer = "Mirrors at the left and upper border send level rays along each row and column: they hit the "
                      "last pixel of it, size - 1.5 of size - 0.5 px away.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const glm::ivec2& size :
                         {glm::ivec2(17, 31), {31, 17}, {63, 65}, {65, 63}, {64, 64}, {97, 61}, {127, 33}, {33, 129}})
                        setups.push_back(rows_and_columns(size));
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                const glm::ivec2 size = setup.gbuffer.view.size_px;
                const int        axis = ray.pixel.x == 0 ? 0 : 1;
                glm::ivec2       end  = ray.pixel;
                end[axis]             = size[axis] - 1;
                return Expected{.pixel = end, .t = (size[axis] - 1.5) / (size[axis] - 0.5)};
            }};
}

} // namespace

CaseFamily size_cases() { return {"size", {last_row_and_column(), crossings_of_odd_sizes(), last_cells()}}; }

} // namespace ssrlab
