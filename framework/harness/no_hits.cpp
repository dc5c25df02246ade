#include "harness/no_hits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

/// The least of 1, 2, 5, 10, 20 … that is not below the diagonal of the scene's bounds; 0 for a frame without triangles.
double round_extent_m(const Scene& scene)
{
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    for (const Draw& draw : scene.draws) {
        low  = glm::min(low, draw.bounds_min_ws);
        high = glm::max(high, draw.bounds_max_ws);
    }
    if (!(low.x <= high.x)) return 0;
    const double extent_m = std::max<double>(glm::length(high - low), 1e-6);
    const double power    = std::pow(10.0, std::floor(std::log10(extent_m)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= extent_m) return factor * power;
    return 10 * power;
}

} // namespace

std::string no_hits_text(const Technique& technique, const TraceSettings& settings, const Scene& scene,
                         const TraceCounts& counts)
{
    if (1000 * size_t(counts.hits) >= counts.rays || std::ranges::count(technique.limits, "point_sampled") == 0)
        return "";
    const double extent_m = round_extent_m(scene);
    std::string  text = fmt::format("warning: {}: {} of {} rays hit. It sees the depth buffer only at its samples. ",
                                    technique.id, counts.hits, counts.rays);
    if (settings.thickness_m <= 0) return text + "A sample needs a thickness to hit: -p thickness_m=0.1";
    if (extent_m > 0 && settings.max_distance_m <= extent_m)
        return text + "They may lie too far apart: take more steps, or a larger thickness_m";
    text += fmt::format("With max_distance_m = {} they may lie too far apart", settings.max_distance_m);
    return text + (extent_m > 0 ? fmt::format(": -p max_distance_m={} is about the scene's size", extent_m) : "");
}

} // namespace ssrlab
