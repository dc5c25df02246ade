// Stability: how answers change when the frame is sampled elsewhere or its depth is stored differently.
#pragma once

#include "trace/lab.h"

#include <string>
#include <vector>

namespace ssrlab {

/// Answers under 16 sub-pixel phases (Halton 2, 3) of a still camera in front of the yard of the family "motion".
struct JitterRow {
    std::string technique;
    size_t      pixels        = 0; // that reflect in every phase
    double      flips_percent = 0; // of all answers: hit where the pixel mostly misses, or the other way round
    double      median_spread_px =
        0; // standard deviation of a pixel's hit position over the phases in which it hits; median over pixels
    double p99_spread_px = 0;
};
JitterRow measure_jitter(Gpu& gpu, const Catalogue& catalogue, const Technique& technique);

/// Mirror rays of the perspective cases on depth that was stored in a format and imported.
struct FormatRow {
    std::string format;
    std::string technique;
    bool        deep = false; // cases whose farthest surface is beyond deep_near_planes near planes, or the others
    double      median_error        = 0; // of a pixel's distance, as a part of it
    double      p99_error           = 0;
    size_t      rays                = 0; // that start in both pictures
    double      changed_per_million = 0; // hit another pixel, or hit instead of miss, or the other way round
    double      median_moved_px     = 0; // of the hit, where the pixel changed
};
inline constexpr double deep_near_planes = 1e4;
std::vector<FormatRow>  measure_formats(Gpu& gpu, const Catalogue& catalogue, const Technique& technique);

/// Returns two tables; the second has a column for each technique.
std::string stability_markdown(const std::vector<JitterRow>& jitter, const std::vector<FormatRow>& formats);

} // namespace ssrlab
