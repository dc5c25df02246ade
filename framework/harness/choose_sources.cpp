#include "harness/choose_sources.h"

#include "compare/all_rays.h"
#include "core/stopwatch.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <stdexcept>

namespace ssrlab {
namespace {

constexpr std::array candidates = {
    "frame",       "frame,resume", "frame,wider",        "frame,planar",       "frame,cube",       "frame,layers",
    "frame,views", "frame,world",  "frame,resume,world", "frame,planar,world", "frame,cube,world", "world"};

/// What the triangles answer, as a truth.
SceneTruth truth_of(const SourceContext& context, std::span<const RayAnswer> answers)
{
    const View& view = context.image.view;
    SceneTruth  truth;
    truth.size_px = view.size_px;
    truth.cls.resize(answers.size(), TruthClass::not_traced);
    truth.point_vs.resize(answers.size());
    for (size_t i = 0; i < answers.size(); ++i) {
        if (answers[i].kind == AnswerKind::nothing) truth.cls[i] = TruthClass::sky;
        if (answers[i].kind != AnswerKind::point) continue;
        truth.cls[i]      = TruthClass::visible; // or not: nobody asks
        truth.point_vs[i] = glm::dvec3(view.world_to_view * glm::dvec4(answers[i].point_ws, 1));
    }
    return truth;
}

double sources_ms(const AnsweredRays& answered)
{
    double ms = 0;
    for (const SourceTurn& turn : answered.turns) ms += turn.draw_ms + turn.trace_ms + turn.shade_ms;
    return ms;
}

/// Asked twice: when it is first asked, a driver may compile pipelines.
MeasuredList measure(SourceContext& context, const std::string& text, HandOn hand_on, const SceneTruth& truth)
{
    const std::vector<ListedSource> list = parse_sources(text, "auto");
    answer_rays(context, list, hand_on);
    const AnsweredRays answered = answer_rays(context, list, hand_on);
    const AllRays      all      = compare_all_rays(answered.answers, truth, context.image);
    return {text, context.draw_ms + sources_ms(answered), all.f1.value_or(0)};
}

std::string reason_of(std::span<const MeasuredList> lists, size_t best, double budget_ms)
{
    const auto said = [](const MeasuredList& list) {
        return fmt::format("{} ({:.2f} ms, F1 {:.1f} %)", list.text, list.ms, 100 * list.right);
    };
    std::string others;
    for (const MeasuredList& list : lists)
        if (&list != &lists[best]) others += (others.empty() ? "" : ", ") + said(list);
    return fmt::format("budget {:.2f} ms{}: {}; others: {}", budget_ms,
                       lists[best].ms <= budget_ms ? "" : ", which no list keeps", said(lists[best]), others);
}

} // namespace

size_t best_within(std::span<const MeasuredList> lists, double budget_ms)
{
    if (lists.empty()) throw std::logic_error("best_within: no lists");
    constexpr double equal    = 0.001;
    const auto       cheapest = std::ranges::min_element(lists, {}, &MeasuredList::ms);
    auto             best     = cheapest;
    for (auto list = lists.begin(); list != lists.end(); ++list) {
        if (list->ms > budget_ms) continue;
        const bool more = list->right > best->right + equal;
        if (more || (list->right >= best->right - equal && list->ms < best->ms)) best = list;
    }
    return static_cast<size_t>(best - lists.begin());
}

ChosenSources choose_sources(SourceContext& context, std::span<const ListedSource> list, HandOn hand_on)
{
    if (list.size() != 1 || list[0].source->id != "auto") return {{list.begin(), list.end()}, "", 0};
    const Stopwatch           choosing;
    const AnsweredRays        world = answer_rays(context, parse_sources("world:bounces=0", "auto"), hand_on);
    const SceneTruth          truth = truth_of(context, world.answers);
    std::vector<MeasuredList> lists;
    for (const char* text : candidates) lists.push_back(measure(context, text, hand_on, truth));
    const double given_ms  = list[0].values.at("budget_ms");
    const double budget_ms = given_ms > 0 ? given_ms : list[0].values.at("share") * lists[0].ms;
    const size_t best      = best_within(lists, budget_ms);
    return {parse_sources(lists[best].text, "auto"), reason_of(lists, best, budget_ms), 1000 * choosing.seconds()};
}

} // namespace ssrlab
