// The settings that belong to an experiment, not to a technique.
#include "harness/experiment.h"

#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

#define SSRLAB_SETTING(table, type, field, min, max, doc)                                                        \
    Setting                                                                                                      \
    {                                                                                                            \
#field, #table, doc, ParameterType::type, min, max,                                                            \
            [](const FrameSettings& settings) { return static_cast<double>(settings.table.field); },                   \
            [](FrameSettings& settings, double value) {                                                                \
                settings.table.field = static_cast<decltype(settings.table.field)>(value);                             \
            } \
    }

} // namespace

std::span<const Setting> all_settings()
{
    static const Setting table[] = {
        SSRLAB_SETTING(
            trace, real, thickness_m, 0, 1e6,
            "depth of the slab behind each pixel, in metres; with thickness_relative a fraction of the distance"),
        SSRLAB_SETTING(trace, boolean, thickness_relative, 0, 1, "whether thickness_m is a fraction of the distance"),
        SSRLAB_SETTING(trace, real, max_distance_m, 0, infinity, "length of the ray in view space"),
        SSRLAB_SETTING(trace, real, ray_offset_m, 0, 1e6, "how far along its direction the ray starts"),
        SSRLAB_SETTING(trace, boolean, facing, 0, 1, "whether a hit's surface must face the ray"),
        SSRLAB_SETTING(shade, real, metallic_exponent, 0, 64, "beta = metallic ^ exponent; 0 switches the factor off"),
        SSRLAB_SETTING(shade, boolean, fade_to_viewer, 0, 1, "whether reflections toward the viewer fade"),
        SSRLAB_SETTING(shade, boolean, fade_at_edges, 0, 1, "whether reflections of the image's border fade"),
    };
    return table;
}

} // namespace ssrlab
