#include "harness/sequence_frame.h"

#include "core/error.h"

#include <algorithm>

namespace ssrlab {
namespace {

MeasureValues history_measures(const HistoryCounts& counts)
{
    const size_t pixels = counts.accumulated + counts.unseen + counts.off_image + counts.other_depth +
                          counts.other_normal + counts.other_hit;
    return {{"history_share", share(counts.accumulated, pixels)},
            {"clamped_share", share(counts.clamped, counts.accumulated)}};
}

MeasureValues watch_sequence(Bench& bench, const Picture& picture, const Run& run, const Observed& observed)
{
    if (history_of(bench, run) == nullptr) return {};
    const bool moved = picture.motion && (picture.motion->camera_moves || picture.motion->moving_draws > 0);
    return watch(bench.sequences[sequence_id(run)], observed.shaded, observed.counted, picture.jitter_px, moved);
}

/// The picture with the true reflection; no technique is in it.
void add_true_picture(Bench& bench, Picture& picture, const Run& run, const FrameSettings& settings, Image& sum)
{
    const auto frame = prepare_frame(bench.gpu, picture.buffers, find_technique(bench.techniques, run.technique),
                                     run.values, settings);
    run_frame(bench.gpu, *frame);
    picture.truths->make(settings.trace, false);
    const Image picture_now = composite_reflection(bench.gpu, *frame, picture.truths->true_reflection());
    if (sum.values.empty()) {
        sum = picture_now;
        return;
    }
    for (size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += picture_now.values[i];
}

} // namespace

FrameHistoryPtr history_of(Bench& bench, const Run& run)
{
    if (!is_sequence(bench.experiment) || bench.scene->first.frame) return nullptr;
    SequenceState& state = bench.sequences[sequence_id(run)];
    if (state.failed) throw_failure("a frame before this one failed, so this one has no history");
    if (!state.history) state.history = make_history(bench.gpu, run.size_px);
    return state.history;
}

void leave_history(Bench& bench, const Run& run, PreparedFrame& frame)
{
    if (history_of(bench, run) == nullptr) return;
    const UnderWay under_way(bench.state, run.id, bench.experiment.measure.time_limit_s);
    clocked(bench.counted_s, [&] { run_frame(bench.gpu, frame); });
    keep_history(bench.gpu, frame);
}

void lose_history(Bench& bench, const Run& run)
{
    const auto state = bench.sequences.find(sequence_id(run));
    if (state == bench.sequences.end()) return;
    state->second        = {};
    state->second.failed = true;
}

void judge_sequence(Bench& bench, Picture& picture, MeasuredRun& measured, const Observed& observed)
{
    add_measures(measured.row, watch_sequence(bench, picture, *measured.run, observed));
    const auto converged = std::ranges::find(bench.converged, measured.run->settings, &ConvergedPicture::settings);
    if (converged != bench.converged.end())
        add_measures(measured.row, compare_converged(observed.shaded, converged->reference, observed.counted));
    if (!observed.history) return;
    add_measures(measured.row, history_measures(*observed.history));
    if (!picture.truths || !picture.truths->without_scene().empty()) return;
    clocked(bench.truths_s, [&] {
        const LoadedScene& loaded = *bench.scene;
        if (picture.motion->moving_draws == 0)
            picture.truths->make_reprojection(loaded.scene, *picture.motion);
        else
            picture.truths->make_reprojection(scene_at(loaded.first, loaded.frame - 1), *picture.motion);
    });
    add_measures(measured.row, picture.truths->compare_history(observed.reprojection, observed.counted));
    if (picture.reference)
        add_measures(measured.row, picture.truths->compare_ghosts(observed.shaded, *picture.reference));
}

void replay(Bench& bench, const Picture& picture, const Run& run)
{
    try {
        const UnderWay         under_way(bench.state, run.id, bench.experiment.measure.time_limit_s);
        const PreparedFramePtr frame =
            prepare_frame(bench.gpu, picture.buffers, find_technique(bench.techniques, run.technique), run.values,
                          run.settings, history_of(bench, run));
        clocked(bench.counted_s, [&] { run_frame(bench.gpu, *frame); });
        watch_sequence(bench, picture, run,
                       {read_shaded(bench.gpu, *frame), count_frame(bench.gpu, *frame), std::nullopt});
        leave_history(bench, run, *frame);
    } catch (const std::exception& error) {
        bench.progress.say(fmt::format("frame {} of {}: {}", run.at.frame, sequence_id(run), error.what()));
        lose_history(bench, run);
    }
}

void make_converged_pictures(Bench& bench, std::span<const Run> runs)
{
    const Run&             first   = runs.front();
    const MeasureSettings& measure = bench.experiment.measure;
    if (!measure.truth || !measure.image_errors || first.at.jitter_phases == 0) return;
    const auto motion =
        motion_at(scene_of(bench, first.scene, 0).first, first.view, first.size_px, std::max(first.at.frame, 1));
    if (!motion || motion->camera_moves || motion->moving_draws > 0) return;
    std::vector<std::pair<FrameSettings, Image>> sums;
    for (const Run& run : runs)
        if (std::ranges::find(sums, run.settings, [](const auto& sum) { return sum.first; }) == sums.end())
            sums.emplace_back(run.settings, Image{});
    for (int phase = 0; phase < first.at.jitter_phases; ++phase) {
        Run run         = first;
        run.at.frame    = phase;
        Picture picture = make_picture(bench, run);
        for (auto& [settings, sum] : sums) add_true_picture(bench, picture, run, settings, sum);
        bench.progress.tick();
    }
    for (auto& [settings, sum] : sums) {
        for (float& value : sum.values) value /= static_cast<float>(first.at.jitter_phases);
        bench.converged.push_back({settings, Reference(sum)});
    }
}

} // namespace ssrlab
