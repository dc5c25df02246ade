// Measures that compare rays with rays.
#include "compare/causes.h"
#include "compare/measures.h"
#include "compare/validate_result.h"
#include "core/pixel_index.h"
#include "core/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace ssrlab {
namespace {

constexpr double behind_share = 0.001;

bool traced(const TraceImage& result, size_t i) { return result.status[i] != TraceStatus::not_traced; }
bool hits(const TraceImage& result, size_t i) { return result.status[i] == TraceStatus::hit; }

std::optional<double> known_quantile(const std::vector<double>& values, double p)
{
    if (values.empty()) return std::nullopt;
    return quantile(values, p);
}

/// Distance between the hit points of two results that both hit.
double hit_distance_px(const TraceImage& a, const TraceImage& b, size_t i)
{
    return screen_distance_px(glm::dvec2(a.hit_px_depth[i]), glm::dvec2(b.hit_px_depth[i]));
}

/// Found within 1 px, of the rays that the reference hits.
std::optional<double> recall_against(const TraceImage& tested, const TraceImage& reference)
{
    require_same_size(tested.size_px, reference.size_px);
    size_t found = 0, whole = 0;
    for (size_t i = 0; i < reference.status.size(); ++i) {
        if (!hits(reference, i)) continue;
        ++whole;
        if (hits(tested, i) && hit_distance_px(tested, reference, i) <= within_one_px) ++found;
    }
    return share(found, whole);
}

double distance_to_truth_px(const TraceImage& tested, const SceneTruth& truth, size_t i)
{
    return screen_distance_px(glm::dvec2(tested.hit_px_depth[i]), truth.point_px[i]);
}

bool finds(const TraceImage& tested, const SceneTruth& truth, size_t i, double limit_px)
{
    return truth.cls[i] == TruthClass::visible && hits(tested, i) && distance_to_truth_px(tested, truth, i) <= limit_px;
}

std::optional<double> recall_against(const TraceImage& tested, const SceneTruth& truth)
{
    require_same_size(tested.size_px, truth.size_px);
    size_t found = 0, whole = 0;
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        if (truth.cls[i] == TruthClass::visible) ++whole;
        if (finds(tested, truth, i, within_one_px)) ++found;
    }
    return share(found, whole);
}

/// Mean over groups of `width` rays that were traced one after the other, the last of which may hold fewer, of the longest one's steps.
std::optional<double> group_iterations_mean(const TraceImage& result, size_t width)
{
    if (result.traced_order.empty()) return std::nullopt;
    double sum    = 0;
    size_t groups = 0;
    for (size_t first = 0; first < result.traced_order.size(); first += width, ++groups) {
        uint32_t longest = 0;
        for (size_t i = first; i < std::min(first + width, result.traced_order.size()); ++i)
            longest = std::max(longest, result.steps[result.traced_order[i]]);
        sum += longest;
    }
    return sum / double(groups);
}

enum class FalseHit { self, too_thick, wrong_surface };

FalseHit false_hit_cause(const TraceImage& tested, const GBufferImage& gbuffer, size_t i)
{
    const View&         view      = gbuffer.view;
    const glm::ivec2    pixel     = pixel_at(i, view.size_px);
    const glm::ivec2    hit_pixel = tested.hit_pixel[i];
    const size_t        h         = pixel_index(hit_pixel, view.size_px);
    const int           layer     = tested.hit_layer[i];
    const GBufferImage& met       = layer == 0 ? gbuffer : gbuffer.layers[size_t(layer) - 1];
    const double        surface   = double(met.depth[h]);
    if (met.object_id[h] == gbuffer.object_id[i]) {
        const glm::dvec3 from_vs = px_to_vs(view, glm::dvec2(pixel) + 0.5, double(gbuffer.depth[i]));
        const glm::dvec3 to_vs   = px_to_vs(view, glm::dvec2(hit_pixel) + 0.5, surface);
        const glm::dvec3 normal  = glm::normalize(glm::dvec3(gbuffer.normal_vs[i]));
        const glm::dvec3 sight   = view.projection == Projection::perspective ? from_vs : glm::dvec3(0, 0, -1);
        const double     side    = glm::dot(normal, sight) > 0 ? -1 : 1;
        if (side * glm::dot(normal, to_vs - from_vs) <= self_hit_sine * glm::length(to_vs - from_vs))
            return FalseHit::self;
    }
    const double surface_m = depth_to_distance(view, surface);
    const double ray_m     = depth_to_distance(view, tested.hit_px_depth[i].z);
    return ray_m > surface_m * (1 + behind_share) ? FalseHit::too_thick : FalseHit::wrong_surface;
}

} // namespace

double screen_distance_px(glm::dvec2 a, glm::dvec2 b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); }

MeasureValues compare_to_screen_truth(const TraceImage& tested, const TraceImage& truth)
{
    require_same_size(tested.size_px, truth.size_px);
    require_possible(tested);
    size_t rays = 0, same_pixel = 0, within = 0, found = 0, displaced = 0, missed = 0, false_hits = 0, out_of_steps = 0;
    std::vector<double> distances;
    for (size_t i = 0; i < truth.status.size(); ++i) {
        if (!traced(truth, i)) continue;
        ++rays;
        if (tested.status[i] == TraceStatus::out_of_steps) ++out_of_steps;
        if (hits(tested, i) && hits(truth, i)) {
            const double distance_px = hit_distance_px(tested, truth, i);
            distances.push_back(distance_px);
            if (tested.hit_pixel[i] == truth.hit_pixel[i]) ++same_pixel;
            ++(distance_px <= within_one_px ? within : displaced);
            found += distance_px <= within_one_px;
        } else if (hits(truth, i)) {
            ++missed;
        } else if (hits(tested, i)) {
            ++false_hits;
        } else {
            ++same_pixel;
            ++within;
        }
    }
    const size_t true_hits = found + displaced + missed, own_hits = found + displaced + false_hits;
    return {{"traced_rays", double(rays)},
            {"screen_same_pixel", share(same_pixel, rays)},
            {"screen_within_1px", share(within, rays)},
            {"screen_displaced", share(displaced, rays)},
            {"screen_missed", share(missed, rays)},
            {"screen_false", share(false_hits, rays)},
            {"screen_out_of_steps", share(out_of_steps, rays)},
            {"screen_recall_1px", share(found, true_hits)},
            {"screen_precision_1px", share(found, own_hits)},
            {"screen_f1_1px", share(2 * found, true_hits + own_hits)},
            {"screen_displacement_median_px", known_quantile(distances, 0.5)},
            {"screen_displacement_p95_px", known_quantile(distances, 0.95)},
            {"screen_displacement_p99_px", known_quantile(distances, 0.99)}};
}

MeasureValues compare_to_scene_truth(const TraceImage& tested, const SceneTruth& truth, const TraceImage* screen_truth,
                                     const GBufferImage& gbuffer)
{
    require_same_size(tested.size_px, truth.size_px);
    if (screen_truth != nullptr) require_same_size(tested.size_px, screen_truth->size_px);
    require_same_size(tested.size_px, gbuffer.view.size_px);
    require_possible(tested);
    std::array<size_t, truth_class_names.size()> of_class{};
    size_t                                       rays = 0, hit_count = 0, found_1px = 0, found_4px = 0, displaced = 0;
    size_t                                       stepped_over = 0, out_of_steps = 0, facing_rule = 0, not_in_depth = 0;
    size_t                                       stopped = 0, missed_stopped = 0, found_hidden = 0;
    std::array<size_t, 3>                        false_hits{};
    for (size_t i = 0; i < truth.cls.size(); ++i) {
        if (truth.cls[i] == TruthClass::not_traced) continue;
        ++rays;
        ++of_class[size_t(truth.cls[i])];
        const bool visible = truth.cls[i] == TruthClass::visible;
        const bool found   = finds(tested, truth, i, within_one_px);
        found_1px += found;
        // Where something stands before the true point, the pixel's first layer is that.
        found_hidden += truth.cls[i] == TruthClass::hidden && hits(tested, i) && tested.hit_layer[i] > 0 &&
                        distance_to_truth_px(tested, truth, i) <= within_one_px;
        found_4px += finds(tested, truth, i, within_four_px);
        const bool stops = tested.status[i] == TraceStatus::stopped;
        stopped += stops;
        missed_stopped += stops && visible;
        if (hits(tested, i)) {
            ++hit_count;
            displaced += visible && !found;
            if (!found) ++false_hits[size_t(false_hit_cause(tested, gbuffer, i))];
        } else if (visible && !stops) {
            if (tested.status[i] == TraceStatus::out_of_steps)
                ++out_of_steps;
            else if (tested.status[i] == TraceStatus::facing_away)
                ++facing_rule;
            else
                ++(screen_truth != nullptr && finds(*screen_truth, truth, i, within_one_px) ? stepped_over
                                                                                            : not_in_depth);
        }
    }
    const size_t  visible   = of_class[size_t(TruthClass::visible)];
    const size_t  found_all = found_1px + found_hidden, on_screen = visible + of_class[size_t(TruthClass::hidden)];
    const size_t  wrong = std::accumulate(false_hits.begin(), false_hits.end(), size_t(0));
    MeasureValues values{{"traced_rays", double(rays)},
                         {"recall_1px", share(found_1px, visible)},
                         {"recall_4px", share(found_4px, visible)},
                         {"visible_displaced", share(displaced, visible)},
                         {"missed_stepped_over", share(stepped_over, visible)},
                         {"missed_out_of_steps", share(out_of_steps, visible)},
                         {"missed_facing_rule", share(facing_rule, visible)},
                         {"missed_stopped", share(missed_stopped, visible)},
                         {"stopped_right_share", share(stopped - missed_stopped, stopped)},
                         {"missed_not_in_depth", share(not_in_depth, visible)},
                         {"precision_1px", share(found_1px, hit_count)},
                         {"f1_1px", share(2 * found_1px, visible + hit_count)},
                         {"hidden_too_recall_1px", share(found_all, on_screen)},
                         {"hidden_too_precision_1px", share(found_all, hit_count)},
                         {"hidden_too_f1_1px", share(2 * found_all, on_screen + hit_count)},
                         {"false_hits", share(wrong, rays)},
                         {"false_self", share(false_hits[size_t(FalseHit::self)], rays)},
                         {"false_too_thick", share(false_hits[size_t(FalseHit::too_thick)], rays)},
                         {"false_wrong_surface", share(false_hits[size_t(FalseHit::wrong_surface)], rays)}};
    if (screen_truth == nullptr)
        for (const char* name : {"missed_stepped_over", "missed_not_in_depth"}) values[name].reset();
    for (const Measure& measure : measures()) {
        if (!measure.name.starts_with("truth_")) continue;
        const auto cls       = std::find(truth_class_names.begin(), truth_class_names.end(), measure.name.substr(6));
        values[measure.name] = share(of_class[size_t(cls - truth_class_names.begin())], rays);
    }
    return values;
}

MeasureValues compare_depth_to_scene(const SceneTruth& truth)
{
    return {{"depth_off_scene", off_surface_share(truth)}};
}

MeasureValues count_work(const TraceImage& result)
{
    const size_t rays =
        result.status.size() - size_t(std::count(result.status.begin(), result.status.end(), TraceStatus::not_traced));
    MeasureValues values{{"traced_rays", double(rays)}};
    const auto    mean = [&](const std::vector<uint32_t>& counts) -> std::optional<double> {
        if (counts.empty() || rays == 0) return std::nullopt;
        return std::accumulate(counts.begin(), counts.end(), 0.0) / double(rays);
    };
    values["steps_mean"]              = mean(result.steps);
    values["depth_fetches_mean"]      = mean(result.depth_fetches);
    values["warp32_iterations_mean"]  = group_iterations_mean(result, 32);
    values["wave64_iterations_mean"]  = group_iterations_mean(result, 64);
    values["wave128_iterations_mean"] = group_iterations_mean(result, 128);
    std::vector<uint32_t> structure_fetches; // empty when the result was not counted
    for (size_t i = 0; i < result.depth_fetches.size(); ++i)
        structure_fetches.push_back(structure_fetches_of(result, i));
    values["structure_fetches_mean"] = mean(structure_fetches);
    if (rays > 0 && !result.steps.empty())
        values["steps_max"] = *std::max_element(result.steps.begin(), result.steps.end());
    return values;
}

std::optional<double> count_flips(const TraceImage& a, const TraceImage& b)
{
    require_same_size(a.size_px, b.size_px);
    size_t rays = 0, flips = 0;
    for (size_t i = 0; i < a.status.size(); ++i) {
        if (!traced(a, i) && !traced(b, i)) continue;
        ++rays;
        flips += a.status[i] != b.status[i] || (hits(a, i) && a.hit_pixel[i] != b.hit_pixel[i]);
    }
    if (rays == 0) return std::nullopt;
    return 1e6 * double(flips) / double(rays);
}

MeasureValues split_error(const TraceImage& float_result, const TraceImage* double_result,
                          const TraceImage* screen_truth, const SceneTruth* scene_truth)
{
    const auto error = [](std::optional<double> recall) { return recall ? std::optional(1 - *recall) : std::nullopt; };
    MeasureValues values;
    if (screen_truth != nullptr && scene_truth != nullptr)
        values["error_scene_to_screen"] = error(recall_against(*screen_truth, *scene_truth));
    if (screen_truth != nullptr && double_result != nullptr)
        values["error_screen_to_double"] = error(recall_against(*double_result, *screen_truth));
    if (double_result != nullptr) {
        values["flips_per_million"]     = count_flips(float_result, *double_result);
        values["error_double_to_float"] = error(recall_against(float_result, *double_result));
    }
    return values;
}

} // namespace ssrlab
