// Hard cases, family "border": rays on and along the borders between pixels.
#include "check/hard_case.h"

#include <cmath>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

std::optional<Expected> never_hits(const Setup&, const RayInput& ray) { return Expected{.status = ray.end_status}; }

/// A pattern without order: about one pixel in `every` stands at 4 m, the rest is background.
double scattered_poles(glm::ivec2 p, int every)
{
    uint32_t hash = static_cast<uint32_t>(p.x) * 0x9E3779B1u ^ static_cast<uint32_t>(p.y) * 0x85EBCA77u;
    hash          = (hash ^ (hash >> 15)) * 0x2C1B3C6Du;
    return (hash >> 8) % static_cast<uint32_t>(every) == 0 ? 4.0 : 0.0;
}

Setup poles(glm::ivec2 size_px, int every)
{
    return {{}, picture_of(bench_view(size_px), [=](glm::ivec2 p) { return scattered_poles(p, every); }), bench, {}};
}

HardCase signed_zero()
{
    return {.name   = "signed_zero",
            .breaks = "1 / -0 is minus infinity, (X - O) * infinity is NaN where X = O: axis-aligned rays of level "
                      "cameras lose every hit",
            .answer = "A component of zero crosses nothing, whatever its sign: the same bits for +0 and -0.",
            .setups =
                [] {
                    Setup setup = poles({64, 64}, 40);
                    for (int i = 0; i < 64; ++i)
                        for (const double zero : {0.0, -0.0})
                            for (const double side : {-1.0, 1.0}) {
                                const double length = side < 0 ? 32.5 : 31.5;
                                RayInput ray = level_ray(setup.gbuffer.view, {32.5, i + 0.5}, {side * length, 0}, 4.5);
                                ray.delta_px_depth.y = zero;
                                setup.rays.push_back(ray);
                                ray = level_ray(setup.gbuffer.view, {i + 0.5, 32.5}, {0, side * length}, 4.5);
                                ray.delta_px_depth.x = zero;
                                setup.rays.push_back(ray);
                            }
                    return std::vector{setup};
                },
            .relations = {{.name = "with the zeros' signs changed", .change = [](Setup setup) {
                               for (RayInput& ray : setup.rays)
                                   for (int axis : {0, 1})
                                       if (ray.delta_px_depth[axis] == 0)
                                           ray.delta_px_depth[axis] = -ray.delta_px_depth[axis];
                               return setup;
                           }}}};
}

HardCase axis_aligned()
{
    return {.name   = "axis_aligned",
            .breaks = "the borders of the other axis are never reached",
            .answer = "A row finds the pole at column 20 and no other row; the pixel walk visits exactly the columns "
                      "between. Every row of the image, 1 px off the borders too.",
            .setups =
                [] {
                    Setup setup{
                        {}, picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 20 ? 4.0 : 10.0; }), bench, {}};
                    for (int y = 0; y < 64; ++y)
                        setup.rays.push_back(level_ray(setup.gbuffer.view, {63.5, y + 0.5}, {-63, 0}, 4.5));
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                return Expected{.pixel = glm::ivec2(20, ray.pixel.y), .t = 42.5 / 63};
            }};
}

HardCase exact_diagonal()
{
    return {.name   = "exact_diagonal",
            .breaks = "every crossing is a corner: rounding decides which of two neighbours is visited besides",
            .answer =
                "Only diagonal pixels are visited: everything off the diagonal stands in the way, and the rays pass.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const int slope : {1, -1}) {
                        Setup setup{
                            slope > 0 ? "falling" : "rising",
                            picture_of(bench_view(),
                                       [=](glm::ivec2 p) { return p.y == (slope > 0 ? p.x : 63 - p.x) ? 0.0 : 4.0; }),
                            bench,
                            {}};
                        for (int x = 1; x < 63; ++x)
                            for (const int way : {1, -1}) {
                                const double length = way > 0 ? 63.5 - x : x + 0.5, y = slope > 0 ? x + 0.5 : 63.5 - x;
                                setup.rays.push_back(level_ray(setup.gbuffer.view, {x + 0.5, y},
                                                               {way * length, way * slope * length}, 4.5));
                            }
                        setups.push_back(setup);
                    }
                    return setups;
                },
            .expected = never_hits};
}

HardCase rational_slopes()
{
    return {.name   = "rational_slopes",
            .breaks = "rays of slope p/q from pixel centres pass through many corners exactly",
            .answer = "The screen truth, slivers aside; mirror images agree to the bit.",
            .setups = [] {
                Setup setup = poles({211, 173}, 30);
                for (int p = -4; p <= 4; ++p)
                    for (int q = -4; q <= 4; ++q)
                        for (int k = 0; k < 40; ++k) {
                            if (p == 0 && q == 0) continue;
                            const glm::dvec2 from(60.5 + (k * 7) % 89, 60.5 + (k * 13) % 53), way(p, q);
                            const double     length = 58.0 / std::max(std::abs(p), std::abs(q));
                            setup.rays.push_back(level_ray(setup.gbuffer.view, from, std::floor(length) * way, 4.5));
                        }
                return std::vector{setup};
            }};
}

HardCase along_a_border()
{
    return {.name   = "along_a_border",
            .breaks = "floor() of the position flips between two columns; half-resolution and jittered rays really "
                      "start on corners",
            .answer = "A ray down the border x = 30 belongs to column 30 all the way: it passes beside a wall in "
                      "column 29, and one in 30 stops it at its first pixel, row 11.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const int column : {29, 30}) {
                        Setup setup{fmt::format("wall in column {}", column),
                                    picture_of(bench_view(), [=](glm::ivec2 p) { return p.x == column ? 4.0 : 0.0; }),
                                    bench,
                                    {}};
                        for (const double y : {10.0, 10.5})
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {30, y}, {0, 64 - y}, 4.5));
                        setups.push_back(setup);
                    }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput& ray) -> std::optional<Expected> {
                if (setup.label == "wall in column 29") return Expected{.status = ray.end_status};
                return Expected{.pixel = glm::ivec2(30, 11)};
            }};
}

HardCase within_an_ulp_of_a_corner()
{
    return {.name   = "within_an_ulp_of_a_corner",
            .breaks = "which border comes first cannot be told in the number format",
            .answer = "The screen truth, slivers aside; no stall and no jump.",
            .setups = [] {
                Setup setup = poles({128, 128}, 3);
                for (int k = 0; k < 400; ++k) {
                    const auto   x = static_cast<float>(20 + k % 40), y = static_cast<float>(20 + (k * 7) % 40);
                    const float  towards = k % 2 == 0 ? 1e9F : -1e9F;
                    const double from_x  = static_cast<double>(std::nextafter(x, towards)),
                                 from_y  = static_cast<double>(std::nextafter(y, k % 3 == 0 ? 1e9F : -1e9F));
                    const double dx = 10 + k % 50, dy = 10 + (k * 3) % 50;
                    setup.rays.push_back(
                        level_ray(setup.gbuffer.view, {from_x, from_y}, {x + dx - from_x, y + dy - from_y}, 4.5));
                }
                return std::vector{setup};
            }};
}

HardCase out_at_every_side()
{
    return {
        .name   = "out_at_every_side",
        .breaks = "one pixel too far: a read outside the image, or the last column missed",
        .answer = "From the centre to the middle of each side and to each corner, and from the corner pixels outward. "
                  "The outermost ring of pixels stands in the way of the first eight and is hit in its "
                  "own pixel; the others visit nothing.",
        .setups =
            [] {
                const int last = 62;
                Setup     setup{{},
                            picture_of(bench_view({63, 63}),
                                           [](glm::ivec2 p) {
                                           return std::min({p.x, p.y, last - p.x, last - p.y}) == 0 ? 4.0 : 0.0;
                                       }),
                            bench,
                            {}};
                for (int x = -1; x <= 1; ++x)
                    for (int y = -1; y <= 1; ++y) {
                        if (x == 0 && y == 0) continue;
                        setup.rays.push_back(level_ray(setup.gbuffer.view, {31.5, 31.5}, {x * 31.5, y * 31.5}, 4.5));
                        if (x != 0 && y != 0)
                            setup.rays.push_back(
                                level_ray(setup.gbuffer.view, {31.5 + x * 31, 31.5 + y * 31}, {x * 0.5, y * 0.5}, 4.5));
                    }
                return std::vector{setup};
            },
        .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
            if (ray.pixel != glm::ivec2(31, 31)) return Expected{.status = ray.end_status};
            return Expected{.pixel = glm::ivec2(glm::sign(glm::dvec2(ray.delta_px_depth))) * 31 + 31};
        }};
}

HardCase start_on_the_image_border()
{
    return {
        .name   = "start_on_the_image_border",
        .breaks = "floor(W) is W: a start pixel outside the image",
        .answer = "The last column is the start pixel of x = 64; the ray finds the pole in column 5.",
        .setups =
            [] {
                Setup setup{{}, picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 5 ? 4.0 : 0.0; }), bench, {}};
                for (const double x : {64.0, 64.0 - 0x1p-10, 63.0, 0.0, 0x1p-10})
                    setup.rays.push_back(level_ray(setup.gbuffer.view, {x, 20.5}, {x > 32 ? -x : 60, 0}, 4.5));
                return std::vector{setup};
            },
        .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
            return Expected{.pixel = glm::ivec2(5, 20)};
        }};
}

HardCase along_the_image_border()
{
    return {
        .name   = "along_the_image_border",
        .breaks = "on the image's own border every formula for leaving it says: here",
        .answer = "A component of zero crosses nothing: the rays along y = 64 and x = 64 run in the last row and "
                  "column and find the poles there; those along 0 in the first.",
        .setups =
            [] {
                Setup setup{{},
                            picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 40 || p.y == 40 ? 4.0 : 0.0; }),
                            bench,
                            {}};
                for (const double at : {0.0, 64.0}) {
                    setup.rays.push_back(level_ray(setup.gbuffer.view, {3.5, at}, {60, 0}, 4.5));
                    setup.rays.push_back(level_ray(setup.gbuffer.view, {at, 3.5}, {0, 60}, 4.5));
                }
                return std::vector{setup};
            },
        .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
            const glm::dvec2 from(ray.origin_px_depth);
            const auto       held = [](double at) { return at > 32 ? 63 : 0; };
            return Expected{.pixel =
                                ray.delta_px_depth.x > 0 ? glm::ivec2(40, held(from.y)) : glm::ivec2(held(from.x), 40)};
        }};
}

HardCase shorter_than_a_pixel()
{
    return {.name   = "shorter_than_a_pixel",
            .breaks = "no pixel or one pixel to visit, 1 / D is huge",
            .answer = "Everything stands in the way: rays that stay in their pixel hit nothing, the one that crosses a "
                      "border by 0.001 px hits the neighbour.",
            .setups =
                [] {
                    Setup setup{{}, picture_of(bench_view(), [](glm::ivec2) { return 4.0; }), bench, {}};
                    for (const glm::dvec2& delta :
                         {glm::dvec2(1e-3, 0), glm::dvec2(0.4, 0.4), glm::dvec2(-0.499, 0.499), glm::dvec2(0.501, 0),
                          glm::dvec2(0, -0.501)})
                        setup.rays.push_back(level_ray(setup.gbuffer.view, {30.5, 20.5}, delta, 4.5));
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                if (ray.delta_px_depth.x > 0.5) return Expected{.pixel = glm::ivec2(31, 20)};
                if (ray.delta_px_depth.y < -0.5) return Expected{.pixel = glm::ivec2(30, 19)};
                return Expected{.status = ray.end_status};
            }};
}

} // namespace

CaseFamily border_cases()
{
    return {"border",
            {signed_zero(), axis_aligned(), exact_diagonal(), rational_slopes(), along_a_border(),
             within_an_ulp_of_a_corner(), out_at_every_side(), start_on_the_image_border(), along_the_image_border(),
             shorter_than_a_pixel()}};
}

} // namespace ssrlab
