// Hard cases, family "parameter": settings and parameters at the ends of their ranges, and beyond.
#include "check/hard_case.h"
#include "harness/experiment.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Setup yard(const TraceSettings& settings, const std::string& label)
{
    return {label,
            picture_of(bench_view({96, 64}), {plane({0, -1, 0}, {0, 1, 0}), plane({0, 0, -10}, {0, 0, 1}),
                                              sphere({0.7, -0.2, -5}, 0.8), box({-2, -1, -6}, {-1.9, 1.5, -5.9})}),
            settings,
            {}};
}

HardCase thickness()
{
    return {.name   = "thickness",
            .breaks = "0 leaves only exact contact, infinity overflows, tiny values vanish beside 1",
            .answer = "The screen truth for 0, 1e-30, 1e-6 m and infinity.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const double m : {0.0, 1e-30, 1e-6, infinity})
                    setups.push_back(yard(boxes({.thickness_m = m, .max_distance_m = 100}), fmt::format("{} m", m)));
                return setups;
            }};
}

HardCase maximum_distance()
{
    return {.name   = "maximum_distance",
            .breaks = "0 divides by 0, infinity multiplies 0",
            .answer = "The screen truth for 1e-6, 0.1, 3 m and infinity.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const double m : {1e-6, 0.1, 3.0, infinity})
                    setups.push_back(yard(boxes({.thickness_m = 0.5, .max_distance_m = m}), fmt::format("{} m", m)));
                return setups;
            }};
}

HardCase rays_of_no_length()
{
    return {.name   = "rays_of_no_length",
            .breaks = "a segment of length 0: 0/0 in every formula",
            .answer = "Maximum distance 0, or an offset beyond the end: visits nothing, ends as its segment says.",
            .setups =
                [] {
                    return std::vector{
                        yard(boxes({.thickness_m = 0.5, .max_distance_m = 0}), "maximum distance 0"),
                        yard(boxes({.thickness_m = 0.5, .max_distance_m = 5, .ray_offset_m = 5}),
                             "offset = maximum distance"),
                        yard(boxes({.thickness_m = 0.5, .max_distance_m = 5, .ray_offset_m = 1e6}), "offset 1e6 m")};
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                return Expected{.status = ray.end_status};
            },
            .most_steps = [](const Setup&) { return 1; }};
}

HardCase ray_offset()
{
    return {.name   = "ray_offset",
            .breaks = "the start pixel is no longer the reflecting one, and may lie on a border",
            .answer = "The screen truth of the rays that start 1e-6, 0.01 and 2 m along their way.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const double m : {1e-6, 0.01, 2.0})
                    setups.push_back(yard(boxes({.thickness_m = 0.5, .max_distance_m = 100, .ray_offset_m = m}),
                                          fmt::format("{} m", m)));
                return setups;
            }};
}

/// Every parameter that bounds the iterations set to `budget`, or as near as its range allows.
HardCase budget(const std::string& name, double steps)
{
    return {.name   = name,
            .breaks = "running out of steps reported as a hit where the ray stopped, or as a plain miss",
            .answer = "Either the full answer or out_of_steps; never another hit.",
            .setups = [] { return std::vector{yard(boxes({.thickness_m = 0.5, .max_distance_m = 100}), {})}; },
            .adjust =
                [=](const Technique& technique, ParameterValues& values) {
                    for (const std::string& bound : technique.bounded_by) {
                        const Parameter& parameter = find_parameter(technique, bound, "hard case " + name);
                        values[bound]              = std::clamp(steps, parameter.min, parameter.max);
                    }
                }};
}

/// Every parameter that does not bound the iterations at an end of its range.
HardCase all_at(const std::string& name, bool maximum)
{
    return {.name   = name,
            .breaks = "levels above the pyramid's top, strides longer than the image, factors of 0",
            .answer = "What the technique claims holds at both ends of every parameter's range.",
            .setups = [] { return std::vector{yard(boxes({.thickness_m = 0.5, .max_distance_m = 100}), {})}; },
            .adjust =
                [=](const Technique& technique, ParameterValues& values) {
                    for (const Parameter& parameter : technique.parameters)
                        if (std::ranges::count(technique.bounded_by, parameter.name) == 0)
                            values[parameter.name] = maximum ? parameter.max : parameter.min;
                }};
}

std::function<void()> refused_setting(const std::string& name, double value)
{
    return [=] {
        for (const Setting& setting : all_settings(load_catalogue()))
            if (setting.name == name) check_parameter(setting, value, "hard case");
    };
}

std::vector<RefusedCase> refused()
{
    constexpr double         nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<RefusedCase> cases;
    for (const std::string name : {"thickness_m", "max_distance_m", "ray_offset_m"}) {
        cases.push_back({name + "_negative", refused_setting(name, -1), name});
        cases.push_back({name + "_nan", refused_setting(name, nan), name});
    }
    const Parameter steps{.name          = "steps",
                          .type          = ParameterType::integer,
                          .default_value = 1,
                          .min           = 1,
                          .max           = 60000,
                          .choices       = {},
                          .doc           = {}};
    for (const auto& [name, value] :
         {std::pair("steps_huge", 2147483647.0), {"steps_negative", -1.0}, {"steps_half", 2.5}, {"steps_nan", nan}})
        cases.push_back({name, [steps, value = value] { check_parameter(steps, value, "hard case"); }, "steps"});
    cases.push_back({"more_iterations_than_a_driver_allows",
                     [] {
                         Technique technique;
                         technique.id         = "slow";
                         technique.bounded_by = {"steps", "halvings"};
                         require_bounded(technique, {{"steps", 60000}, {"halvings", 64}});
                     },
                     "60064"});
    return cases;
}

} // namespace

CaseFamily parameter_cases()
{
    return {"parameter",
            {thickness(), maximum_distance(), rays_of_no_length(), ray_offset(), budget("no_steps", 0),
             budget("one_step", 1), budget("seven_steps", 7), all_at("parameters_at_their_minimum", false),
             all_at("parameters_at_their_maximum", true)},
            refused()};
}

} // namespace ssrlab
