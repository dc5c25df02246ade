#include "app/pixel_sources.h"

#include "compare/all_rays.h"
#include "core/pixel_index.h"
#include "harness/source_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace ssrlab {
namespace {

constexpr std::array kind_names = {"", "open", "point", "nothing", "light"}; // by AnswerKind

glm::dvec3 place_ws(const GBufferImage& image, size_t pixel)
{
    const glm::dvec3 place_vs =
        px_to_vs(image.view, glm::dvec2(pixel_at(pixel, image.view.size_px)) + 0.5, double(image.depth[pixel]));
    return glm::dvec3(glm::inverse(image.view.world_to_view) * glm::dvec4(place_vs, 1));
}

PixelAnswer told(const RayAnswer& answer, const SceneTruth& truth, const GBufferImage& image, size_t pixel)
{
    const bool  meets = meets_geometry(truth.cls[pixel]);
    PixelAnswer result;
    result.kind    = kind_names[static_cast<size_t>(answer.kind)];
    result.certain = answer.certain;
    result.right   = answer.kind == AnswerKind::point ? is_right(answer, truth, image, pixel)
                                                      : answer.kind == AnswerKind::nothing && !meets;
    if (answer.kind != AnswerKind::point) return result;
    result.distance_m = glm::length(answer.point_ws - place_ws(image, pixel));
    if (!meets) return result;
    const auto point_vs = glm::dvec3(image.view.world_to_view * glm::dvec4(answer.point_ws, 1));
    result.off_m        = glm::length(point_vs - truth.point_vs[pixel]);
    return result;
}

} // namespace

PixelSources ask_about_pixel(Stage& stage, const Technique& technique, const ParameterValues& values,
                             const FrameSettings& settings, const std::string& view, SequenceFrame at,
                             std::span<const ListedSource> list, size_t pixel)
{
    SourceContext      context = context_of_frame(stage, technique, values, settings, view, at);
    const AnsweredRays answered =
        answer_rays(context, choose_sources(context, list, HandOn::uncertain).list, HandOn::uncertain);
    const SceneTruth truth = scene_truth(SceneBvh(stage.scene), stage.scene, context.image, settings.trace);
    PixelSources     result;
    for (const SourceTurn& turn : answered.turns) {
        const auto  asked = std::ranges::find(turn.pixels, pixel);
        PixelAnswer answer =
            asked == turn.pixels.end()
                ? PixelAnswer{}
                : told(turn.answers[static_cast<size_t>(asked - turn.pixels.begin())], truth, context.image, pixel);
        answer.source = turn.source;
        result.answers.push_back(std::move(answer));
    }
    const RayAnswer& merged_answer = answered.answers[pixel];
    if (merged_answer.kind > AnswerKind::open) result.answered_by = result.answers[merged_answer.source].source;
    if (meets_geometry(truth.cls[pixel])) result.allowed_m = allowed_distance_m(truth, context.image, pixel);
    return result;
}

void print_pixel_sources(const PixelSources& sources)
{
    std::puts(sources.answered_by.empty() ? "\nsources: none answers this ray"
                                          : ("\nsources: answered by " + sources.answered_by).c_str());
    for (const PixelAnswer& answer : sources.answers) {
        std::string text = answer.kind.empty() ? "not asked: a certain answer stands" : answer.kind;
        if (answer.distance_m) text += fmt::format(", {:.4g} m along the ray", *answer.distance_m);
        if (answer.off_m)
            text +=
                fmt::format(", {:.3g} m from the true point (allowed: {:.3g} m)", *answer.off_m, *sources.allowed_m);
        if (answer.kind == "point" || answer.kind == "nothing")
            text += fmt::format(", {}, {}", answer.certain ? "certain" : "uncertain", answer.right ? "right" : "wrong");
        std::puts(fmt::format("  {}: {}", answer.source, text).c_str());
    }
}

nlohmann::json to_json(const PixelSources& sources)
{
    nlohmann::json json = {{"answered_by", sources.answered_by}, {"answers", nlohmann::json::array()}};
    if (sources.allowed_m) json["allowed_m"] = *sources.allowed_m;
    for (const PixelAnswer& answer : sources.answers) {
        nlohmann::json one = {{"source", answer.source}, {"asked", !answer.kind.empty()}};
        if (!answer.kind.empty())
            one.update({{"kind", answer.kind}, {"certain", answer.certain}, {"right", answer.right}});
        if (answer.distance_m) one["distance_m"] = *answer.distance_m;
        if (answer.off_m) one["off_m"] = *answer.off_m;
        json["answers"].push_back(std::move(one));
    }
    return json;
}

} // namespace ssrlab
