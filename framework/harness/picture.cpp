#include "harness/picture.h"

#include "core/quantile.h"
#include "harness/bake_scene.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

constexpr int gbuffer_repeats = 5;

} // namespace

Stage& stage_of(SweepContext& sweep, const std::string& scene)
{
    if (sweep.scene == nullptr || sweep.scene->name != scene) {
        sweep.scene.reset(); // before the next one is loaded: one scene in memory at a time
        Scene loaded = load_scene(scene);
        bake_scene(loaded, [&](const std::string& text) { sweep.progress.say(text); });
        sweep.scene = std::make_unique<LoadedScene>(
            LoadedScene{scene, open_stage(sweep.gpu, sweep.catalogue, std::move(loaded))});
        for (const std::string& warning : sweep.scene->stage.scene.warnings)
            sweep.progress.say(fmt::format("{}: {}", scene, warning));
    }
    return sweep.scene->stage;
}

std::optional<float> true_exponent(const Experiment& experiment)
{
    ParameterValues passes = default_pass_values();
    for (auto& [name, value] : passes)
        if (const auto set = experiment.settings.find(name); set != experiment.settings.end())
            value = set->second.front();
    return metallic_exponent_of(passes);
}

MeasuredPicture make_picture(SweepContext& sweep, const Run& run)
{
    Stage&          stage = stage_of(sweep, run.scene);
    MeasuredPicture picture;
    clocked(sweep.counted_s, [&] { show(stage, run.view, run.size_px, run.at); }); // a warm-up
    if (stage.drawing) {
        std::vector<double> times_ms;
        clocked(sweep.timed_s, [&] {
            for (int i = 0; i < gbuffer_repeats; ++i) times_ms.push_back(redraw_gbuffer(sweep.gpu, *stage.drawing));
        });
        picture.gbuffer_ms = quantile(std::move(times_ms), 0.5);
    }
    picture.round     = sweep.results.next_round();
    picture.jitter_px = jitter_px(run.at);
    picture.buffers   = make_frame_buffers(stage);
    if (sweep.experiment.measure.truth) {
        clocked(sweep.truths_s, [&] {
            picture.truths.emplace(stage.scene, read_gbuffer(sweep.gpu, *stage.gbuffer),
                                   truth_cache_dir(sweep.results.path()), true_exponent(sweep.experiment));
        });
    }
    return picture;
}

} // namespace ssrlab
