#include "harness/sequence_frame.h"

#include "core/error.h"

namespace ssrlab {
namespace {

MeasureValues watch_sequence(Bench& bench, const Picture& picture, const Run& run, const Observed& observed)
{
    const bool moved = picture.motion && (picture.motion->camera_moves || picture.motion->moving_draws > 0);
    return watch(bench.sequences[sequence_id(run)], observed.shaded, observed.counted, picture.jitter_px, moved);
}

/// Where something but jitter moved.
void judge_motion(Bench& bench, Picture& picture, MeasuredRun& measured, const Observed& observed)
{
    if (!picture.motion || !picture.truths) return;
    const FrameMotion& motion = *picture.motion;
    if (!motion.camera_moves && motion.moving_draws == 0) return;
    clocked(bench.truths_s, [&] {
        const LoadedScene& loaded = *bench.scene;
        if (motion.moving_draws == 0)
            picture.truths->make_reprojection(loaded.scene, motion);
        else
            picture.truths->make_reprojection(scene_at(loaded.first, loaded.frame - 1), motion);
    });
    add_measures(measured.row, picture.truths->compare_motion(observed.counted));
}

} // namespace

void judge_sequence(Bench& bench, Picture& picture, MeasuredRun& measured, const Observed& observed)
{
    judge_motion(bench, picture, measured, observed);
    if (is_sequence(bench.experiment))
        add_measures(measured.row, watch_sequence(bench, picture, *measured.run, observed));
}

void lose_sequence(Bench& bench, const Run& run)
{
    bench.sequences[sequence_id(run)]        = {};
    bench.sequences[sequence_id(run)].failed = true;
}

void replay(Bench& bench, const Picture& picture, const Run& run)
{
    try {
        const UnderWay         under_way(bench.state, run.id, bench.experiment.measure.time_limit_s);
        const PreparedFramePtr frame = prepare_frame(
            bench.gpu, picture.buffers, find_technique(bench.techniques, run.technique), run.values, run.settings);
        clocked(bench.counted_s, [&] {
            run_frame(bench.gpu, *frame);
            watch_sequence(bench, picture, run,
                           {read_shaded(bench.gpu, *frame), count_frame(bench.gpu, *frame), std::nullopt});
        });
    } catch (const std::exception& error) {
        bench.progress.say(fmt::format("frame {} of {}: {}", run.at.frame, sequence_id(run), error.what()));
        lose_sequence(bench, run);
    }
}

} // namespace ssrlab
