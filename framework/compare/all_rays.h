// Measures over all reflected rays that meet geometry, whether the frame shows the met point or not.
//
// An answer is right if it names a point and the true point lies within the footprint of 1 px of it, in the scene:
//   distance(answer, truth) <= footprint_m / max(sin(angle), least_footprint_sine)
// footprint_m is the width that 1 px covers at the true point's distance from the eye (orthographic: everywhere the
// same). `angle` is the one between the ray and the line of sight at the true point: both points lie on the ray, and
// along a ray that runs toward the eye or away from it 1 px covers more. No pixel is taken to cover more than 1 /
// least_footprint_sine footprints of a ray. A point that is nearer to the eye than the near plane has the footprint at
// the near plane.
#pragma once

#include "core/gbuffer_image.h"
#include "core/ray_answer.h"
#include "core/truth_class.h"

#include <array>
#include <optional>
#include <span>

namespace ssrlab {

inline constexpr double least_footprint_sine = 0.1;

/// How far from the true point of a pixel's ray an answer may lie, in metres. The class must be one that
/// meets_geometry().
double allowed_distance_m(const SceneTruth& truth, const GBufferImage& gbuffer, size_t pixel);

/// Returns whether the class means a point within the maximum distance.
bool meets_geometry(TruthClass cls);

bool is_right(const RayAnswer& answer, const SceneTruth& truth, const GBufferImage& gbuffer, size_t pixel);

/// Measures over all rays; a share is nullopt if there is nothing to count.
struct AllRays {
    size_t                rays    = 0; // traced
    size_t                meeting = 0; // of those, rays that truly meet geometry
    size_t                points  = 0; // answered by a point
    size_t                right   = 0;
    std::optional<double> recall, precision, f1;
};

/// answers: one per pixel, row-major.
AllRays compare_all_rays(std::span<const RayAnswer> answers, const SceneTruth& truth, const GBufferImage& gbuffer);

/// The answers of one source, before merging.
struct SourceCounts {
    size_t handed         = 0; // rays that it was asked about
    size_t meeting        = 0; // of those, rays that truly meet geometry
    size_t points         = 0; // answered by a point
    size_t right          = 0;
    size_t certain_points = 0, certain_right = 0;
    size_t certain_nothing = 0, certain_nothing_right = 0; // right: sky, or beyond the maximum distance
    std::array<size_t, truth_class_names.size()> handed_of_class{}, right_of_class{};
};

SourceCounts count_source(const SourceTurn& turn, const SceneTruth& truth, const GBufferImage& gbuffer);

} // namespace ssrlab
