// Hard cases, family "scale": the same scene in millimetres and megametres.
#include "check/hard_case.h"

#include <cmath>

namespace ssrlab {
namespace {

Setup room(double scale, const std::string& label = {})
{
    const View view = bench_view({96, 64}, 0.1 * scale);
    return {label,
            picture_of(view,
                       {plane(glm::dvec3(0, -1, 0) * scale, {0, 1, 0}), plane(glm::dvec3(0, 0, -10) * scale, {0, 0, 1}),
                        sphere(glm::dvec3(0.7, -0.2, -5) * scale, 0.8 * scale),
                        box(glm::dvec3(-2, -1, -6) * scale, glm::dvec3(-1.7, 1.5, -5.7) * scale)}),
            boxes({.thickness_m = 0.5 * scale, .max_distance_m = 100 * scale}),
            {}};
}

Relation doubled(int times)
{
    return {.name = fmt::format("all lengths times 2^{}", times), .change = [=](Setup setup) {
                for (double* length : {&setup.gbuffer.view.near_m, &setup.gbuffer.view.far_m,
                                       &setup.settings.thickness_m, &setup.settings.max_distance_m})
                    *length = std::ldexp(*length, times);
                return setup;
            }};
}

HardCase powers_of_two()
{
    return {.name   = "powers_of_two",
            .breaks = "any absolute epsilon, anywhere",
            .answer = "Depth has no unit. Doubling every length changes no mantissa: the same bits for 2^-40 … 2^40.",
            .setups = [] { return std::vector{room(1)}; },
            .relations = {doubled(-40), doubled(-13), doubled(-1), doubled(20), doubled(40)}};
}

HardCase millimetres_to_megametres()
{
    return {.name   = "millimetres_to_megametres",
            .breaks = "epsilons tuned for metres",
            .answer = "The screen truth, from a tenth of a millimetre to a million metres.",
            .setups = [] {
                std::vector<Setup> setups;
                for (const double scale : {1e-4, 1e-2, 1.0, 1e3, 1e6})
                    setups.push_back(room(scale, fmt::format("a room of {} m", 10 * scale)));
                return setups;
            }};
}

} // namespace

CaseFamily scale_cases() { return {"scale", {powers_of_two(), millimetres_to_megametres()}}; }

} // namespace ssrlab
