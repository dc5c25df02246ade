// Every error measure of a record. One table says what each means; the functions below compute the values.
#pragma once

#include "compare/flip.h"
#include "compare/ssim.h"
#include "core/gbuffer_image.h"
#include "core/image.h"
#include "core/trace_image.h"
#include "core/truth_class.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

struct Measure {
    std::string_view name;    // also the CSV column
    std::string_view unit;    // "share" is 0..1
    std::string_view formula; // in words, exactly
    std::string_view source;
};

/// Returns all measures in the order of the CSV's columns.
std::span<const Measure> measures();

/// Values by Measure::name; nullopt if there is none (no rays, no truth, identical images …), never NaN.
using MeasureValues = std::map<std::string_view, std::optional<double>>;

/// Returns part / whole; nullopt if `whole` is 0.
std::optional<double> share(size_t part, size_t whole);

/// Returns every measure of the table without a value.
MeasureValues no_measures();

/// Overwrites `values` with every value that `more` has.
void merge(MeasureValues& values, const MeasureValues& more);

/// Returns the table as Markdown.
std::string measures_markdown();

/// Returns traced_rays and the measures that begin with "screen_".
MeasureValues compare_to_screen_truth(const TraceImage& tested, const TraceImage& screen_truth);

/// Returns recall, precision, false hits, misses by cause, shares of classes. The screen truth may be null.
MeasureValues compare_to_scene_truth(const TraceImage& tested, const SceneTruth& scene_truth,
                                     const TraceImage* screen_truth, const GBufferImage& gbuffer);

/// Returns the share of traced pixels whose drawn depth lies on no surface of the scene.
MeasureValues compare_depth_to_scene(const SceneTruth& scene_truth);

/// Returns what the pass hidden_layer adds. `first` and `second` are the results in each depth layer.
MeasureValues compare_hidden_layer(const TraceImage& first, const TraceImage& second, const SceneTruth& scene_truth);

/// Returns not_finite: pixels of the finished picture, or of its G-buffer (null: not looked at), with a value that is
/// NaN or infinite. Gradients and motion vectors may be NaN where they are not known.
MeasureValues count_not_finite(const Image& picture, const GBufferImage* gbuffer);

/// Returns mean and largest work per ray, and the work of rays that run in groups.
MeasureValues count_work(const TraceImage& result);

/// Returns the traced rays per million whose status differs, or whose pixel differs if both hit.
std::optional<double> count_flips(const TraceImage& float_result, const TraceImage& double_result);

/// Returns flips_per_million and the three errors of the split. For null pointers, what needs them stays empty.
MeasureValues split_error(const TraceImage& float_result, const TraceImage* double_result,
                          const TraceImage* screen_truth, const SceneTruth* scene_truth);

/// A reference picture, prepared to judge many pictures. Throws Failure unless it has three channels. `halves`: two
/// pictures with independent noise, whose mean it is; empty if it has no noise.
struct Reference {
    explicit Reference(const Image& linear_radiance, std::span<const Image> halves = {});

    Image              display; // sRGB-encoded
    SsimView           ssim;
    FlipView           flip;
    std::vector<float> noise; // of each pixel: expected square of the error of `display`, sum over channels; or empty
};

/// Returns the measures of linear reflections: "reflective" over traced pixels, "visible" over those with a visible
/// point.
MeasureValues compare_images(const Image& tested, const Reference& reference, const SceneTruth& scene_truth);

/// Returns the measures that begin with "picture_": a finished picture against the one with the true reflection.
MeasureValues compare_pictures(const Image& tested, const Reference& reference, const SceneTruth& scene_truth,
                               const GBufferImage& gbuffer);

/// Returns FLIP of a finished picture against that reference, for each reflecting pixel, in false colours.
Image flip_of_picture(const Image& tested, const Reference& reference, const SceneTruth& scene_truth);

/// Returns disocclusion_share and reprojection_unknown_share.
MeasureValues count_disocclusions(const ReprojectionTruth& truth);

/// Returns the measures that begin with "surface_motion_error". `found_px`, here and below: for each pixel,
/// the displacement without jitter to where its reflection was, as a reprojection found it; NaN if unknown.
MeasureValues compare_surface_motion(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                                     const TraceImage& traced, const SceneTruth& scene_truth);

/// Returns reprojection_found_share and the measures that begin with "reprojection_error".
MeasureValues compare_reprojection(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                                   const TraceImage& traced, const SceneTruth& scene_truth);

/// Frames over which a ghost is looked for behind a moving edge.
inline constexpr int ghost_frames = 8;

/// Returns ghosting_rmse. `earlier`: the truth over `ghost_frames` frames, or since the sequence began.
MeasureValues compare_ghosts(const Image& tested, const Reference& reference, const ReprojectionTruth& earlier,
                             const SceneTruth& scene_truth);

/// Returns converged_rmse of a finished picture.
MeasureValues compare_converged(const Image& tested, const Reference& converged, const SceneTruth& scene_truth);

/// Where each ray of a frame hit, without jitter: kept to compare the next frame with it.
struct HitPlaces {
    std::vector<glm::vec2> px; // NaN: traced, without hit; infinite: not traced
};
HitPlaces hit_places(const TraceImage& traced, glm::dvec2 jitter_px);

struct Flips {
    size_t flips = 0, rays = 0; // rays traced in both frames
};
Flips count_changes(const HitPlaces& before, const HitPlaces& now);

/// Sums over the pictures of a sequence, per pixel, of the display luma.
struct TemporalMoments {
    std::vector<float> sum, sum_of_squares;
    std::vector<int>   count;
};
/// Adds the reflecting pixels of a picture.
void add_picture(TemporalMoments& moments, const Image& linear_radiance, const TraceImage& traced);
/// Returns the root of the mean variance over time, over pixels that reflect in all `frames` pictures (at least two).
std::optional<double> temporal_rms(const TemporalMoments& moments, int frames);

/// Returns the reference reflection: the radiance of the scene truth where traced, black elsewhere; channels R, G, B.
Image reference_image(const SceneTruth& scene_truth);

/// Hits on a pixel lattice are often exactly 1 or 4 px apart, and rounding must not decide.
inline constexpr double within_one_px  = 1 + 1e-3;
inline constexpr double within_four_px = 4 + 1e-3;

/// Returns the larger of |dx| and |dy|. Two points of one pixel are never more than 1 apart.
double screen_distance_px(glm::dvec2 a, glm::dvec2 b);

} // namespace ssrlab
