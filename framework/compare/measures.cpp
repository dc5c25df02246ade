#include "compare/measures.h"

#include "core/error.h"

#include <algorithm>
#include <array>

namespace ssrlab {
namespace {

constexpr std::string_view contract   = "docs/reference/hit_contract.md";
constexpr std::string_view truth      = "framework/truth/scene_truth.h";
constexpr std::string_view before     = "framework/truth/reprojection_truth.h";
constexpr std::string_view causes     = "framework/compare/causes.h";
constexpr std::string_view own        = "ssrlab";
constexpr std::string_view beyond     = "docs/explanation/beyond.md";
constexpr std::string_view divergence = "docs/explanation/devices.md";

// px distance = the larger of |dx| and |dy| between two hit points. "Found" = the truth has a point, the technique hits, and
// their distance is at most 1 px unless another number is named.
constexpr auto table = std::to_array<Measure>({
    {"traced_rays", "rays", "pixels that reflect: depth, metallic and a usable normal", contract},
    {"steps_mean", "steps", "loop iterations per traced ray", own},
    {"steps_max", "steps", "largest number of loop iterations of a ray", own},
    {"warp32_iterations_mean", "steps",
     "longest ray's loop iterations in a group of 32 rays that follow each other in the list, mean over all "
     "groups (the last may be smaller)",
     divergence},
    {"wave64_iterations_mean", "steps", "the same in groups of 64 rays; divided by 64, wave iterations per ray",
     divergence},
    {"wave128_iterations_mean", "steps",
     "the same in groups of 128 rays, which a wave of 64 holds where an invocation traces two; divided by 128, wave "
     "iterations per ray",
     divergence},
    {"depth_fetches_mean", "fetches", "depth texels read per traced ray", own},
    {"structure_fetches_mean", "fetches", "reads of structures (such as the depth pyramid) per traced ray", own},

    {"screen_same_pixel", "share",
     "rays that hit the same pixel as the screen truth, or miss as it does, of traced rays", contract},
    {"screen_within_1px", "share",
     "rays that hit within 1 px of the screen truth's hit point, or miss as it does, of traced rays", contract},
    {"screen_displaced", "share",
     "rays that hit, as the screen truth does, but farther than 1 px from it, of traced rays", contract},
    {"screen_missed", "share", "rays without hit where the screen truth hits, of traced rays", contract},
    {"screen_false", "share", "rays that hit where the screen truth does not, of traced rays", contract},
    {"screen_out_of_steps", "share", "rays that end as out_of_steps, of traced rays", contract},
    {"screen_recall_1px", "share", "rays found within 1 px, of those that the screen truth hits", contract},
    {"screen_precision_1px", "share", "hits within 1 px of the screen truth's hit, of hits", contract},
    {"screen_f1_1px", "share", "harmonic mean of screen_recall_1px and screen_precision_1px", own},
    {"screen_displacement_median_px", "px", "median distance of hit points over rays where both hit (interpolated)",
     own},
    {"screen_displacement_p95_px", "px", "95th percentile of the same distances", own},
    {"screen_displacement_p99_px", "px", "99th percentile of the same distances", own},

    {"recall_1px", "share", "rays found within 1 px of the true point, of visible rays", truth},
    {"recall_4px", "share", "rays found within 4 px of the true point, of visible rays", truth},
    {"visible_displaced", "share", "visible rays that hit farther than 1 px from the true point, of visible rays",
     truth},
    {"missed_stepped_over", "share",
     "visible rays without hit that the screen truth finds within 1 px, of visible rays; not counted under the next "
     "two",
     own},
    {"missed_out_of_steps", "share", "visible rays that end as out_of_steps, of visible rays", own},
    {"missed_facing_rule", "share", "visible rays that end as facing_away, of visible rays", own},
    {"missed_stopped", "share", "visible rays that end as stopped, of visible rays", own},
    {"stopped_right_share", "share", "stopped rays whose true point is not visible in the frame, of stopped rays", own},
    {"missed_not_in_depth", "share",
     "all other visible rays without hit: the screen truth does not find the point either, of visible rays", own},
    {"precision_1px", "share", "hits within 1 px of a visible true point, of hits", truth},
    {"f1_1px", "share", "harmonic mean of recall_1px and precision_1px", own},
    {"hidden_too_recall_1px", "share",
     "rays found within 1 px of the true point, hidden ones in a layer behind the first, of visible and hidden rays",
     truth},
    {"hidden_too_precision_1px", "share", "the same rays, of hits", truth},
    {"hidden_too_f1_1px", "share", "harmonic mean of the two", own},
    {"false_hits", "share",
     "hits farther than 1 px from the true point, or whose true point is not visible, of traced rays", truth},
    {"false_self", "share",
     "false hits on the reflecting object at or below the reflecting point's tangent plane (sine of the angle <= "
     "0.01), where its ray cannot be, of traced rays",
     own},
    {"false_too_thick", "share",
     "other false hits where the ray is more than 0.1 % of the distance behind the pixel's surface, so that a thinner "
     "slab would let it pass, of traced rays",
     own},
    {"false_wrong_surface", "share", "all other false hits: a front that the true ray does not meet, of traced rays",
     own},
    {"wrong_rays", "share",
     "rays that miss a visible true point, or hit farther than 1 px from it, or hit where no visible point is (a "
     "hidden one counts where it is "
     "met in a layer behind the first), of traced rays",
     truth},
    {"wrong_own_surface", "share",
     "wrong rays whose mirror direction leads below the plane of their own pixel, or that end on their own object in "
     "that plane; this and the "
     "next six sum to wrong_rays, of traced rays",
     causes},
    {"wrong_not_shown", "share",
     "wrong rays that hit something behind their true point, which the frame does not show, of traced rays", causes},
    {"wrong_thin", "share",
     "wrong rays that pass a visible true point that no pixel within 3 x 3 holds, of traced rays", causes},
    {"wrong_silhouette", "share",
     "wrong rays at a pixel whose neighbour lies more than 1/32 of the distance off its plane, or whose true point a "
     "neighbour holds, of "
     "traced rays",
     causes},
    {"wrong_edge", "share",
     "wrong rays at a pixel whose neighbour lies more than 1/256 of the distance off its plane, of traced rays",
     causes},
    {"wrong_stopped", "share", "wrong rays that were stopped in the midst of a plane, of traced rays", causes},
    {"wrong_other", "share", "all other wrong rays, of traced rays", causes},
    {"truth_visible", "share", "rays whose true point this frame shows, of traced rays", truth},
    {"truth_hidden", "share", "rays whose true point lies behind something on screen, of traced rays", truth},
    {"truth_off_screen", "share", "rays whose true point is outside the image, of traced rays", truth},
    {"truth_behind_camera", "share", "rays whose true point is behind the near plane, of traced rays", truth},
    {"truth_facing_away", "share", "rays that see a side which the frame does not draw, of traced rays", truth},
    {"truth_sky", "share", "rays that meet nothing, of traced rays", truth},
    {"truth_beyond", "share", "rays whose true point is beyond the maximum distance, of traced rays", truth},
    {"depth_off_scene", "share",
     "pixels at whose drawn depth the scene has no surface, within 0.0001 of their distance, of traced rays: some lie "
     "at silhouettes; with more than 0.05 the driver draws another scene, and there is no scene truth",
     truth},

    {"all_recall", "share",
     "rays that the list of sources answers by a point within the footprint of 1 px of the true one, of rays that meet "
     "geometry within max_distance_m",
     beyond},
    {"all_precision", "share", "the same rays, of rays that it answers by a point", beyond},
    {"all_f1", "share", "harmonic mean of all_recall and all_precision", beyond},

    {"hidden_recovered_share", "share",
     "rays that the second depth layer answers within 1 px of the true point, of rays whose true point is hidden; this "
     "and the next four where the pass hidden_layer ran",
     truth},
    {"ghost_share", "share",
     "rays without hit in the first layer whose true point is visible or hidden (ghost shadows), of traced rays",
     "J. Somerville Roberts, Screen Space Reflections"},
    {"ghost_removed_share", "share", "of these, rays that hit something in the second layer", own},
    {"hidden_layer_hits", "share", "rays that hit in the second layer, of traced rays", own},
    {"hidden_layer_wrong", "share",
     "hits in the second layer farther than 1 px from a visible or hidden true point, of hits in the second layer",
     truth},

    {"flips_per_million", "rays per million",
     "rays whose status, or pixel if both hit, differs between float and double, of traced rays", own},
    {"error_scene_to_screen", "share",
     "1 - recall at 1 px of the screen truth against the scene truth's visible points: what the depth buffer does not "
     "know",
     own},
    {"error_screen_to_double", "share",
     "1 - recall at 1 px of the double twin against the screen truth's hits: what the technique skips", own},
    {"error_double_to_float", "share", "1 - recall at 1 px of the float run against the double twin's hits: rounding",
     own},

    {"rmse_visible", "display value",
     "root mean square difference of sRGB-encoded channels clamped to [0, 1], over visible rays",
     "OpenImageIO ImageBufAlgo::compare"},
    {"psnr_visible_db", "dB", "20 log10(1 / rmse_visible); empty when identical", "OpenImageIO ImageBufAlgo::compare"},
    {"ssim_visible", "index",
     "mean structural similarity of luma, Gaussian window of 11 px, sigma 1.5, over visible rays", "Wang et al. 2004"},
    {"flip_visible", "0..1", "mean LDR FLIP at 67 pixels per degree, over visible rays", "Andersson et al. 2020"},
    {"rmse_reflective", "display value", "as rmse_visible, over all traced rays", "OpenImageIO ImageBufAlgo::compare"},
    {"psnr_reflective_db", "dB", "as psnr_visible_db, over all traced rays", "OpenImageIO ImageBufAlgo::compare"},
    {"ssim_reflective", "index", "as ssim_visible, over all traced rays", "Wang et al. 2004"},
    {"flip_reflective", "0..1", "as flip_visible, over all traced rays", "Andersson et al. 2020"},

    {"picture_rmse", "display value",
     "as rmse_visible, of the finished picture against the picture with the scene truth's reflection at full weight, "
     "over pixels that reflect; the noise of that picture is taken off: root of (mean square difference - "
     "picture_noise_rmse²)",
     own},
    {"picture_rmse_low", "display value", "lower end of the 95 % interval that this noise leaves to picture_rmse", own},
    {"picture_rmse_high", "display value", "its upper end", own},
    {"picture_noise_rmse", "display value",
     "noise of the picture with the true reflection: root of the mean square of half of what the pictures by its even "
     "and its odd rays differ by",
     own},
    {"picture_psnr_db", "dB", "20 log10(1 / picture_rmse); empty when identical", own},
    {"picture_ssim", "index", "as ssim_visible, of the same pictures over the same pixels", "Wang et al. 2004"},
    {"picture_flip", "0..1", "as flip_visible, of the same pictures over the same pixels", "Andersson et al. 2020"},
    {"picture_border_rmse", "display value",
     "as picture_rmse, over those within 2 px of a surface whose metallic or roughness differs by more than 0.1; empty "
     "without any",
     own},
    {"picture_visible_rmse", "display value", "as picture_rmse, over visible rays alone", own},
    {"picture_visible_border_rmse", "display value", "as picture_border_rmse, over visible rays alone", own},

    {"not_finite", "pixels", "pixels of the finished picture or of its G-buffer with a value that is NaN or infinite",
     own},

    {"disocclusion_share", "share",
     "rays whose reflection the frame before did not show: hidden or outside the image, of rays for which this is "
     "known",
     before},
    {"reprojection_unknown_share", "share",
     "rays for which it is not known where their reflection was in the frame before (normal maps, curved mirrors "
     "without one answer), of traced rays",
     before},
    {"surface_motion_error_median_px", "px",
     "median distance between where the surface's motion vector says that a reflection was in the frame before and "
     "where it was, over rays that hit within 1 px of the true point and whose reflection the frame before showed",
     before},
    {"surface_motion_error_p95_px", "px", "95th percentile of the same distances", before},
    {"reprojection_error_median_px", "px",
     "median distance between where the reprojection says that a reflection was in the frame before and where it was, "
     "over the same rays, less those for which it says nothing; this and the next two where the reprojection ran",
     before},
    {"reprojection_error_p95_px", "px", "95th percentile of the same distances", before},
    {"reprojection_found_share", "share", "rays for which the reprojection says something, of the same rays", before},
    {"ghosting_rmse", "display value",
     "as picture_visible_rmse, behind moving edges: over rays whose reflection was hidden 8 frames before, or at the "
     "start of a younger sequence",
     before},
    {"converged_rmse", "display value",
     "as picture_rmse, against the mean of the pictures with the true reflection over all phases of the jitter; where "
     "nothing but jitter moves",
     own},
    {"history_share", "share", "pixels that took something of the history, of pixels that reflect", own},
    {"clamped_share", "share", "of these, pixels whose history the clamping changed", own},
    {"flip_share", "share",
     "rays that hit in this frame or the one before but not in both, or more than 2 px apart without the jitter, of "
     "rays traced in both; where nothing but jitter moves",
     own},
});

} // namespace

std::span<const Measure> measures() { return table; }

std::optional<double> share(size_t part, size_t whole)
{
    if (whole == 0) return std::nullopt;
    return double(part) / double(whole);
}

MeasureValues no_measures()
{
    MeasureValues values;
    for (const Measure& measure : table) values[measure.name] = std::nullopt;
    return values;
}

void merge(MeasureValues& values, const MeasureValues& more)
{
    for (const auto& [name, value] : more) {
        if (value) values[name] = value;
    }
}

std::string measures_markdown()
{
    std::string text = "| measure | unit | definition | source |\n|---|---|---|---|\n";
    for (const Measure& m : table)
        text += fmt::format("| `{}` | {} | {} | {} |\n", m.name, m.unit, m.formula, m.source);
    return text;
}

} // namespace ssrlab
