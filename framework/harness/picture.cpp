#include "harness/picture.h"

#include "core/quantile.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

constexpr int gbuffer_repeats = 5;

} // namespace

const LoadedScene& scene_of(Bench& bench, const std::string& name, int frame)
{
    if (bench.scene == nullptr || bench.scene->name != name) {
        bench.scene.reset(); // before the next one is loaded: one scene in memory at a time
        auto loaded   = std::make_unique<LoadedScene>();
        loaded->name  = name;
        loaded->first = load_scene(name);
        loaded->scene = loaded->first;
        if (!loaded->scene.frame) loaded->uploaded = upload_scene(bench.gpu, loaded->scene);
        for (const std::string& warning : loaded->scene.warnings)
            bench.progress.say(fmt::format("{}: {}", name, warning));
        bench.scene = std::move(loaded);
    }
    LoadedScene& loaded = *bench.scene;
    if (loaded.frame != frame && anything_moves(loaded.first)) {
        loaded.scene = scene_at(loaded.first, frame);
        move_scene(bench.gpu, *loaded.uploaded, loaded.scene);
    }
    loaded.frame = frame;
    return *bench.scene;
}

Picture make_picture(Bench& bench, const Run& run)
{
    const LoadedScene& loaded = scene_of(bench, run.scene, run.at.frame);
    const View         view   = view_at(loaded.scene, run.view, run.size_px, run.at);
    Picture            picture;
    picture.gbuffer = clocked(bench.counted_s, [&] { // a warm-up
        return loaded.scene.frame ? upload_gbuffer(bench.gpu, loaded.scene.frame->gbuffer)
                                  : render_gbuffer(bench.gpu, loaded.uploaded, view,
                                                   motion_at(loaded.scene, run.view, run.size_px, run.at.frame));
    });
    if (!loaded.scene.frame) {
        std::vector<double> times_ms;
        clocked(bench.timed_s, [&] {
            for (int i = 0; i < gbuffer_repeats; ++i) times_ms.push_back(rerender_gbuffer(bench.gpu, *picture.gbuffer));
        });
        picture.gbuffer_ms = quantile(std::move(times_ms), 0.5);
    }
    picture.round     = bench.results.next_round();
    picture.jitter_px = jitter_px(run.at);
    picture.motion    = motion_at(loaded.scene, run.view, run.size_px, run.at.frame);
    picture.buffers   = make_frame_buffers(bench.gpu, picture.gbuffer);
    if (bench.experiment.measure.truth) {
        clocked(bench.truths_s, [&] {
            picture.truths.emplace(loaded.scene, read_gbuffer(bench.gpu, *picture.gbuffer),
                                   truth_cache_dir(bench.results.path()));
        });
    }
    return picture;
}

} // namespace ssrlab
