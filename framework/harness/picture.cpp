#include "harness/picture.h"

#include "core/quantile.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

constexpr int gbuffer_repeats = 5;

} // namespace

const LoadedScene& scene_of(SweepContext& sweep, const std::string& name, int frame)
{
    if (sweep.scene == nullptr || sweep.scene->name != name) {
        sweep.scene.reset(); // before the next one is loaded: one scene in memory at a time
        auto loaded   = std::make_unique<LoadedScene>();
        loaded->name  = name;
        loaded->first = load_scene(name);
        loaded->scene = loaded->first;
        if (!loaded->scene.frame) loaded->uploaded = upload_scene(sweep.gpu, loaded->scene);
        for (const std::string& warning : loaded->scene.warnings)
            sweep.progress.say(fmt::format("{}: {}", name, warning));
        sweep.scene = std::move(loaded);
    }
    LoadedScene& loaded = *sweep.scene;
    if (loaded.frame != frame && anything_moves(loaded.first)) {
        loaded.scene = scene_at(loaded.first, frame);
        move_scene(sweep.gpu, *loaded.uploaded, loaded.scene);
    }
    loaded.frame = frame;
    return *sweep.scene;
}

Picture make_picture(SweepContext& sweep, const Run& run)
{
    const LoadedScene& loaded = scene_of(sweep, run.scene, run.at.frame);
    const View         view   = view_at(loaded.scene, run.view, run.size_px, run.at);
    Picture            picture;
    picture.gbuffer = clocked(sweep.counted_s, [&] { // a warm-up
        return loaded.scene.frame ? upload_gbuffer(sweep.gpu, loaded.scene.frame->gbuffer)
                                  : render_gbuffer(sweep.gpu, loaded.uploaded, view,
                                                   motion_at(loaded.scene, run.view, run.size_px, run.at.frame));
    });
    if (!loaded.scene.frame) {
        std::vector<double> times_ms;
        clocked(sweep.timed_s, [&] {
            for (int i = 0; i < gbuffer_repeats; ++i) times_ms.push_back(rerender_gbuffer(sweep.gpu, *picture.gbuffer));
        });
        picture.gbuffer_ms = quantile(std::move(times_ms), 0.5);
    }
    picture.round     = sweep.results.next_round();
    picture.jitter_px = jitter_px(run.at);
    picture.motion    = motion_at(loaded.scene, run.view, run.size_px, run.at.frame);
    picture.buffers   = make_frame_buffers(sweep.gpu, picture.gbuffer);
    if (sweep.experiment.measure.truth) {
        clocked(sweep.truths_s, [&] {
            picture.truths.emplace(loaded.scene, read_gbuffer(sweep.gpu, *picture.gbuffer),
                                   truth_cache_dir(sweep.results.path()));
        });
    }
    return picture;
}

} // namespace ssrlab
