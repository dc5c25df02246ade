// Hard cases, family "format": depth that was stored in 16, 24 or 32 bits, in either direction, and imported.
#include "check/depth_format.h"
#include "check/hard_case.h"

namespace ssrlab {
namespace {

std::vector<Setup> in_every_format(const Setup& setup)
{
    std::vector<Setup> setups;
    for (const DepthFormat& format : depth_formats()) {
        setups.push_back(stored_and_imported(setup, format));
        setups.back().label = format.name;
    }
    return setups;
}

HardCase stored_depth()
{
    return {
        .name   = "stored_depth",
        .breaks = "standard depth leaves few codes far away: surfaces become stairs, with rays in front of and behind "
                  "each step",
        .answer = "The screen truth on what the import gives. (What a format costs against unrounded depth: the "
                  "check's table of depth formats.)",
        .setups = [] {
            return in_every_format({{},
                                    picture_of(bench_view({96, 64}),
                                               {plane({0, -1, 0}, {0, 1, 0}), plane({0, 0, -40}, {0, 0, 1}),
                                                sphere({0.7, -0.2, -5}, 0.8), box({-2, -1, -16}, {-1.9, 1.5, -15.9})}),
                                    boxes({.thickness_m = 0.5, .max_distance_m = 100}),
                                    {}});
        }};
}

HardCase stored_floor()
{
    return {.name   = "stored_floor",
            .breaks = "rounding puts the next row of a floor in front of the grazing ray: self-intersection",
            .answer = "A floor alone reflects nothing, in any format.",
            .setups =
                [] {
                    return in_every_format({{},
                                            picture_of(bench_view({64, 256}), {plane({0, -1, 0}, {0, 1, 0})}),
                                            boxes({.thickness_m = 1, .max_distance_m = 1000}),
                                            {}});
                },
            .expected = [](const Setup&, const RayInput& ray) -> std::optional<Expected> {
                return Expected{.status = ray.end_status};
            }};
}

} // namespace

CaseFamily format_cases() { return {"format", {stored_depth(), stored_floor()}}; }

} // namespace ssrlab
