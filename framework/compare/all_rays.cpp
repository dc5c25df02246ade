#include "compare/all_rays.h"

#include "core/error.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

std::optional<double> ratio(double part, size_t whole)
{
    return whole > 0 ? std::optional(part / double(whole)) : std::nullopt;
}

/// Width of 1 px at a point of view space.
double footprint_m(const View& view, glm::dvec3 point_vs)
{
    const double focal_px = std::min(view.focal_px.x, view.focal_px.y);
    if (view.projection == Projection::orthographic) return 1 / focal_px;
    return std::max(glm::length(point_vs), view.near_m) / focal_px;
}

} // namespace

bool meets_geometry(TruthClass cls)
{
    return cls != TruthClass::not_traced && cls != TruthClass::sky && cls != TruthClass::beyond;
}

double allowed_distance_m(const SceneTruth& truth, const GBufferImage& gbuffer, size_t pixel)
{
    const View&      view     = gbuffer.view;
    const glm::dvec3 point_vs = truth.point_vs[pixel];
    const glm::dvec3 from_vs =
        px_to_vs(view, glm::dvec2(pixel_at(pixel, view.size_px)) + 0.5, double(gbuffer.depth[pixel]));
    const glm::dvec3 sight = view.projection == Projection::perspective ? point_vs : glm::dvec3(0, 0, -1);
    const glm::dvec3 ray   = point_vs - from_vs;
    const double     sizes = glm::length(sight) * glm::length(ray);
    const double     sine  = sizes > 0 ? glm::length(glm::cross(sight, ray)) / sizes : 1;
    return footprint_m(view, point_vs) / std::max(sine, least_footprint_sine);
}

bool is_right(const RayAnswer& answer, const SceneTruth& truth, const GBufferImage& gbuffer, size_t pixel)
{
    if (answer.kind != AnswerKind::point || !meets_geometry(truth.cls[pixel])) return false;
    const auto point_vs = glm::dvec3(gbuffer.view.world_to_view * glm::dvec4(answer.point_ws, 1));
    return glm::length(point_vs - truth.point_vs[pixel]) <= allowed_distance_m(truth, gbuffer, pixel);
}

AllRays compare_all_rays(std::span<const RayAnswer> answers, const SceneTruth& truth, const GBufferImage& gbuffer)
{
    if (answers.size() != truth.cls.size() || answers.size() != gbuffer.depth.size())
        throw_failure("answers of {} pixels for a truth of {} and a G-buffer of {}", answers.size(), truth.cls.size(),
                      gbuffer.depth.size());
    AllRays counts;
    for (size_t i = 0; i < answers.size(); ++i) {
        if (truth.cls[i] == TruthClass::not_traced) continue;
        ++counts.rays;
        counts.meeting += meets_geometry(truth.cls[i]);
        counts.points += answers[i].kind == AnswerKind::point;
        counts.right += is_right(answers[i], truth, gbuffer, i);
    }
    counts.recall    = ratio(double(counts.right), counts.meeting);
    counts.precision = ratio(double(counts.right), counts.points);
    counts.f1        = ratio(2 * double(counts.right), counts.meeting + counts.points);
    return counts;
}

SourceCounts count_source(const SourceTurn& turn, const SceneTruth& truth, const GBufferImage& gbuffer)
{
    SourceCounts counts;
    for (size_t k = 0; k < turn.pixels.size(); ++k) {
        const size_t     i       = turn.pixels[k];
        const RayAnswer& answer  = turn.answers[k];
        const auto       cls     = static_cast<size_t>(truth.cls[i]);
        const bool       right   = is_right(answer, truth, gbuffer, i);
        const bool       point   = answer.kind == AnswerKind::point;
        const bool       nothing = answer.certain && answer.kind == AnswerKind::nothing;
        ++counts.handed;
        ++counts.handed_of_class[cls];
        counts.right_of_class[cls] += right;
        counts.meeting += meets_geometry(truth.cls[i]);
        counts.points += point;
        counts.right += right;
        counts.certain_points += point && answer.certain;
        counts.certain_right += right && answer.certain;
        counts.certain_nothing += nothing;
        counts.certain_nothing_right += nothing && !meets_geometry(truth.cls[i]);
    }
    return counts;
}

} // namespace ssrlab
