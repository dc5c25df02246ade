// What the panel and a script's `print` say.
#include "compare/all_rays.h"
#include "core/error.h"
#include "core/quantile.h"
#include "harness/experiment.h"
#include "viewer/session.h"

namespace ssrlab {
namespace {

double median_ms(const std::vector<FrameTimes>& times, auto&& of)
{
    std::vector<double> values;
    for (const FrameTimes& one : times) values.push_back(of(one));
    return values.empty() ? 0 : quantile(values, 0.5);
}

std::string share_text(const MeasureValues& measures, std::string_view name)
{
    const auto found = measures.find(name);
    return found == measures.end() || !found->second ? "none" : fmt::format("{:.2f} %", 100 * *found->second);
}

std::string ray_command(const Session& session, glm::ivec2 pixel)
{
    const PictureOptions& picture = session.picture;
    std::string text = fmt::format("ssrlab ray {} --view {} --size {} --pixel {},{} -t {}", picture.scene, picture.view,
                                   size_text(session.stage.view.size_px), pixel.x, pixel.y, session.technique->id);
    if (picture.at.frame > 0) text += fmt::format(" --frame {}", picture.at.frame);
    if (picture.at.jitter_phases > 0) text += fmt::format(" --jitter {}", picture.at.jitter_phases);
    for (const Parameter& parameter : session.technique->parameters) {
        const double value = session.choice.values.at(parameter.name);
        if (value != parameter.default_value)
            text += fmt::format(" -p {}={}", parameter.name, format_parameter(parameter, value));
    }
    for (const Setting& setting : session.settings) {
        const double value = setting.get(session.choice.settings);
        if (setting.table == "trace" && value != setting.default_value)
            text += fmt::format(" -p {}={}", setting.name, format_parameter(setting, value));
    }
    return text;
}

void add_truth(const Session& session, size_t i, PixelRay& ray)
{
    if (session.scene_truth) {
        const TruthClass cls = session.scene_truth->cls[i];
        ray.text += fmt::format("\ntruth: {}", truth_class_names[static_cast<size_t>(cls)]);
        if (cls == TruthClass::visible) ray.true_px = session.scene_truth->point_px[i];
    } else if (session.screen_truth) {
        const TraceStatus status = session.screen_truth->status[i];
        ray.text += fmt::format("\nscreen truth: {}", status_name(status));
        if (has_place(status)) ray.true_px = glm::dvec2(session.screen_truth->hit_px_depth[i]);
    }
    if (ray.true_px) ray.text += fmt::format(" at ({:.1f}, {:.1f})", ray.true_px->x, ray.true_px->y);
}

} // namespace

std::vector<Reading> readings(const Session& session)
{
    const MeasureValues& measures = session.measures;
    const auto           value    = [&](std::string_view name) {
        const auto found = measures.find(name);
        return found == measures.end() ? 0 : found->second.value_or(0);
    };
    const std::string    prefix = session.scene_truth ? "" : "screen_";
    const std::string    of     = fmt::format(" ms (median of {})", session.times.size());
    std::vector<Reading> result = {
        {"trace",
         fmt::format("{:.2f}", median_ms(session.times, [](const FrameTimes& t) { return t.of("trace"); })) + of},
        {"all passes",
         fmt::format("{:.2f}", median_ms(session.times, [](const FrameTimes& t) { return t.total_ms(); })) + of},
        {"fetches a ray", fmt::format("{:.2f}", value("depth_fetches_mean") + value("structure_fetches_mean"))},
        {"steps a ray", fmt::format("{:.2f}", value("steps_mean"))},
        {"rays", fmt::format("{:.0f}", value("traced_rays"))},
        {prefix + "recall_1px", share_text(measures, prefix + "recall_1px")},
        {prefix + "precision_1px", share_text(measures, prefix + "precision_1px")},
        {prefix + "f1_1px", share_text(measures, prefix + "f1_1px")},
    };
    if (!has_answers(session) || !session.scene_truth) return result;
    std::string asked;
    for (const SourceTurn& turn : session.answered.turns) asked += (asked.empty() ? "" : ",") + turn.source;
    const AllRays all = compare_all_rays(session.answered.answers, *session.scene_truth, session.gbuffer);
    result.push_back({"sources", asked});
    result.push_back({"all_f1", all.f1 ? fmt::format("{:.2f} %", 100 * *all.f1) : "none"});
    return result;
}

/// Which source answered the ray of a pixel.
std::string answered_by(const Session& session, size_t i)
{
    if (!has_answers(session)) return "";
    const RayAnswer& answer = session.answered.answers[i];
    if (answer.kind <= AnswerKind::open) return "\nno source answers";
    constexpr std::array said = {"", "", "a point", "nothing there", "a colour"}; // by AnswerKind
    return fmt::format("\nanswered by {}: {}, {}", session.answered.turns[answer.source].source,
                       said[static_cast<size_t>(answer.kind)], answer.certain ? "certain" : "uncertain");
}

PixelRay ray_at(const Session& session, glm::ivec2 pixel)
{
    PixelRay ray;
    ray.text       = fmt::format("pixel {},{}: ", pixel.x, pixel.y);
    const size_t i = pixel_index(pixel, session.stage.view.size_px);
    if (i >= session.counted.status.size()) return ray;
    const TraceStatus status = session.counted.status[i];
    ray.text += status_name(status);
    if (status == TraceStatus::not_traced) return ray;
    if (has_place(status)) {
        ray.found_px = glm::dvec2(session.counted.hit_px_depth[i]);
        ray.text += fmt::format(" at ({:.1f}, {:.1f})", ray.found_px->x, ray.found_px->y);
    }
    ray.text += fmt::format("\n{} steps, {} fetches", session.counted.steps[i],
                            session.counted.depth_fetches[i] + structure_fetches_of(session.counted, i));
    add_truth(session, i, ray);
    ray.text += answered_by(session, i);
    if (!session.camera_moved) ray.command = ray_command(session, pixel);
    return ray;
}

} // namespace ssrlab
