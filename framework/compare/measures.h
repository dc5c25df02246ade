// Every error measure of a record: one table says what each means; the functions below fill in the values.
#pragma once

#include "compare/flip.h"
#include "compare/ssim.h"
#include "core/gbuffer_image.h"
#include "core/image.h"
#include "core/trace_result.h"
#include "truth/truth_class.h"

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

/// In the order of the CSV's columns.
std::span<const Measure> measures();

/// By Measure::name. Empty = has no value here (no ray to count, no truth, identical images …), never NaN.
using MeasureValues = std::map<std::string_view, std::optional<double>>;

/// Of nothing there is no share.
std::optional<double> share(size_t part, size_t whole);

/// Every measure of the table, without value.
MeasureValues no_measures();

/// Takes over every value that `more` has.
void merge(MeasureValues& values, const MeasureValues& more);

/// The table, as README text.
std::string measures_markdown();

/// The names that begin with "screen_", and traced_rays.
MeasureValues compare_to_screen_truth(const TraceResult& tested, const TraceResult& screen_truth);

/// recall, precision, false hits and misses by cause, and the share of each class. Without a screen truth (null), what needs it stays empty.
MeasureValues compare_to_scene_truth(const TraceResult& tested, const SceneTruth& scene_truth,
                                     const TraceResult* screen_truth, const GBufferImage& gbuffer);

/// At how many of the traced pixels the drawn depth is off every surface of the scene.
MeasureValues compare_depth_to_scene(const SceneTruth& scene_truth);

/// What the pass hidden_layer adds: `first` and `second` are what the rays found in each depth layer.
MeasureValues compare_hidden_layer(const TraceResult& first, const TraceResult& second, const SceneTruth& scene_truth);

/// Mean and largest work per ray, and the work of rays that run side by side.
MeasureValues count_work(const TraceResult& result);

/// Traced rays whose status, or whose pixel when both hit, differ, per million.
std::optional<double> count_flips(const TraceResult& float_result, const TraceResult& double_result);

/// flips_per_million and the three errors of the split. Pointers may be null: what needs them stays empty.
MeasureValues split_error(const TraceResult& float_result, const TraceResult* double_result,
                          const TraceResult* screen_truth, const SceneTruth* scene_truth);

/// What pictures are judged by, with all that the measures need of it: it may judge many. Throws Failure unless it has three channels.
struct Reference {
    explicit Reference(const Image& linear_radiance);

    Image    display; // sRGB-encoded
    SsimView ssim;
    FlipView flip;
};

/// "reflective": every traced pixel; "visible": those whose true point is visible. Images are linear radiance, three channels.
MeasureValues compare_images(const Image& tested, const Reference& reference, const SceneTruth& scene_truth);

/// The names that begin with "picture_": a finished picture against the one with the true reflection.
MeasureValues compare_pictures(const Image& tested, const Reference& reference, const SceneTruth& scene_truth,
                               const GBufferImage& gbuffer);

/// Where a finished picture differs from that one: FLIP of each reflecting pixel in false colours.
Image flip_of_picture(const Image& tested, const Reference& reference, const SceneTruth& scene_truth);

/// disocclusion_share and reprojection_unknown_share.
MeasureValues count_disocclusions(const ReprojectionTruth& truth);

/// The names that begin with "surface_motion_error". Here and below, `found_px`: by pixel, from the pixel to where its reflection is said
/// to have been, without jitter; NaN where nothing is said.
MeasureValues compare_surface_motion(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                                     const TraceResult& traced, const SceneTruth& scene_truth);

/// The names that begin with "reprojection_error", and reprojection_found_share.
MeasureValues compare_reprojection(std::span<const glm::vec2> found_px, const ReprojectionTruth& truth,
                                   const TraceResult& traced, const SceneTruth& scene_truth);

/// How many frames a ghost is looked for behind the edge that left it.
inline constexpr int ghost_frames = 8;

/// ghosting_rmse of a finished picture. `earlier`: the truth of `ghost_frames` frames, or of those since the sequence began.
MeasureValues compare_ghosts(const Image& tested, const Reference& reference, const ReprojectionTruth& earlier,
                             const SceneTruth& scene_truth);

/// converged_rmse of a finished picture.
MeasureValues compare_converged(const Image& tested, const Reference& converged, const SceneTruth& scene_truth);

/// Where each ray hit, without jitter: what is kept of a frame to compare the next one with it.
struct HitPlaces {
    std::vector<glm::vec2> px; // NaN: traced, without hit; infinite: not traced
};
HitPlaces hit_places(const TraceResult& traced, glm::dvec2 jitter_px);

struct Flips {
    size_t flips = 0, rays = 0; // rays traced in both frames
};
Flips count_changes(const HitPlaces& before, const HitPlaces& now);

/// By pixel, of the display luma of a sequence's pictures.
struct TemporalMoments {
    std::vector<float> sum, sum_of_squares;
    std::vector<int>   count;
};
/// Adds the pixels that reflect.
void add_picture(TemporalMoments& moments, const Image& linear_radiance, const TraceResult& traced);
/// Root of the mean variance over time, over pixels that reflect in `frames` pictures, at least two.
std::optional<double> temporal_rms(const TemporalMoments& moments, int frames);

/// The reference reflection: the scene truth's radiance where traced, black elsewhere; channels R, G, B.
Image reference_image(const SceneTruth& scene_truth);

/// "Within 1 px" and "within 4 px": hits on a lattice of pixels are often exactly as far apart, and rounding must not decide.
inline constexpr double within_one_px  = 1 + 1e-3;
inline constexpr double within_four_px = 4 + 1e-3;

/// Largest of |dx| and |dy|: two points of one pixel are never more than 1 apart.
double screen_distance_px(glm::dvec2 a, glm::dvec2 b);

} // namespace ssrlab
