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

// Of a pixel that only rounding puts on the ray's way.
constexpr Claim entered_anywhere{.may_miss_between_samples = true};

/// A step back from t. The first step begins where the ray leaves its start pixel: before, it lies on its own plane.
double step_back(const GBufferImage& gbuffer, const RayInput& ray, double t, double step)
{
    const Range own = part_in_pixel(ray, start_pixel(gbuffer, ray), 0);
    return step == 0 || own.empty() ? t : std::min(t, std::max(t - step, own.to));
}

/// The last of so many equal steps up to t: equal on screen, or in space, where 1 / distance is linear on screen.
double longest_last_step(const RayInput& ray, double t, uint32_t steps)
{
    if (steps == 0) return 0;
    const double before = double(steps - 1) / steps, from = ray.origin_px_depth.z, at = from + t * ray.delta_px_depth.z;
    const double in_space = at > 0 ? t * before * from / (at + before * (from - at)) : t;
    return t - std::min(t * before, in_space);
}

double screen_length_px(const RayInput& ray) { return glm::length(glm::dvec2(ray.delta_px_depth)); }

/// A thousandth of a pixel.
double slack_t(const RayInput& ray) { return 1e-3 / std::max(screen_length_px(ray), 1e-3); }

std::string name(const RayOutcome& outcome)
{
    if (!has_place(outcome.status)) return std::string(status_name(outcome.status));
    return fmt::format("{} in ({}, {}) at t {:.9g}", status_name(outcome.status), outcome.hit_pixel.x,
                       outcome.hit_pixel.y, outcome.t);
}

} // namespace

Claim claim_of(const Technique& technique)
{
    return {std::ranges::count(technique.limits, "point_sampled") > 0,
            std::ranges::count(technique.limits, "stops_behind_objects") > 0,
            std::ranges::count(technique.limits, "tests_whole_steps") > 0};
}

Judge::Judge(const Setup& setup) : setup_(setup) { require_surface(setup.gbuffer, setup.settings); }

/// What rounding to float can change of a comparison of depths along this ray.
double Judge::depth_rounding(const RayInput& ray, const Visit& v) const
{
    const glm::dvec2 size(setup_.gbuffer.view.size_px), slope = glm::abs(v.surface.gradient);
    const double     front = std::isfinite(v.surface.front) ? v.surface.front : 0;
    return 0x1p-21 * (std::abs(ray.origin_px_depth.z) + std::abs(ray.delta_px_depth.z) + front + glm::dot(slope, size));
}

bool Judge::surely_touches(const RayInput& ray, const Visit& v) const
{
    return v.contact > depth_rounding(ray, v) && depth_inside_px(ray, v) > sliver_px;
}

/// All of the ray's way within a sliver of a pixel, and `more_t` farther, if rounding could make it touch what the pixel holds there.
std::optional<Visit> Judge::possible_touch(const RayInput& ray, glm::ivec2 pixel, int layer, double more_t) const
{
    const Range t = part_in_pixel(ray, pixel, sliver_px);
    if (t.empty()) return std::nullopt;
    const Visit wide =
        visit(ray, pixel, layer, step_back(setup_.gbuffer, ray, t.from, more_t), std::min(t.to + more_t, 1.0));
    return wide.contact >= -depth_rounding(ray, wide) ? std::optional(wide) : std::nullopt;
}

/// A box is met from the side that its normal says. A plane is met from behind where the ray enters below it; who samples may have come later.
Judge::Sides Judge::sides(const RayInput& ray, const Visit& v, const Claim& claim) const
{
    if (!v.surface.sides_by_height)
        return {v.facing < facing_rounding, !(v.facing < -facing_rounding) || std::isfinite(v.surface.solid_back)};
    // Who tests whole steps continues a plane to where the ray was a step before: it may be on either side there.
    if (claim.may_hit_within_a_step) return {};
    const double rounding = depth_rounding(ray, v);
    const bool   anywhere = claim.may_miss_between_samples;
    const double lowest   = anywhere ? std::min(v.over_back_in, v.over_back_out) : v.over_back_in,
                 highest  = anywhere ? std::max(v.over_back_in, v.over_back_out) : v.over_back_in;
    return {highest + v.sampled_more >= -rounding, lowest < rounding};
}

bool Judge::surely_ends_ray(const RayInput& ray, const Visit& v) const
{
    return surely_touches(ray, v) && (setup_.settings.behind != Behind::pass || !sides(ray, v, {}).behind);
}

/// `wide`: all of the ray's way through the pixel that rounding may give it.
std::string Judge::unsound_side(const RayInput& ray, const RayOutcome& outcome, const Visit& wide,
                                const Claim& claim) const
{
    if (setup_.settings.behind == Behind::hit) return {};
    const std::vector<Visit> visits = walk(ray);
    const auto               own =
        std::ranges::find_if(visits, [&](const Visit& v) { return v.pixel == wide.pixel && v.layer == wide.layer; });
    const Sides possible = claim.may_hit_within_a_step || claim.may_miss_between_samples || own == visits.end()
                               ? sides(ray, wide, entered_anywhere)
                               : sides(ray, *own, claim);
    if (outcome.status == TraceStatus::hit && !possible.front)
        return wide.surface.sides_by_height
                   ? fmt::format("{}, which is met from behind ({:.6g} over its back)", name(outcome),
                                 wide.over_back_in)
                   : fmt::format("{}, which faces away (cosine {:.6g})", name(outcome), wide.facing);
    if (outcome.status == TraceStatus::stopped && !possible.behind)
        return fmt::format("{}, which is met from the front (cosine {:.6g}, {:.6g} over its back)", name(outcome),
                           wide.facing, wide.over_back_in);
    return {};
}

/// A ray must end in a pixel that it crosses, where it touches what the pixel holds (or, if so claimed, would touch it within a step); slivers count
/// as crossing.
std::string Judge::unsound_hit(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    const Range t = part_in_pixel(ray, outcome.hit_pixel, sliver_px);
    if (t.empty() || !on_image(setup_.gbuffer, outcome.hit_pixel))
        return fmt::format("{}, a pixel that the ray does not cross", name(outcome));
    const double step = claim.may_hit_within_a_step ? longest_last_step(ray, outcome.t, outcome.steps) : 0;
    if (outcome.hit_layer >= layer_count(setup_.gbuffer, setup_.settings))
        return fmt::format("{} and layer {}, which is not there", name(outcome), outcome.hit_layer);
    const Visit v = visit(ray, outcome.hit_pixel, outcome.hit_layer, step_back(setup_.gbuffer, ray, t.from, step),
                          std::min(t.to + step, 1.0), claim.may_miss_between_samples);
    if (!(v.contact >= -depth_rounding(ray, v)))
        return fmt::format("{}, where the ray's depth {:.9g} … {:.9g} does not meet the slab {:.9g} … {:.9g}",
                           name(outcome), v.z_in, v.z_out, v.surface.front, v.surface.back);
    if (std::string side = unsound_side(ray, outcome, v, claim); !side.empty()) return side;
    if (outcome.t < t.from - slack_t(ray) || outcome.t > t.to + slack_t(ray))
        return fmt::format("{}, but the ray is in that pixel from {:.9g} to {:.9g}", name(outcome), t.from, t.to);
    return {};
}

/// Does it meet something from behind in a pixel beside its way that it touches at a corner, where rounding may lead it through?
bool Judge::passes_in_sliver(const RayInput& ray, const std::vector<Visit>& visits) const
{
    const auto passes = [&](glm::ivec2 pixel, int layer) {
        const bool visited =
            pixel == start_pixel(setup_.gbuffer, ray) || std::ranges::count(visits, pixel, &Visit::pixel) > 0;
        if (visited || !on_image(setup_.gbuffer, pixel)) return false;
        const auto wide = possible_touch(ray, pixel, layer, 0);
        return wide && sides(ray, *wide, entered_anywhere).behind;
    };
    return std::ranges::any_of(visits, [&](const Visit& v) {
        for (const glm::ivec2& beside : {glm::ivec2(-1, 0), glm::ivec2(1, 0), glm::ivec2(0, -1), glm::ivec2(0, 1)})
            if (passes(v.pixel + beside, v.layer)) return true;
        return false;
    });
}

/// A ray that passed must say whether it met something from behind.
std::string Judge::unsound_end(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    if (setup_.settings.behind != Behind::pass) return "";
    const std::vector<Visit> visits = walk(ray);
    if (outcome.status == TraceStatus::facing_away) {
        const double more_t = claim.may_hit_within_a_step ? 1 : 0; // how long its steps were, a miss does not say
        const bool   any    = std::ranges::any_of(visits, [&](const Visit& v) {
            return sides(ray, v, claim).behind && possible_touch(ray, v.pixel, v.layer, more_t);
        });
        return any || passes_in_sliver(ray, visits) ? ""
                                                    : "ends as facing_away, but touches no surface that faces away";
    }
    if (outcome.status == TraceStatus::out_of_steps || claim.may_miss_between_samples || claim.may_miss_behind_objects)
        return "";
    const auto away = std::ranges::find_if(
        visits, [&](const Visit& v) { return !sides(ray, v, claim).front && surely_touches(ray, v); });
    if (away == visits.end()) return "";
    return fmt::format("ends as {}, but touches the surface in ({}, {}), which faces away", name(outcome),
                       away->pixel.x, away->pixel.y);
}

std::string Judge::unsound(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    return has_place(outcome.status) ? unsound_hit(ray, outcome, claim) : unsound_end(ray, outcome, claim);
}

Judgement Judge::judge(const RayInput& ray, const RayOutcome& outcome, const Claim& claim) const
{
    const RayOutcome exact = exact_answer(ray);
    const bool       hit = outcome.status == TraceStatus::hit, both_hit = hit && exact.status == TraceStatus::hit;
    const bool       ends = has_place(outcome.status);
    Judgement        result;
    result.findable = exact.status == TraceStatus::hit;
    if (both_hit) result.deviation_px = std::abs(outcome.t - exact.t) * screen_length_px(ray);
    result.reason = unsound(ray, outcome, claim);
    if (!result.reason.empty()) {
        result.verdict = Verdict::wrong;
        return result;
    }
    result.found = both_hit && (outcome.hit_pixel == exact.hit_pixel || result.deviation_px <= within_one_px);
    if (outcome.status == exact.status && (!ends || outcome.hit_pixel == exact.hit_pixel)) {
        const bool samples =
            claim.may_miss_between_samples || claim.may_miss_behind_objects || claim.may_hit_within_a_step;
        if (!ends || samples || outcome.hit_layer == exact.hit_layer || outcome.t <= exact.t + slack_t(ray))
            return result;
        result.verdict = Verdict::wrong;
        result.reason  = fmt::format("{} in layer {}, but the ray meets layer {} of that pixel before, at t = {:.9g}",
                                     name(outcome), outcome.hit_layer, exact.hit_layer, exact.t);
        return result;
    }

    // Something was skipped. Is there a pixel before the reported one where the ray undoubtedly ends?
    const bool within_limits = !unsound(ray, outcome, {}).empty();
    result.verdict  = within_limits || outcome.status == TraceStatus::out_of_steps ? Verdict::allowed : Verdict::sliver;
    bool was_behind = false;
    for (const Visit& v : walk(ray)) {
        if (ends && (v.pixel == outcome.hit_pixel || v.t_in >= outcome.t - slack_t(ray))) break;
        was_behind = was_behind || v.passes_behind();
        if (!surely_ends_ray(ray, v)) continue;
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

std::string Judge::broken_invariant(const RayInput& ray, const RayOutcome& outcome, double most_steps) const
{
    const Answer answer{outcome.status, outcome.hit_pixel, outcome.t, outcome.steps};
    if (std::string what = impossible(answer, setup_.gbuffer.view.size_px, most_steps); !what.empty())
        return what;
    if (!std::isfinite(outcome.t)) return fmt::format("t is {}", outcome.t);
    const Behind behind   = setup_.settings.behind;
    const bool   possible = outcome.status == TraceStatus::hit || outcome.status == ray.end_status ||
                          outcome.status == TraceStatus::out_of_steps ||
                          (outcome.status == TraceStatus::facing_away && behind == Behind::pass) ||
                          (outcome.status == TraceStatus::stopped && behind == Behind::stop);
    if (!possible) return fmt::format("ends as {}, which this ray cannot", name(outcome));
    if (!has_place(outcome.status)) return {};
    if (outcome.hit_pixel == start_pixel(setup_.gbuffer, ray)) return fmt::format("{}, its start pixel", name(outcome));
    return {};
}

} // namespace ssrlab
