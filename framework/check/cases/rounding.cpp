// Hard cases, family "rounding": what the last place of a number decides.
#include "check/hard_case.h"
#include "core/pixel_index.h"

#include <cmath>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

HardCase touches_where_it_leaves()
{
    return {.name = "touches_where_it_leaves",
            .breaks =
                "a ray meets a front exactly at the pixel's far border; t there is no float, and the depth comes out "
                "in front by the last place",
            .answer =
                "A ray falls by 2^-7 a pixel and reaches the depth 2^-5 of one pixel at its far border, t = (column + "
                "0.5) / length: it hits. Of these lengths floats round the depth to the wrong side.",
            .setups =
                [] {
                    const glm::ivec2 lengths_and_columns[] = {{31, 28},   {61, 57},   {61, 58},  {62, 60},
                                                              {124, 120}, {124, 121}, {124, 122}};
                    Setup setup{{}, picture_of(bench_view({128, 7}), [](glm::ivec2) { return 0.0; }), bench, {}};
                    int   y = 0;
                    for (const glm::ivec2& of : lengths_and_columns) {
                        setup.gbuffer.depth[pixel_index({of.y, y}, {128, 7})] = 0x1p-5F;
                        setup.rays.push_back({{0.5, y + 0.5, 0x1p-5 + (of.y + 0.5) * 0x1p-7},
                                              {of.x, 0, -of.x * 0x1p-7},
                                              1,
                                              TraceStatus::past_max_distance,
                                              {0, y}});
                        ++y;
                    }
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                const int column = static_cast<int>((ray.origin_px_depth.z - 0x1p-5) * 0x1p7);
                return Expected{.pixel = glm::ivec2(column, ray.pixel.y), .t = (column + 0.5) / ray.delta_px_depth.x};
            }};
}

HardCase out_over_the_last_row()
{
    return {.name = "out_over_the_last_row",
            .breaks =
                "(H - y) * (1 / (H - y)) is rounded below 1: the border is crossed before the ray ends. Behind the "
                "last row of a height that is a power of two, the first one may be read",
            .answer = "Down to the last border from each row but row 0, which alone stands in the way: no hit.",
            .setups =
                [] {
                    const auto wall = [](glm::ivec2 p) { return p.y == 0 ? 4.0 : 0.0; };
                    Setup      setup{{}, picture_of(bench_view({64, 64}), wall), bench, {}};
                    for (int i = 1; i < 64; ++i)
                        setup.rays.push_back(level_ray(setup.gbuffer.view, {i + 0.5, i + 0.5}, {0, 63.5 - i}, 4.5));
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                return Expected{.status = ray.end_status};
            }};
}

// The ray falls 240 px and drifts right by 0.002 px. Between rows 159.875 and 160, where a skip of hiz_packets ends, its position is rounded to x = 64,
// and it crosses that border a little below row 160.
HardCase beside_a_border()
{
    constexpr double start_y = 7.875, length_px = 240, t_wall = (160 - start_y) / length_px, t_border = 0.634;
    return {.name   = "beside_a_border",
            .breaks = "the rounded position lies behind a border that the ray has not crossed yet",
            .answer =
                "A wall in column 63 from row 160 down; the ray comes down column 63 and goes over to column 64 at t = "
                "0.634, a little after it has met the wall at t = 152.125 / 240.",
            .setups =
                [] {
                    const auto wall = [](glm::ivec2 p) { return p.x == 63 && p.y >= 160 ? 4.0 : 0.0; };
                    Setup      setup{{}, picture_of(bench_view({96, 256}), wall), bench, {}};
                    for (int k = 290; k < 330; ++k) {
                        const double way_px = std::ldexp(k, -18); // to the border, in last places of the position
                        setup.rays.push_back(rounded_to_float(level_ray(setup.gbuffer.view, {64 - way_px, start_y},
                                                                        {way_px / t_border, length_px}, 4.5)));
                    }
                    return std::vector{setup};
                },
            .expected = [=](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(63, 160), .t = t_wall};
            }};
}

} // namespace

CaseFamily rounding_cases()
{
    return {"rounding", {touches_where_it_leaves(), out_over_the_last_row(), beside_a_border()}};
}

} // namespace ssrlab
