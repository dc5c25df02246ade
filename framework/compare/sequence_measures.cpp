// Measures of what changes from frame to frame.
#include "compare/image_filter.h"
#include "compare/measures.h"
#include "core/error.h"
#include "core/pixel_index.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double same_hit_px = 2; // half a pixel of jitter moves a hit by about one

bool disoccluded(ReprojectionClass cls)
{
    return cls == ReprojectionClass::hidden || cls == ReprojectionClass::off_screen;
}

/// Whether a ray found its true point.
bool is_right(const TraceImage& traced, const SceneTruth& scene_truth, size_t i)
{
    return traced.status[i] == TraceStatus::hit && scene_truth.cls[i] == TruthClass::visible &&
           screen_distance_px(glm::dvec2(traced.hit_px_depth[i]), scene_truth.point_px[i]) <= within_one_px;
}

/// Of rays that were right and whose reflection the frame before showed.
struct VectorErrors {
    size_t              rays = 0;
    std::vector<double> px; // of those with a vector
};

VectorErrors vector_errors(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                           const TraceImage& traced, const SceneTruth& scene_truth)
{
    require_same_size(traced.size_px, truth.size_px);
    require_same_size(scene_truth.size_px, truth.size_px);
    VectorErrors errors;
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        if (truth.cls[i] != ReprojectionClass::seen || !is_right(traced, scene_truth, i)) continue;
        ++errors.rays;
        const glm::dvec2 found(found_px[i]);
        if (!std::isnan(found.x)) errors.px.push_back(screen_distance_px(found, truth.displacement_px[i]));
    }
    return errors;
}

} // namespace

MeasureValues count_disocclusions(const ReprojectionTruth& truth)
{
    size_t rays = 0, unknown = 0, unseen = 0;
    for (const ReprojectionClass cls : truth.cls) {
        rays += cls != ReprojectionClass::not_reflecting;
        unknown += cls == ReprojectionClass::unknown;
        unseen += disoccluded(cls);
    }
    return {{"reprojection_unknown_share", share(unknown, rays)},
            {"disocclusion_share", share(unseen, rays - unknown)}};
}

MeasureValues compare_surface_motion(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                                     const TraceImage& traced, const SceneTruth& scene_truth)
{
    const VectorErrors errors = vector_errors(found_px, truth, traced, scene_truth);
    if (errors.px.empty()) return {};
    return {{"surface_motion_error_median_px", quantile(errors.px, 0.5)},
            {"surface_motion_error_p95_px", quantile(errors.px, 0.95)}};
}

MeasureValues compare_reprojection(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                                   const TraceImage& traced, const SceneTruth& scene_truth)
{
    const VectorErrors errors = vector_errors(found_px, truth, traced, scene_truth);
    MeasureValues      values = {{"reprojection_found_share", share(errors.px.size(), errors.rays)}};
    if (errors.px.empty()) return values;
    values["reprojection_error_median_px"] = quantile(errors.px, 0.5);
    values["reprojection_error_p95_px"]    = quantile(errors.px, 0.95);
    return values;
}

HitPlaces hit_places(const TraceImage& traced, glm::dvec2 jitter_px)
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    HitPlaces       places;
    for (size_t i = 0; i < traced.status.size(); ++i) {
        if (traced.status[i] == TraceStatus::hit)
            places.px.emplace_back(glm::dvec2(traced.hit_px_depth[i]) - jitter_px);
        else
            places.px.emplace_back(traced.status[i] == TraceStatus::not_traced ? infinity : nan);
    }
    return places;
}

Flips count_changes(const HitPlaces& before, const HitPlaces& now)
{
    if (before.px.size() != now.px.size()) throw_failure("frames of different sizes cannot be compared");
    Flips flips;
    for (size_t i = 0; i < now.px.size(); ++i) {
        const glm::dvec2 a(before.px[i]), b(now.px[i]);
        if (std::isinf(a.x) || std::isinf(b.x)) continue;
        ++flips.rays;
        const bool both = !std::isnan(a.x) && !std::isnan(b.x);
        flips.flips += std::isnan(a.x) != std::isnan(b.x) || (both && screen_distance_px(a, b) > same_hit_px);
    }
    return flips;
}

void add_picture(TemporalMoments& moments, const Image& linear_radiance, const TraceImage& traced)
{
    const size_t pixels = traced.status.size();
    moments.sum.resize(pixels);
    moments.sum_of_squares.resize(pixels);
    moments.count.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) {
        if (traced.status[i] == TraceStatus::not_traced) continue;
        const float* rgb  = &linear_radiance.values[3 * i];
        const float  luma = 0.2126F * linear_to_srgb(rgb[0]) + 0.7152F * linear_to_srgb(rgb[1]) +
                           0.0722F * linear_to_srgb(rgb[2]); // Rec. 709
        moments.sum[i] += luma;
        moments.sum_of_squares[i] += luma * luma;
        ++moments.count[i];
    }
}

std::optional<double> temporal_rms(const TemporalMoments& moments, int frames)
{
    double sum = 0, pixels = 0;
    for (size_t i = 0; i < moments.count.size(); ++i) {
        if (moments.count[i] != frames || frames < 2) continue;
        const double mean = double(moments.sum[i]) / frames;
        sum += std::max(double(moments.sum_of_squares[i]) / frames - mean * mean, 0.0);
        pixels += 1;
    }
    if (pixels == 0) return std::nullopt;
    return std::sqrt(sum / pixels);
}

} // namespace ssrlab
