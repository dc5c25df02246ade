#include "check/judge.h"

#include "compare/measures.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/pixel_index.h"
#include "truth/screen_truth.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Range {
    double from = 0, to = 0;
    bool   empty() const { return !(from <= to); }
};

/// Where origin + t * delta lies in [low, high], within t.
Range clip(Range t, double origin, double delta, double low, double high)
{
    if (delta == 0) return origin >= low && origin <= high ? t : Range{1, 0};
    const double a = (low - origin) / delta, b = (high - origin) / delta;
    return {std::max(t.from, std::min(a, b)), std::min(t.to, std::max(a, b))};
}

/// The part of the segment within `margin_px` of the pixel.
Range part_in_pixel(const RayInput& ray, glm::ivec2 pixel, double margin_px)
{
    Range t{0, 1};
    for (int axis : {0, 1})
        t = clip(t, ray.origin_px_depth[axis], ray.delta_px_depth[axis], pixel[axis] - margin_px,
                 pixel[axis] + 1 + margin_px);
    return t;
}

bool on_image(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    return glm::all(glm::greaterThanEqual(pixel, glm::ivec2(0))) &&
           glm::all(glm::lessThan(pixel, gbuffer.view.size_px));
}

glm::ivec2 start_pixel(const GBufferImage& gbuffer, const RayInput& ray)
{
    return glm::clamp(glm::ivec2(glm::floor(glm::dvec2(ray.origin_px_depth))), glm::ivec2(0), gbuffer.view.size_px - 1);
}

/// Direction in view space, not normalised; as shaders/api/trace_api.glsl, direction_vs.
glm::dvec3 direction_vs(const View& view, const RayInput& ray)
{
    const auto       slope = [&](glm::dvec2 px) { return (px - view.centre_px) / view.focal_px * glm::dvec2(1, -1); };
    const glm::dvec2 from  = slope(glm::dvec2(ray.origin_px_depth)),
                     to    = slope(glm::dvec2(ray.origin_px_depth + ray.delta_px_depth));
    if (view.projection == Projection::orthographic)
        return {to - from, ray.delta_px_depth.z * (view.far_m - view.near_m)};
    const double from_depth = ray.origin_px_depth.z, to_depth = from_depth + ray.delta_px_depth.z;
    return {to * from_depth - from * to_depth, to_depth - from_depth};
}

/// 0 where one of them has no direction.
double cosine(glm::dvec3 a, glm::dvec3 b)
{
    const double lengths = glm::length(a) * glm::length(b);
    return lengths > 0 ? glm::dot(a, b) / lengths : 0;
}

double screen_length_px(const RayInput& ray) { return glm::length(glm::dvec2(ray.delta_px_depth)); }

/// A thousandth of a pixel.
double slack_t(const RayInput& ray) { return 1e-3 / std::max(screen_length_px(ray), 1e-3); }

std::string name(const RayOutcome& outcome)
{
    if (outcome.status != TraceStatus::hit) return std::string(status_name(outcome.status));
    return fmt::format("hit in ({}, {}) at t {:.9g}", outcome.hit_pixel.x, outcome.hit_pixel.y, outcome.t);
}

} // namespace

double depth_inside_px(const RayInput& ray, const Visit& visit)
{
    const auto inside = [&](double t) {
        const glm::dvec2 p =
            glm::dvec2(ray.origin_px_depth) + t * glm::dvec2(ray.delta_px_depth) - glm::dvec2(visit.pixel);
        return std::min({p.x, 1 - p.x, p.y, 1 - p.y});
    };
    // Concave in t: ternary search.
    double from = visit.t_in, to = visit.t_out;
    for (int i = 0; i < 60; ++i) {
        const double a = from + (to - from) / 3, b = to - (to - from) / 3;
        (inside(a) < inside(b) ? from : to) = inside(a) < inside(b) ? a : b;
    }
    return inside(0.5 * (from + to));
}

Claim claim_of(const Technique& technique)
{
    return {std::ranges::count(technique.limits, "point_sampled") > 0,
            std::ranges::count(technique.limits, "stops_behind_objects") > 0,
            std::ranges::count(technique.limits, "tests_whole_steps") > 0};
}

Judge::Judge(const Setup& setup) : setup_(setup) {}

Visit Judge::visit(const RayInput& ray, glm::ivec2 pixel, double t_in, double t_out) const
{
    Visit visit{pixel, t_in, t_out};
    visit.z_in         = ray.origin_px_depth.z + t_in * ray.delta_px_depth.z;
    visit.z_out        = ray.origin_px_depth.z + t_out * ray.delta_px_depth.z;
    const double depth = static_cast<double>(setup_.gbuffer.depth[pixel_index(pixel, setup_.gbuffer.view.size_px)]);
    visit.contact      = -infinity;
    if (!(depth > 0 && depth <= 1)) return visit;
    visit.front = depth;
    visit.back  = slab_back(setup_.gbuffer.view, depth, setup_.settings);
    visit.contact =
        std::min(visit.front - std::min(visit.z_in, visit.z_out), std::max(visit.z_in, visit.z_out) - visit.back);
    if (setup_.settings.behind != Behind::hit)
        visit.facing = cosine(glm::dvec3(setup_.gbuffer.normal_vs[pixel_index(pixel, setup_.gbuffer.view.size_px)]),
                              direction_vs(setup_.gbuffer.view, ray));
    return visit;
}

std::vector<Visit> Judge::walk(const RayInput& ray) const
{
    std::vector<Visit> visits;
    glm::ivec2         pixel = start_pixel(setup_.gbuffer, ray), step(0);
    glm::dvec2         inverse(0);
    for (int axis : {0, 1}) {
        const double delta = ray.delta_px_depth[axis];
        if (delta == 0 || !std::isfinite(1.0 / delta)) continue;
        step[axis]    = delta > 0 ? 1 : -1;
        inverse[axis] = 1.0 / delta;
    }
    const auto border_t = [&](int axis) {
        if (step[axis] == 0) return infinity;
        return (pixel[axis] + (step[axis] > 0 ? 1 : 0) - ray.origin_px_depth[axis]) * inverse[axis];
    };
    glm::dvec2 t(border_t(0), border_t(1));
    while (std::min(t.x, t.y) < 1) {
        const double t_in = std::min(t.x, t.y);
        for (int axis : {0, 1}) pixel[axis] += t[axis] <= t_in ? step[axis] : 0;
        if (!on_image(setup_.gbuffer, pixel)) break;
        t = {border_t(0), border_t(1)};
        visits.push_back(visit(ray, pixel, t_in, std::min({t.x, t.y, 1.0})));
    }
    return visits;
}

RayOutcome Judge::exact_answer(const RayInput& ray) const
{
    RayOutcome answer;
    answer.status = ray.end_status;
    for (const Visit& v : walk(ray)) {
        ++answer.steps;
        if (v.contact >= 0 && !v.faces()) answer.status = TraceStatus::facing_away;
        if (!(v.contact >= 0) || !v.faces()) continue;
        const bool   inside = v.z_in <= v.front && v.z_in >= v.back;
        const double face   = v.z_in > v.front ? v.front : v.back;
        const double dz     = ray.delta_px_depth.z;
        answer.status       = TraceStatus::hit;
        answer.hit_pixel    = v.pixel;
        answer.t = inside || dz == 0 ? v.t_in : std::clamp((face - ray.origin_px_depth.z) / dz, v.t_in, v.t_out);
        break;
    }
    return answer;
}

/// What rounding to float can change of a comparison of depths along this ray.
double Judge::depth_rounding(const RayInput& ray, const Visit& v) const
{
    return 0x1p-21 * (std::abs(ray.origin_px_depth.z) + std::abs(ray.delta_px_depth.z) + v.front);
}

bool Judge::surely_touches(const RayInput& ray, const Visit& v) const
{
    return v.contact > depth_rounding(ray, v) && depth_inside_px(ray, v) > sliver_px;
}

/// Rounding could make the ray touch this pixel's surface, or a step that reaches `more_t` farther does.
bool Judge::may_touch(const RayInput& ray, const Visit& v, double more_t) const
{
    const Range t = part_in_pixel(ray, v.pixel, sliver_px);
    if (t.empty()) return false;
    const Visit wider = visit(ray, v.pixel, std::max(t.from - more_t, 0.0), std::min(t.to + more_t, 1.0));
    return wider.contact >= -depth_rounding(ray, wider);
}

/// A hit must lie in a pixel that the ray crosses, where it touches the slab (or, if so claimed, would touch it within a step); slivers count
/// as crossing.
std::string Judge::unsound_hit(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    const Range t = part_in_pixel(ray, outcome.hit_pixel, sliver_px);
    if (t.empty() || !on_image(setup_.gbuffer, outcome.hit_pixel))
        return fmt::format("{}, a pixel that the ray does not cross", name(outcome));
    const double step = claim.may_hit_within_a_step && outcome.steps > 0 ? outcome.t / outcome.steps : 0;
    const Visit  v    = visit(ray, outcome.hit_pixel, std::max(t.from - step, 0.0), std::min(t.to + step, 1.0));
    if (!(v.contact >= -depth_rounding(ray, v)))
        return fmt::format("{}, where the ray's depth {:.9g} … {:.9g} does not meet the slab {:.9g} … {:.9g}",
                           name(outcome), v.z_in, v.z_out, v.front, v.back);
    if (v.facing > facing_rounding)
        return fmt::format("{}, whose surface faces away from the ray (cosine {:.6g})", name(outcome), v.facing);
    if (outcome.t < t.from - slack_t(ray) || outcome.t > t.to + slack_t(ray))
        return fmt::format("{}, but the ray is in that pixel from {:.9g} to {:.9g}", name(outcome), t.from, t.to);
    return {};
}

/// A ray without a hit must say whether it touched a surface that faces away.
std::string Judge::unsound_end(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    const std::vector<Visit> visits = walk(ray);
    if (outcome.status == TraceStatus::facing_away) {
        const double more_t = claim.may_hit_within_a_step ? 1 : 0; // how long its steps were, a miss does not say
        const bool   any    = std::ranges::any_of(
                 visits, [&](const Visit& v) { return v.facing > -facing_rounding && may_touch(ray, v, more_t); });
        return any ? "" : "ends as facing_away, but touches no surface that faces away";
    }
    if (outcome.status == TraceStatus::out_of_steps || claim.may_miss_between_samples || claim.may_miss_behind_objects)
        return "";
    const auto away = std::ranges::find_if(
        visits, [&](const Visit& v) { return v.facing > facing_rounding && surely_touches(ray, v); });
    if (away == visits.end()) return "";
    return fmt::format("ends as {}, but touches the surface in ({}, {}), which faces away", name(outcome),
                       away->pixel.x, away->pixel.y);
}

Judgement Judge::judge(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    const RayOutcome exact = exact_answer(ray);
    const bool       hit = outcome.status == TraceStatus::hit, both_hit = hit && exact.status == TraceStatus::hit;
    Judgement        result;
    result.findable = exact.status == TraceStatus::hit;
    if (both_hit) result.deviation_px = std::abs(outcome.t - exact.t) * screen_length_px(ray);
    result.reason = hit ? unsound_hit(ray, outcome, claim) : unsound_end(ray, outcome, claim);
    if (!result.reason.empty()) {
        result.verdict = Verdict::wrong;
        return result;
    }
    result.found = both_hit && (outcome.hit_pixel == exact.hit_pixel || result.deviation_px <= within_one_px);
    if (outcome.status == exact.status && (!both_hit || outcome.hit_pixel == exact.hit_pixel)) return result;

    // Something was skipped. Is there a pixel before the reported one that the ray undoubtedly hits?
    const bool within_limits = hit ? !unsound_hit(ray, outcome, {}).empty() : !unsound_end(ray, outcome, {}).empty();
    result.verdict  = within_limits || outcome.status == TraceStatus::out_of_steps ? Verdict::allowed : Verdict::sliver;
    bool was_behind = false;
    for (const Visit& v : walk(ray)) {
        if (hit && (v.pixel == outcome.hit_pixel || v.t_in >= outcome.t - slack_t(ray))) break;
        was_behind = was_behind || (v.front > 0 && std::max(v.z_in, v.z_out) < v.back);
        if (!(v.facing < -facing_rounding) || !surely_touches(ray, v)) continue;
        result.verdict = claim.may_miss_between_samples || (claim.may_miss_behind_objects && was_behind)
                             ? Verdict::allowed
                             : Verdict::wrong;
        if (result.verdict == Verdict::wrong)
            result.reason = fmt::format("{}, but the ray meets the slab in ({}, {}), {:.3f} px inside", name(outcome),
                                        v.pixel.x, v.pixel.y, depth_inside_px(ray, v));
        return result;
    }
    return result;
}

std::string Judge::broken_invariant(const RayInput& ray, const RayOutcome& outcome) const
{
    const Answer answer{outcome.status, outcome.hit_pixel, outcome.t, outcome.steps};
    if (const std::string what = impossible(answer, setup_.gbuffer.view.size_px, infinity); !what.empty()) return what;
    if (!std::isfinite(outcome.t)) return fmt::format("t is {}", outcome.t);
    if (outcome.status != TraceStatus::hit) {
        const bool possible = outcome.status == ray.end_status || outcome.status == TraceStatus::out_of_steps ||
                              (outcome.status == TraceStatus::facing_away && setup_.settings.behind == Behind::pass) ||
                              (outcome.status == TraceStatus::stopped && setup_.settings.behind == Behind::stop);
        return possible ? "" : fmt::format("ends as {}, which this ray cannot", name(outcome));
    }
    if (outcome.hit_pixel == start_pixel(setup_.gbuffer, ray)) return fmt::format("{}, its start pixel", name(outcome));
    return {};
}

} // namespace ssrlab
