// Hard cases, family "camera": lenses, projections and planes at their extremes.
#include "check/hard_case.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

/// A wall at distance `wall_m` above a mirror floor whose edge with it lies 3.2 px below the image's centre, through any lens.
///
/// The floor pixel of row y (from the centre) lies at Z0 = f h / y; its ray rises as steeply as the view ray falls and meets the wall at height
/// y/f * (Z - 2 Z0): on screen at 2 f h / Z - y = 6.4 - y from the centre, in the same column.
Setup wall_above_floor(View view, double wall_m, const std::string& label)
{
    const double height = 3.2 * wall_m / view.focal_px.y;
    return {label,
            picture_of(view, {plane({0, -height, 0}, {0, 1, 0}), plane({0, 0, -wall_m}, {0, 0, 1})}),
            boxes({.thickness_m = 0.1 * wall_m, .max_distance_m = 100 * wall_m}),
            {}};
}

std::optional<Expected> wall_row(const Setup& setup, const RayInput& ray)
{
    const double below_centre = ray.pixel.y + 0.5 - setup.gbuffer.view.centre_px.y;
    if (below_centre < 3.2) return std::nullopt; // the wall's own rays
    const double row = std::floor(setup.gbuffer.view.centre_px.y + 6.4 - below_centre);
    if (row < 0) return Expected{.status = TraceStatus::left_screen};
    if (row == ray.pixel.y) return std::nullopt; // the start pixel never counts
    return Expected{.pixel = glm::ivec2(ray.pixel.x, row)};
}

const std::string wall_answer =
    "A mirror floor below a wall. Row y below the centre reflects the wall's row 6.4 - y below it, in the same column.";

HardCase narrow_and_wide()
{
    return {.name   = "narrow_and_wide",
            .breaks = "at 1 degree all rays are parallel and coordinates cancel; at 170 degrees the borders are a "
                      "hundred times farther than the centre",
            .answer = wall_answer + " The floor's height is chosen so that this holds for any lens.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const double fov : {1.0, 5.0, 50.0, 90.0, 130.0, 170.0})
                        setups.push_back(
                            wall_above_floor(bench_view({64, 64}, 0.01, fov), 10, fmt::format("{} degrees", fov)));
                    return setups;
                },
            .expected = wall_row};
}

HardCase odd_width()
{
    return {.name   = "odd_width",
            .breaks = "the middle column's rays are parallel to the screen's y axis: 1 / 0, and 0 times infinity at "
                      "the border where they begin",
            .answer = wall_answer + " Also in the middle column, where no ray moves in x.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const glm::ivec2& size : {glm::ivec2(65, 64), {1, 64}, {33, 47}})
                        setups.push_back(wall_above_floor(bench_view(size), 10, fmt::format("{}x{}", size.x, size.y)));
                    return setups;
                },
            .expected = wall_row};
}

HardCase off_centre()
{
    return {.name   = "off_centre",
            .breaks = "code that takes the image's middle for the view axis; jittered and tiled pictures",
            .answer = wall_answer + " Also where the centre is elsewhere: the closed form counts from the view axis.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const glm::dvec2& shift : {glm::dvec2(7, 0), glm::dvec2(0, -9), glm::dvec2(-20, 11),
                                                    glm::dvec2(0.25, 0.25), glm::dvec2(40, -30)}) {
                        View view = bench_view();
                        view.centre_px += shift;
                        setups.push_back(
                            wall_above_floor(view, 10, fmt::format("shifted by ({}, {}) px", shift.x, shift.y)));
                    }
                    return setups;
                },
            .expected = wall_row};
}

HardCase near_plane_near_and_far()
{
    return {.name   = "near_plane_near_and_far",
            .breaks = "depths of 1e-9, or all next to 1; thickness divided by the near plane's distance",
            .answer = wall_answer + " Nothing of that depends on the near plane.",
            .setups =
                [] {
                    std::vector<Setup> setups;
                    for (const auto& [near_m, wall_m] :
                         {std::pair(1e-4, 10.0), {1e-8, 10.0}, {0.9, 10.0}, {1e-4, 1e-2}, {1e7, 1e8}, {1.0, 1e7}})
                        setups.push_back(wall_above_floor(bench_view({64, 64}, near_m), wall_m,
                                                          fmt::format("near {} m, wall {} m", near_m, wall_m)));
                    return setups;
                },
            .expected = wall_row};
}

HardCase orthographic()
{
    return {.name   = "orthographic",
            .breaks = "w is 1 everywhere, depth is linear in distance: formulas with 1 / distance are wrong",
            .answer =
                "A mirror at 45 degrees in the rows from 40 on sends its rays straight up, at constant distance; "
                "above row 20 stands a wall whose slab holds that distance: row 19, same column, t = (y - 20) / y.",
            .setups =
                [] {
                    Setup setup{{},
                                picture_of(orthographic_view({48, 64}, 4, 0.5, 20),
                                           [](glm::ivec2 p) {
                                               return p.y < 20 ? 4.0 : p.y < 40 ? 0.0 : 6.0 - p.y / 64.0;
                                           }),
                                boxes({.thickness_m = 3, .max_distance_m = 100}),
                                {}};
                    for (size_t i = 0; i < setup.gbuffer.normal_vs.size(); ++i) {
                        setup.gbuffer.normal_vs[i] = {0, 1, 1};
                        setup.gbuffer.metallic[i]  = i >= 40 * 48 ? 1.0F : 0.0F;
                    }
                    return std::vector{setup};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                const double y = ray.pixel.y + 0.5;
                return Expected{.pixel = glm::ivec2(ray.pixel.x, 19), .t = (y - 20) / y};
            }};
}

HardCase orthographic_along_the_axis()
{
    return {.name   = "orthographic_along_the_axis",
            .breaks = "the ray projects to one point, also in the far direction and however long",
            .answer = "A wall reflects every ray back to the camera along the axis: visits nothing, leaves through the "
                      "near plane.",
            .setups =
                [] {
                    return std::vector{
                        Setup{{},
                              picture_of(orthographic_view({32, 32}, 4, 0.5, 20), {plane({0, 0, -5}, {0, 0, 1})}),
                              boxes({.thickness_m = 1, .max_distance_m = 1e9}),
                              {}}};
                },
            .expected = [](const Setup&, const RayInput&) -> std::optional<Expected> {
                return Expected{.status = TraceStatus::left_screen, .end_px = {}};
            },
            .most_steps = [](const Setup&) { return 1; }};
}

HardCase orthographic_scene()
{
    return {.name   = "orthographic_scene",
            .breaks = "slabs of relative and absolute thickness in a linear depth range, the far plane as a limit",
            .answer = "The screen truth: a tilted mirror, a ball and a post, through an orthographic camera.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const bool relative : {false, true})
                    setups.push_back({relative ? "relative thickness" : "absolute thickness",
                                      picture_of(orthographic_view({79, 61}, 6, 0.5, 40),
                                                 {plane({0, -1, -10}, glm::normalize(glm::dvec3(0.1, 1.2, 1))),
                                                  sphere({0.5, 0.3, -6}, 1), box({-2, -1, -7}, {-1.8, 3, -6.8})}),
                                      boxes({.thickness_m        = relative ? 0.1 : 0.7,
                                             .thickness_relative = relative,
                                             .max_distance_m     = 1e9}),
                                      {}});
                return setups;
            }};
}

std::function<void()> refused_camera(const std::function<void(Camera&)>& spoil, glm::ivec2 size_px = {64, 64})
{
    return [=] {
        Camera camera;
        spoil(camera);
        camera_to_view(camera, size_px);
    };
}

std::vector<RefusedCase> refused()
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    return {{"fov_0", refused_camera([](Camera& c) { c.fov_y_deg = 0; }), "fov_y_deg"},
            {"fov_180", refused_camera([](Camera& c) { c.fov_y_deg = 180; }), "fov_y_deg"},
            {"fov_nan", refused_camera([](Camera& c) { c.fov_y_deg = nan; }), "fov_y_deg"},
            {"near_0", refused_camera([](Camera& c) { c.near_m = 0; }), "near_m"},
            {"near_negative", refused_camera([](Camera& c) { c.near_m = -1; }), "near_m"},
            {"near_infinite", refused_camera([](Camera& c) { c.near_m = inf; }), "near_m"},
            {"far_before_near",
             refused_camera([](Camera& c) { c.projection = Projection::orthographic, c.near_m = 5, c.far_m = 5; }),
             "far_m"},
            {"position_nan", refused_camera([](Camera& c) { c.position_ws.x = nan; }), "position"},
            {"looks_at_itself", refused_camera([](Camera& c) { c.target_ws = c.position_ws; }), "target"},
            {"up_along_the_axis", refused_camera([](Camera& c) { c.up_ws = c.target_ws - c.position_ws; }), "up"},
            {"no_pixels", refused_camera([](Camera&) {}, {0, 64}), "size_px"}};
}

} // namespace

CaseFamily camera_cases()
{
    return {"camera",
            {narrow_and_wide(), odd_width(), off_centre(), near_plane_near_and_far(), orthographic(),
             orthographic_along_the_axis(), orthographic_scene()},
            refused()};
}

} // namespace ssrlab
