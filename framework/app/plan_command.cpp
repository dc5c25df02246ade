#include "app/plan_command.h"

#include "app/stage.h"
#include "core/error.h"
#include "harness/statistics.h"

#include <cstdio>
#include <map>

namespace ssrlab {
namespace {

struct Timed {
    PreparedFramePtr                           frame;
    std::map<std::string, std::vector<double>> pass_ms;
    std::vector<double>                        total_ms;
};

void add_repeat(Gpu& gpu, Timed& timed)
{
    const FrameTimes times = run_frame(gpu, *timed.frame);
    for (const auto& [pass, ms] : times.passes_ms) timed.pass_ms[pass].push_back(ms);
    timed.total_ms.push_back(times.total_ms());
}

/// "1.23", or "-" for what did not run.
std::string median_text(const Timed& timed, const std::string& pass)
{
    const auto found = timed.pass_ms.find(pass);
    return found == timed.pass_ms.end() ? "-" : fmt::format("{:.2f}", quantile(found->second, 0.5));
}

void print_table(const Timed& planned, const Timed& unculled)
{
    std::puts(fmt::format("{:<20} {:<8} {:>11} {:>14}  {}", "pass", "", "planned ms", "unculled ms", "why").c_str());
    for (const PlannedPass& row : plan_of(*planned.frame)) {
        const std::string& id = row.id;
        std::puts(fmt::format("{:<20} {:<8} {:>11} {:>14}  {}", id, row.runs ? "run" : "skipped",
                              median_text(planned, id), median_text(unculled, id), row.reason)
                      .c_str());
    }
    std::puts(fmt::format("{:<20} {:<8} {:>11.2f} {:>14.2f}", "frame", "", quantile(planned.total_ms, 0.5),
                          quantile(unculled.total_ms, 0.5))
                  .c_str());
}

/// What the frame before leaves; null for frame 0. The stage shows its own frame again afterwards.
FrameHistoryPtr history_before(Stage& stage, const PictureOptions& options, const Technique& technique,
                               const Choice& choice)
{
    if (options.at.frame == 0) return nullptr;
    show_frame(stage, options.view, {options.at.frame - 1, options.at.jitter_phases});
    auto       history = make_history(stage.gpu, stage.view.size_px);
    const auto frame = prepare_frame(stage.gpu, make_frame_buffers(stage.gpu, stage.gbuffer), technique, choice.values,
                                     choice.settings, history);
    run_frame(stage.gpu, *frame);
    keep_history(stage.gpu, *frame, options.at.frame - 1);
    show_frame(stage, options.view, options.at);
    return history;
}

} // namespace

int print_plan(const CommonOptions& common, const PlanOptions& options)
{
    const auto       techniques = list_techniques(common.technique_dirs);
    const Technique& technique  = find_technique(techniques, options.picture.technique);
    Choice           choice     = parse_choice(technique, options.picture.parameters);
    Stage            stage      = prepare_stage(common, options.picture);
    const auto       history    = history_before(stage, options.picture, technique, choice);
    const auto       buffers    = make_frame_buffers(stage.gpu, stage.gbuffer);

    choice.settings.passes.at("skip_unneeded_passes") = 1;
    const auto timed                                  = [&](PreparedFramePtr frame) {
        run_frame(stage.gpu, *frame); // warm-up
        return Timed{std::move(frame), {}, {}};
    };
    Timed      planned = timed(prepare_frame(stage.gpu, buffers, technique, choice.values, choice.settings, history));
    const auto planned_image = read_shaded(stage.gpu, *planned.frame);
    Timed      unculled      = timed(prepare_unculled(stage.gpu, *planned.frame));
    const bool same          = read_shaded(stage.gpu, *unculled.frame).values == planned_image.values;
    for (int i = 0; i < options.repeats; ++i) {
        add_repeat(stage.gpu, planned);
        add_repeat(stage.gpu, unculled);
    }
    std::puts(fmt::format("{}, view {}, {}x{}, {} on {}: median of {} frames without the G-buffer",
                          options.picture.scene, options.picture.view, stage.view.size_px.x, stage.view.size_px.y,
                          technique.id, stage.gpu.info.name, options.repeats)
                  .c_str());
    for (const std::string& fact : facts_of_plan(*planned.frame)) std::puts(fact.c_str());
    std::puts("");
    print_table(planned, unculled);
    std::puts(same ? "\nThe unculled image is bit-identical." : "\nThe unculled image DIFFERS from the planned one.");
    const int messages = report_messages(stage);
    return same ? messages : 1;
}

} // namespace ssrlab
