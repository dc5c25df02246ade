#include "harness/sequence_frame.h"

#include "core/error.h"

#include <algorithm>

namespace ssrlab {
namespace {

bool anything_moved(const FrameMotion& motion) { return motion.camera_moves || motion.moving_draws > 0; }

MeasureValues watch_sequence(SweepContext& sweep, const MeasuredPicture& picture, const Run& run,
                             const Observed& observed)
{
    // Behind a cut of the camera everything is elsewhere.
    const auto& motion = sweep.scene->stage.motion;
    const bool  moved  = motion ? anything_moved(*motion) : run.at.frame > 0;
    return watch(sweep.sequences[sequence_id(run)], observed.shaded, observed.counted, picture.jitter_px, moved);
}

SceneInTime scene_before(const Stage& stage, const FrameMotion& motion, int frames_back)
{
    if (motion.moving_draws == 0) return {{}, motion};
    return {scene_at(stage.first, motion.frame - frames_back), motion};
}

void make_reprojection(SweepContext& sweep, MeasuredPicture& picture, const Run& run)
{
    if (picture.truths->has_reprojection()) return;
    const Stage&               stage = sweep.scene->stage;
    std::optional<FrameMotion> earlier;
    int                        frames_back = ghost_frames + 1;
    while (!earlier) earlier = motion_at(stage.first, run.view, run.size_px, run.at.frame, --frames_back);
    picture.truths->make_reprojection(scene_before(stage, *stage.motion, 1),
                                      scene_before(stage, *earlier, frames_back));
}

/// Where something but jitter moved.
void judge_motion(SweepContext& sweep, MeasuredPicture& picture, MeasuredRun& measured, const Observed& observed)
{
    if (!picture.truths || !picture.truths->without_scene().empty()) return;
    if (!sweep.scene->stage.motion || !anything_moved(*sweep.scene->stage.motion)) return;
    clocked(sweep.truths_s, [&] { make_reprojection(sweep, picture, *measured.run); });
    add_measures(measured.row, picture.truths->compare_motion(observed.counted, observed.reprojection));
    if (picture.reference)
        add_measures(measured.row, picture.truths->compare_ghosts(observed.shaded, *picture.reference));
}

MeasureValues history_measures(const HistoryCounts& counts)
{
    const size_t pixels = counts.accumulated + counts.unseen + counts.off_image + counts.other_depth +
                          counts.other_normal + counts.other_hit;
    return {{"history_share", share(counts.accumulated, pixels)},
            {"clamped_share", share(counts.clamped, counts.accumulated)}};
}

bool nothing_moves(const Scene& scene, const Run& run, int last_frame)
{
    for (int frame = 1; frame <= last_frame; ++frame) {
        const auto motion = motion_at(scene, run.view, run.size_px, frame);
        if (!motion || anything_moved(*motion)) return false;
    }
    return true;
}

void add_true_picture(MeasuredPicture& picture, const TraceSettings& settings, Image& sum)
{
    picture.truths->make(settings, false);
    if (!picture.truths->without_scene().empty()) return;
    const Image& shown = picture.truths->true_picture();
    if (sum.values.empty()) return void(sum = shown);
    for (size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += shown.values[i];
}

} // namespace

FrameHistoryPtr history_of(SweepContext& sweep, const Run& run)
{
    if (!is_sequence(sweep.experiment) || sweep.scene->stage.first.frame) return nullptr;
    SequenceState& state = sweep.sequences[sequence_id(run)];
    if (state.failed) throw_failure("a frame before this one failed, so this one has no history");
    if (!state.history) state.history = make_history(sweep.gpu, run.size_px);
    return state.history;
}

void leave_history(SweepContext& sweep, const Run& run, ReadyFrame& frame)
{
    if (history_of(sweep, run) == nullptr) return;
    clocked(sweep.counted_s, [&] {
        run_frame(sweep.gpu, frame);
        keep_history(sweep.gpu, frame, run.at.frame);
    });
}

void judge_sequence(SweepContext& sweep, MeasuredPicture& picture, MeasuredRun& measured, const Observed& observed)
{
    judge_motion(sweep, picture, measured, observed);
    if (observed.history) add_measures(measured.row, history_measures(*observed.history));
    const auto converged =
        std::ranges::find(sweep.converged, measured.run->settings.trace, &ConvergedPicture::settings);
    if (converged != sweep.converged.end())
        add_measures(measured.row, picture.truths->compare_converged(observed.shaded, converged->picture));
    if (is_sequence(sweep.experiment))
        add_measures(measured.row, watch_sequence(sweep, picture, *measured.run, observed));
}

void lose_sequence(SweepContext& sweep, const Run& run)
{
    sweep.sequences[sequence_id(run)]        = {};
    sweep.sequences[sequence_id(run)].failed = true;
}

void replay(SweepContext& sweep, const MeasuredPicture& picture, const Run& run)
{
    try {
        const UnderWay        under_way(sweep.state, run.id, sweep.experiment.measure.time_limit_s);
        const FrameHistoryPtr history = history_of(sweep, run);
        Stage&                stage   = sweep.scene->stage;
        const LabPtr          lab =
            make_lab(stage, find_technique(sweep.techniques, run.technique), run.values, run.settings.trace);
        const FramePlan plan  = plan_frame(stage, lab, picture.buffers, run.settings, history);
        const FramePtr  frame = make_frame(sweep.gpu, lab, picture.buffers, plan, history);
        clocked(sweep.counted_s, [&] {
            run_frame(sweep.gpu, *frame);
            watch_sequence(
                sweep, picture, run,
                {read_shaded(sweep.gpu, *frame), trace_gbuffer(sweep.gpu, *make_tracer(sweep.gpu, lab)), std::nullopt});
        });
        leave_history(sweep, run, *frame);
    } catch (const std::exception& error) {
        sweep.progress.say(fmt::format("frame {} of {}: {}", run.at.frame, sequence_id(run), error.what()));
        lose_sequence(sweep, run);
    }
}

void make_converged_pictures(SweepContext& sweep, std::span<const Run> runs, int last_frame)
{
    const MeasureSettings& measure = sweep.experiment.measure;
    const Run&             first   = runs.front();
    if (!measure.truth || !measure.image_errors || first.at.jitter_phases == 0) return;
    if (!nothing_moves(stage_of(sweep, first.scene).first, first, last_frame)) return;
    std::vector<std::pair<TraceSettings, Image>> sums;
    for (const Run& run : runs)
        if (std::ranges::none_of(sums, [&](const auto& sum) { return sum.first == run.settings.trace; }))
            sums.emplace_back(run.settings.trace, Image{});
    for (int phase = 0; phase < first.at.jitter_phases; ++phase) {
        Run at_phase            = first;
        at_phase.at.frame       = phase;
        MeasuredPicture picture = make_picture(sweep, at_phase);
        for (auto& [settings, sum] : sums) add_true_picture(picture, settings, sum);
        sweep.progress.tick();
    }
    std::erase_if(sums, [](const auto& sum) { return sum.second.values.empty(); });
    for (auto& [settings, sum] : sums) {
        for (float& value : sum.values) value /= static_cast<float>(first.at.jitter_phases);
        sweep.converged.push_back({settings, Reference(sum)});
    }
}

} // namespace ssrlab
