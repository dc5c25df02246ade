// Which source of a list answers the ray of one pixel, and how rightly.
#pragma once

#include "sources/source.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

/// One source's answer to one ray.
struct PixelAnswer {
    std::string           source; // with its parameters
    std::string           kind;   // point, nothing or open; empty: it was not asked, since a certain answer stands
    bool                  certain = false;
    std::optional<double> distance_m;    // of a point along the ray
    std::optional<double> off_m;         // from the true point; empty if one of them is none
    bool                  right = false; // a point within allowed_m, or nothing where the ray meets nothing
};

struct PixelSources {
    std::vector<PixelAnswer> answers;     // in the order of the list
    std::string              answered_by; // empty: the ray stays open
    std::optional<double>    allowed_m;   // how far off a right point may be; empty if the ray meets nothing
};

/// Asks the sources about all rays of the shown frame and returns their answers to one. `pixel`: index of a pixel that
/// reflects. Throws Failure for a frame file.
PixelSources ask_about_pixel(Stage& stage, const Technique& technique, const ParameterValues& values,
                             const FrameSettings& settings, const std::string& view, SequenceFrame at,
                             std::span<const ListedSource> list, size_t pixel);

void           print_pixel_sources(const PixelSources& sources);
nlohmann::json to_json(const PixelSources& sources);

} // namespace ssrlab
