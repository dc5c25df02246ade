#include "app/plan_command.h"

#include "core/error.h"
#include "harness/choose_technique.h"
#include "harness/no_hits.h"
#include "harness/statistics.h"

#include <algorithm>
#include <cstdio>
#include <map>

namespace ssrlab {
namespace {

struct Timed {
    FramePtr                                   frame;
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

/// Columns: megabytes read and written and, with a bandwidth, the milliseconds that these need at the least; "-" for a
/// pass that did not run.
std::string traffic_text(const PassTraffic* traffic, double bandwidth_gbps)
{
    const auto column = [&](int width, int digits, double value) {
        return traffic == nullptr ? fmt::format(" {:>{}}", "-", width)
                                  : fmt::format(" {:>{}.{}f}", value, width, digits);
    };
    const PassTraffic moved = traffic == nullptr ? PassTraffic{} : *traffic;
    const std::string bytes = column(8, 2, 1e-6 * static_cast<double>(moved.read_bytes)) +
                              column(11, 2, 1e-6 * static_cast<double>(moved.written_bytes));
    return bandwidth_gbps > 0 ? bytes + column(9, 4, least_ms(moved, bandwidth_gbps)) : bytes;
}

void print_table(const FramePlan& plan, const Timed& planned, const Timed& unculled,
                 const std::vector<PassTraffic>& traffic, double bandwidth_gbps)
{
    std::puts(fmt::format("{:<20} {:<8} {:>11} {:>14} {:>8} {:>11}{}  {}", "pass", "", "planned ms", "unculled ms",
                          "MB read", "MB written", bandwidth_gbps > 0 ? fmt::format(" {:>9}", "least ms") : "", "why")
                  .c_str());
    for (const PlannedPass& row : plan.passes) {
        const std::string& id    = row.id;
        const auto         moved = std::ranges::find(traffic, id, &PassTraffic::pass);
        std::puts(fmt::format("{:<20} {:<8} {:>11} {:>14}{}  {}", id, row.runs ? "run" : "skipped",
                              median_text(planned, id), median_text(unculled, id),
                              traffic_text(moved == traffic.end() ? nullptr : &*moved, bandwidth_gbps), row.reason)
                      .c_str());
    }
    const PassTraffic frame = sum_of(traffic);
    std::puts(fmt::format("{:<20} {:<8} {:>11.2f} {:>14.2f}{}", "frame", "", quantile(planned.total_ms, 0.5),
                          quantile(unculled.total_ms, 0.5), traffic_text(&frame, bandwidth_gbps))
                  .c_str());
}

/// What the frame before leaves; null for frame 0. The stage shows its own frame again afterwards.
FrameHistoryPtr history_before(Stage& stage, const PictureOptions& options, const Technique& technique,
                               const Choice& choice)
{
    if (options.at.frame == 0) return nullptr;
    show(stage, options.view, stage.view.size_px, {options.at.frame - 1, options.at.jitter_phases});
    FrameHistoryPtr       history = make_history(stage.gpu, stage.view.size_px);
    const LabPtr          lab     = make_lab(stage, technique, choice.values, choice.settings.trace);
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    const FramePlan       plan    = plan_frame(stage, lab, buffers, choice.settings, history);
    const FramePtr        frame   = make_frame(stage.gpu, lab, buffers, plan, history);
    run_frame(stage.gpu, *frame);
    keep_history(stage.gpu, *frame, options.at.frame - 1);
    show(stage, options.view, stage.view.size_px, options.at);
    return history;
}

} // namespace

int print_plan(const CommonOptions& common, const PlanOptions& options)
{
    const Catalogue  catalogue = load_catalogue(common.technique_dirs);
    const auto       asked     = asked_techniques(catalogue, options.picture.technique, options.picture.parameters);
    Stage            stage     = open_stage(common, catalogue, options.picture);
    AskedTechnique   chosen    = choose_technique(stage, asked, common.quiet);
    const Technique& technique = *chosen.technique;
    Choice&          choice    = chosen.choice;
    const auto       history   = history_before(stage, options.picture, technique, choice);

    choice.settings.passes.at("skip_unneeded_passes") = 1;
    const LabPtr          lab     = make_lab(stage, technique, choice.values, choice.settings.trace);
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    const FramePlan       plan    = plan_frame(stage, lab, buffers, choice.settings, history);
    say(common, lacked_channel_text(stage.scene, catalogue, choice.settings.trace));
    say(common, no_hits_text(technique, choice.settings.trace, stage.scene, plan.statistics.trace));
    const auto timed = [&](const FramePlan& of) {
        Timed frame{make_frame(stage.gpu, lab, buffers, of, history), {}, {}};
        run_frame(stage.gpu, *frame.frame); // warm-up
        return frame;
    };
    Timed      planned       = timed(plan);
    const auto planned_image = read_shaded(stage.gpu, *planned.frame);
    const auto traffic       = count_traffic(stage.gpu, *planned.frame);
    Timed      all           = timed(unculled(plan));
    const bool same          = read_shaded(stage.gpu, *all.frame).values == planned_image.values;
    for (int i = 0; i < options.repeats; ++i) {
        add_repeat(stage.gpu, planned);
        add_repeat(stage.gpu, all);
    }
    std::puts(fmt::format("{}, view {}, {}x{}, {} on {}: median of {} frames without the G-buffer",
                          options.picture.scene, options.picture.view, stage.view.size_px.x, stage.view.size_px.y,
                          technique.id, stage.gpu.info.name, options.repeats)
                  .c_str());
    for (const std::string& fact : describe_facts(plan)) std::puts(fact.c_str());
    std::puts("");
    print_table(plan, planned, all, traffic, options.bandwidth_gbps);
    std::puts(same ? "\nThe unculled image is bit-identical." : "\nThe unculled image DIFFERS from the planned one.");
    const int messages = report_messages(stage);
    return same ? messages : 1;
}

} // namespace ssrlab
