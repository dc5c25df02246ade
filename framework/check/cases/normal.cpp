// Hard cases, family "normal": normals as they come from files, quantised buffers and mistakes.
#include "check/hard_case.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

const TraceSettings bench = boxes({.thickness_m = 1, .max_distance_m = 100});

Setup room()
{
    return {{},
            picture_of(bench_view(),
                       {plane({0, -1, 0}, {0, 1, 0}), plane({0, 0, -10}, {0, 0, 1}), sphere({0.7, -0.2, -5}, 0.8)}),
            bench,
            {}};
}

HardCase no_usable_normal()
{
    return {.name   = "no_usable_normal",
            .breaks = "normalize(0) is NaN, and NaN travels",
            .answer = "Such pixels do not reflect: no ray starts in columns 10 to 15; they can be hit like any other.",
            .setups =
                [] {
                    constexpr float nan       = std::numeric_limits<float>::quiet_NaN(),
                                    inf       = std::numeric_limits<float>::infinity();
                    const glm::vec3 normals[] = {{0, 0, 0},    {nan, 0, 1},     {0, inf, 0},
                                                 {0, 0, -inf}, {nan, nan, nan}, {-0.0F, 0, 0}};
                    Setup           setup     = room();
                    for (size_t y = 0; y < 64; ++y)
                        for (size_t x = 10; x < 16; ++x) setup.gbuffer.normal_vs[y * 64 + x] = normals[x - 10];
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                if (ray.pixel.x < 10 || ray.pixel.x > 15) return std::nullopt;
                return Expected{.status = TraceStatus::not_traced}; // no such ray may exist
            }};
}

Relation scaled_normals(double factor, const std::string& name)
{
    return {.name = name, .change = [=](Setup setup) {
                for (glm::vec3& normal : setup.gbuffer.normal_vs) normal *= static_cast<float>(factor);
                return setup;
            }};
}

HardCase normals_of_any_length()
{
    return {.name = "normals_of_any_length",
            .breaks =
                "squares of small or large components leave the range of float; a length of 1.001 bends every ray",
            .answer    = "Only the direction counts: the same bits for normals times 2^-100 … 2^100.",
            .setups    = [] { return std::vector{room()}; },
            .relations = {scaled_normals(0.5, "normals halved"), scaled_normals(0x1p-100, "normals times 2^-100"),
                          scaled_normals(0x1p100, "normals times 2^100")}};
}

HardCase normals_that_face_away()
{
    return {.name      = "normals_that_face_away",
            .breaks    = "smooth normals at silhouettes and two-sided surfaces face away from the eye",
            .answer    = "The mirror direction of -N is that of N: the same bits.",
            .setups    = [] { return std::vector{room()}; },
            .relations = {scaled_normals(-1, "normals turned around")}};
}

HardCase facing_rule()
{
    return {
        .name = "facing_rule",
        .breaks =
            "a ray that arrives from behind sees the back of what the camera sees: the picture has no colour for it",
        .answer = "With the rule on, the screen truth: surfaces that face away are passed, and a ray that met only "
                  "those says so. A mirror behind a ball sends rays to the ball's far side.",
        .setups = [] {
            Setup setup{
                {},
                picture_of(bench_view({97, 64}), {plane({0, 0, -10}, glm::normalize(glm::dvec3(0, 0.4, 1))),
                                                  sphere({0.5, 0.3, -5}, 1), box({-2, -3, -6}, {-1.8, 3, -5.8})}),
                boxes({.thickness_m = 2, .max_distance_m = 100}, Behind::pass),
                {}};
            return std::vector{setup};
        }};
}

HardCase sides_seen_edge_on()
{
    return {.name   = "sides_seen_edge_on",
            .breaks = "N·R = 0 is neither a front nor a back",
            .answer = "A ray up the middle column, where the slope of the view is 0, runs along the plane of the "
                      "normal (±1, 0, 0) "
                      "of row 20 exactly. Only N·R < 0 is a front: with behind = pass the ray goes on to the front in "
                      "row 10, or says that it met something.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const float side : {1.0F, -1.0F})
                        for (const bool wall : {true, false}) {
                            Setup setup{
                                wall ? "before a front" : "before nothing",
                                picture_of(bench_view({65, 65}),
                                           [=](glm::ivec2 p) { return p.y == 20 || (wall && p.y == 10) ? 4.0 : 0.0; }),
                                boxes({.thickness_m = 1, .max_distance_m = 100}, Behind::pass),
                                {}};
                            for (int x = 0; x < 65; ++x) {
                                setup.gbuffer.normal_vs[static_cast<size_t>(20 * 65 + x)] = {side, 0, 0};
                                setup.gbuffer.normal_vs[static_cast<size_t>(10 * 65 + x)] = {0, -1, 0};
                            }
                            setup.rays.push_back(level_ray(setup.gbuffer.view, {32.5, 60.5}, {0, -60.5}, 4.5));
                            setups.push_back(setup);
                        }
                    return setups;
                },
            .expected = [](const Setup& setup, const RayInput&) -> std::optional<Expected> {
                if (setup.label == "before nothing") return Expected{.status = TraceStatus::facing_away};
                return Expected{.pixel = glm::ivec2(32, 10)};
            }};
}

} // namespace

CaseFamily normal_cases()
{
    return {
        "normal",
        {no_usable_normal(), normals_of_any_length(), normals_that_face_away(), facing_rule(), sides_seen_edge_on()}};
}

} // namespace ssrlab
