#include "check/ray_report.h"

#include "check/judge.h"
#include "core/error.h"
#include "core/pixel_index.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double metres(const View& view, double depth)
{
    const bool perspective = view.projection == Projection::perspective;
    if (perspective && depth <= 0) return infinity;
    return std::isinf(depth) ? (depth > 0 ? 0 : infinity) : depth_to_distance(view, depth);
}

/// Where the ray enters and leaves a square of pixels; nothing where it misses it.
glm::dvec2 span_in(const RayInput& ray, glm::dvec2 low, glm::dvec2 high)
{
    double t_in = 0, t_out = 1;
    for (int axis : {0, 1}) {
        const double from = ray.origin_px_depth[axis], delta = ray.delta_px_depth[axis];
        if (delta == 0) continue;
        const double a = (low[axis] - from) / delta, b = (high[axis] - from) / delta;
        t_in  = std::max(t_in, std::min(a, b));
        t_out = std::min(t_out, std::max(a, b));
    }
    return {t_in, std::max(t_in, t_out)};
}

/// Nearest and farthest distance of a cell's pixels that hold something; zeros without any.
glm::dvec2 held_by_cell(const GBufferImage& gbuffer, glm::ivec2 first, int side)
{
    double           near_depth = 0, far_depth = infinity;
    const glm::ivec2 end = glm::min(first + side, gbuffer.view.size_px);
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            const auto depth = static_cast<double>(gbuffer.depth[pixel_index({x, y}, gbuffer.view.size_px)]);
            if (!(depth > 0)) continue;
            near_depth = std::max(near_depth, depth);
            far_depth  = std::min(far_depth, depth);
        }
    if (near_depth == 0) return {0, 0};
    return {metres(gbuffer.view, near_depth), metres(gbuffer.view, far_depth)};
}

VisitReport describe(const Setup& setup, const RayInput& ray, const RayVisit& visit)
{
    const View&      view = setup.gbuffer.view;
    const int        side = 1 << visit.level;
    const glm::ivec2 first((visit.pixel.x >> visit.level) << visit.level, (visit.pixel.y >> visit.level)
                                                                              << visit.level);
    VisitReport      report{visit, visit.t_in, visit.t_out, 0, 0, 0, 0, ""};
    if (visit.t_in < 0) {
        const glm::dvec2 span = span_in(ray, first, first + side);
        report.t_in           = span.x;
        report.t_out          = span.y;
    }
    report.ray_in_m  = metres(view, ray.origin_px_depth.z + report.t_in * ray.delta_px_depth.z);
    report.ray_out_m = metres(view, ray.origin_px_depth.z + report.t_out * ray.delta_px_depth.z);
    if (!on_image(setup.gbuffer, visit.pixel)) return report; // a technique may look anywhere
    if (visit.level > 0) {
        const glm::dvec2 held = held_by_cell(setup.gbuffer, first, side);
        report.front_m        = held.x;
        report.back_m         = held.y;
    } else if (const auto surface =
                   pixel_surface(setup.gbuffer, 0, pixel_index(visit.pixel, view.size_px), setup.settings)) {
        const glm::dvec2 middle = ray.origin_px_depth + 0.5 * (report.t_in + report.t_out) * ray.delta_px_depth;
        report.front_m          = metres(view, surface->front_at(middle));
        report.back_m           = metres(view, surface->back_at(middle));
    }
    return report;
}

std::vector<VisitReport> describe(const Setup& setup, const RayInput& ray, const RecordedRay& recorded)
{
    std::vector<VisitReport> reports;
    const RayOutcome&        outcome = recorded.outcome;
    for (const RayVisit& visit : recorded.visits) reports.push_back(describe(setup, ray, visit));
    for (size_t i = 0; i < reports.size(); ++i) {
        const bool last = i + 1 == reports.size(), leaf = reports[i].visit.level == 0;
        const bool ends = last && leaf && has_place(outcome.status) && reports[i].visit.pixel == outcome.hit_pixel;
        reports[i].then = ends   ? outcome.status == TraceStatus::hit ? "hit" : "stopped"
                          : leaf ? "passes"
                          : !last && reports[i + 1].visit.level < reports[i].visit.level ? "opens"
                                                                                         : "skips";
    }
    return reports;
}

/// Where and why a ray ended, in a sentence.
std::string ending_of(const Setup& setup, const RayInput& ray, const RayOutcome& outcome)
{
    const std::string at =
        fmt::format("pixel ({}, {}){}, t {:.6f}, {:.3f} px on screen, {:.4g} m from the camera", outcome.hit_pixel.x,
                    outcome.hit_pixel.y, outcome.hit_layer > 0 ? fmt::format(", layer {}", outcome.hit_layer) : "",
                    outcome.t, outcome.t * glm::length(glm::dvec2(ray.delta_px_depth)),
                    metres(setup.gbuffer.view, ray.origin_px_depth.z + outcome.t * ray.delta_px_depth.z));
    switch (outcome.status) {
    case TraceStatus::hit: return "hit at " + at;
    case TraceStatus::stopped: return "stopped at " + at + ": it met something from behind, and behind = stop";
    case TraceStatus::left_screen: return "no hit: the ray left the image, or crossed the near plane";
    case TraceStatus::past_max_distance: return "no hit within the maximum distance";
    case TraceStatus::out_of_steps: return fmt::format("gave up after {} steps: more would be needed", outcome.steps);
    case TraceStatus::facing_away: return "no hit: it met something from behind and passed (behind = pass)";
    default: return std::string(status_name(outcome.status));
    }
}

std::string verdict_of(const Judge& judge, const RayInput& ray, const RayOutcome& outcome, const RayQuestion& question)
{
    const double most_steps = declared_steps(*question.technique, question.values);
    if (const std::string broken = judge.broken_invariant(ray, outcome, most_steps); !broken.empty())
        return "impossible: " + broken;
    const Judgement judgement = judge.judge(ray, outcome, claim_of(*question.technique));
    switch (judgement.verdict) {
    case Verdict::right: return "the hit contract's answer";
    case Verdict::sliver: return "a near tie: rounding decides between this and the hit contract's answer";
    case Verdict::allowed: return "not the hit contract's answer, but within the technique's declared limits";
    case Verdict::wrong: return "wrong: " + judgement.reason;
    }
    return "";
}

nlohmann::json number(double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr); }

nlohmann::json to_json(const RayOutcome& outcome, const std::string& ending)
{
    nlohmann::json json{{"status", status_name(outcome.status)}, {"ending", ending}};
    if (has_place(outcome.status)) {
        json["pixel"] = {outcome.hit_pixel.x, outcome.hit_pixel.y};
        json["layer"] = outcome.hit_layer;
        json["t"]     = number(outcome.t);
    }
    return json;
}

nlohmann::json to_json(const VisitReport& report)
{
    return {{"pixel", {report.visit.pixel.x, report.visit.pixel.y}},
            {"level", report.visit.level},
            {"t_in", number(report.t_in)},
            {"t_out", number(report.t_out)},
            {"ray_in_m", number(report.ray_in_m)},
            {"ray_out_m", number(report.ray_out_m)},
            {"front_m", number(report.front_m)},
            {"back_m", number(report.back_m)},
            {"then", report.then}};
}

nlohmann::json to_json(const std::vector<VisitReport>& reports)
{
    nlohmann::json list = nlohmann::json::array();
    for (const VisitReport& report : reports) list.push_back(to_json(report));
    return list;
}

} // namespace

RayReport report_ray(Gpu& gpu, const Catalogue& catalogue, const Setup& setup, const RayInput& ray,
                     std::span<const RayQuestion> questions)
{
    const GBufferPtr gbuffer = upload_gbuffer(gpu, setup.gbuffer);
    const Judge      judge(setup);
    RayReport        report;
    report.ray          = ray;
    report.exact        = judge.exact_answer(ray);
    report.exact_ending = ending_of(setup, ray, report.exact);
    for (const Visit& visit : judge.walk(ray))
        if (visit.layer == 0) report.walk.push_back(describe(setup, ray, {visit.pixel, 0, visit.t_in, visit.t_out}));
    for (const RayQuestion& question : questions) {
        const RecordedRay recorded = record_ray(
            gpu, make_lab(gpu, catalogue, gbuffer, *question.technique, question.values, setup.settings), ray);
        report.techniques.push_back({question.technique->id, recorded.outcome, ending_of(setup, ray, recorded.outcome),
                                     verdict_of(judge, ray, recorded.outcome, question), describe(setup, ray, recorded),
                                     recorded.visit_count});
    }
    return report;
}

std::string visits_table(const TechniqueReport& report)
{
    std::string text = fmt::format("{:>5}  {:>5}  {:>12}  {:>19}  {:>19}  {:>19}  {}\n", "visit", "level",
                                   "pixel or cell", "t", "ray, m", "held there, m", "then");
    for (size_t i = 0; i < report.visits.size(); ++i) {
        const VisitReport& v = report.visits[i];
        const std::string  held =
            v.front_m == 0 && v.back_m == 0 ? "nothing" : fmt::format("{:.4g} … {:.4g}", v.front_m, v.back_m);
        text += fmt::format("{:>5}  {:>5}  {:>12}  {:>19}  {:>19}  {:>19}  {}\n", i + 1, v.visit.level,
                            fmt::format("({}, {})", v.visit.pixel.x >> v.visit.level, v.visit.pixel.y >> v.visit.level),
                            fmt::format("{:.5f} … {:.5f}", v.t_in, v.t_out),
                            fmt::format("{:.4g} … {:.4g}", v.ray_in_m, v.ray_out_m), held, v.then);
    }
    return text;
}

nlohmann::json to_json(const RayReport& report, const Setup& setup)
{
    const RayInput& ray = report.ray;
    nlohmann::json  json{{"pixel", {ray.pixel.x, ray.pixel.y}},
                        {"size_px", {setup.gbuffer.view.size_px.x, setup.gbuffer.view.size_px.y}},
                        {"origin_px_depth", {ray.origin_px_depth.x, ray.origin_px_depth.y, ray.origin_px_depth.z}},
                        {"delta_px_depth", {ray.delta_px_depth.x, ray.delta_px_depth.y, ray.delta_px_depth.z}},
                        {"length_m", number(ray.length_m)},
                        {"screen_truth", to_json(report.exact, report.exact_ending)},
                        {"scene_truth", nullptr},
                        {"walk", to_json(report.walk)},
                        {"techniques", nlohmann::json::array()}};
    if (report.true_end)
        json["scene_truth"] = {{"class", truth_class_names[static_cast<size_t>(report.true_end->cls)]},
                               {"distance_m", number(report.true_end->distance_m)},
                               {"point_px", {number(report.true_end->point_px.x), number(report.true_end->point_px.y)}},
                               {"starts_off_surface", report.true_end->starts_off_surface}};
    for (const TechniqueReport& technique : report.techniques) {
        nlohmann::json one       = to_json(technique.outcome, technique.ending);
        one["technique"]         = technique.id;
        one["verdict"]           = technique.verdict;
        one["steps"]             = technique.outcome.steps;
        one["depth_fetches"]     = technique.outcome.depth_fetches;
        one["structure_fetches"] = technique.outcome.structure_fetches;
        one["visit_count"]       = technique.visit_count;
        one["visits"]            = to_json(technique.visits);
        json["techniques"].push_back(std::move(one));
    }
    return json;
}

} // namespace ssrlab
