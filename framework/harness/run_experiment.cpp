#include "harness/run_experiment.h"

#include "core/error.h"
#include "core/files.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "harness/columns.h"
#include "harness/environment.h"
#include "harness/measure_sequence.h"
#include "harness/progress.h"
#include "harness/resolve_figures.h"
#include "harness/result_folder.h"
#include "harness/search.h"
#include "harness/stop_signal.h"
#include "harness/supervise.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

void refuse_unknown_scenes(const Experiment& experiment)
{
    const std::vector<SceneListing> listed = list_scenes();
    for (const std::string& scene : experiment.scenes) {
        const std::string extension = lower_extension(scene);
        const bool is_path = extension == ".glb" || extension == ".gltf" || extension == ".toml" || is_frame(scene);
        if (is_path ? fs::exists(scene) : std::ranges::find(listed, scene, &SceneListing::name) != listed.end())
            continue;
        throw_spec_error("{}: {}", experiment.scenes_place,
                         is_path ? "scene '" + scene + "': no such file" : unknown_scene(scene));
    }
}

/// A frame of another renderer is one picture of one size, and holds nothing behind its surfaces: rows that say otherwise would be false.
void refuse_what_frames_lack(const Experiment& experiment)
{
    const auto place = [&](const std::string& name) { return experiment.places.at(name); };
    for (const std::string& scene : experiment.scenes) {
        if (!is_frame(scene)) continue;
        const glm::ivec2 own_px = frame_size_px(scene);
        static_cast<void>(frame_files(scene)); // throws for mistakes in the file beside it
        if (experiment.places.contains("sizes") && std::ranges::count(experiment.sizes_px, own_px) == 0)
            throw_spec_error("{}: '{}' is a frame of {} pixels: expected 'sizes' with that size, or none, got {}",
                             place("sizes"), scene, size_text(own_px), size_text(experiment.sizes_px.front()));
        if (std::ranges::count(experiment.frames, SequenceFrame{}) == 0)
            throw_spec_error("{}: '{}' is one frame of another renderer: it has no further frames and no jitter",
                             place(experiment.places.contains("jitter_phases") ? "jitter_phases" : "frames"), scene);
        for (const Setting& setting : experiment.known_settings) {
            for (const TechniqueSweep& sweep : experiment.techniques) {
                const bool  own    = sweep.settings.contains(setting.name);
                const auto& values = own ? sweep.settings.at(setting.name) : experiment.settings.at(setting.name);
                for (const double value : values) {
                    FrameSettings settings;
                    setting.set(settings, value);
                    if (const std::string lacks = frame_lacks(scene, settings); !lacks.empty())
                        throw_spec_error("{}: {}", own ? sweep.place : place(setting.name), lacks);
                }
            }
        }
    }
}

void refuse_unknown_views(const Experiment& experiment)
{
    for (const std::string& scene : experiment.scenes) {
        const std::vector<std::string>& views = views_of(experiment, scene);
        // Every scene has the default view.
        if (std::ranges::count(views, Camera{}.name) == std::ssize(views)) continue;
        const ViewNames names = view_names(scene);
        for (const std::string& view : views)
            if (!names.has(view)) throw_spec_error("{}: {}", experiment.views_place, unknown_view(scene, view, names));
    }
}

void refuse_large_sizes(const Experiment& experiment, const GpuInfo& device)
{
    for (const glm::ivec2& size_px : experiment.sizes_px) {
        if (static_cast<uint32_t>(std::max(size_px.x, size_px.y)) <= device.max_drawn_px) continue;
        throw_spec_error("{}: size {} is more than {} can draw ({} pixels a side)", short_path(experiment.file),
                         size_text(size_px), device.name, device.max_drawn_px);
    }
}

/// All runs, or the one with this id: a listed one, or one that the search for targets may add.
std::vector<Run> choose(std::vector<Run> runs, std::span<const Technique> techniques, const std::string& only)
{
    if (only.empty()) return runs;
    if (const auto listed = std::ranges::find(runs, only, &Run::id); listed != runs.end()) return {*listed};
    if (const auto probe = find_probe(techniques, runs, only)) return {*probe};
    throw_spec_error("no run has the id '{}'; --dry-run lists them", only);
}

/// Runs on one scene, view and size stand together, frame by frame; takes the next such group off the front.
std::span<const Run> take_sequence(std::span<const Run>& rest)
{
    const Run& first    = rest.front();
    const auto same     = [&](const Run& run) { return same_sequence(run, first); };
    const auto count    = static_cast<size_t>(std::ranges::find_if_not(rest, same) - rest.begin());
    const auto sequence = rest.first(count);
    rest                = rest.subspan(count);
    return sequence;
}

struct Shard {
    size_t number = 1, of = 1;
};

Shard parse_shard(const std::string& text)
{
    Shard shard;
    int   read = 0;
    if (text.empty()) return shard;
    const bool whole = std::sscanf(text.c_str(), "%zu/%zu%n", &shard.number, &shard.of, &read) == 2 &&
                       read == static_cast<int>(text.size()) && std::isdigit(text.front()) != 0;
    if (!whole || shard.number < 1 || shard.number > shard.of)
        throw_spec_error("--shard must be I/N with 1 <= I <= N, got '{}'", text);
    return shard;
}

/// Runs on one scene, view and size stay together: they share truths, and ratios of their times are of one machine.
std::vector<Run> runs_of_shard(std::span<const Run> runs, const Shard& shard)
{
    std::vector<Run> own;
    for (size_t group = 0; !runs.empty(); ++group) {
        const auto sequence = take_sequence(runs);
        if (group % shard.of == shard.number - 1) own.insert(own.end(), sequence.begin(), sequence.end());
    }
    return own;
}

struct PlannedRuns {
    std::vector<Run> runs;
    std::string      figures; // resolve_figures() of all runs, those of other shards, too
};

PlannedRuns plan_runs(const RunOptions& options, const Experiment& experiment, std::span<const Technique> techniques)
{
    refuse_unknown_scenes(experiment);
    refuse_unknown_views(experiment);
    refuse_what_frames_lack(experiment);
    const Shard      shard   = parse_shard(options.shard);
    std::vector<Run> runs    = expand(experiment, techniques, options.yes);
    std::string      figures = resolve_figures(experiment, techniques, runs);
    return {runs_of_shard(choose(std::move(runs), techniques, options.only), shard), std::move(figures)};
}

fs::path folder_of(const RunOptions& options, const Experiment& experiment)
{
    if (!options.folder.empty()) return options.folder;
    const Shard shard = parse_shard(options.shard);
    return fs::path("results") /
           (experiment.name + (shard.of > 1 ? fmt::format("_{}_of_{}", shard.number, shard.of) : ""));
}

double total_cost(std::span<const Run> runs, std::span<const Technique> techniques, const MeasureSettings& measure)
{
    double seconds = 0;
    for (const Run& run : runs) seconds += estimated_seconds(run, find_technique(techniques, run.technique), measure);
    return seconds;
}

int list_runs(const Experiment& experiment, std::span<const Run> runs, std::span<const Technique> techniques)
{
    const FrameSettings defaults;
    for (const Run& run : runs) {
        const Technique& technique = find_technique(techniques, run.technique);
        std::string      values;
        for (const Parameter& parameter : technique.parameters) {
            values += fmt::format(" {}={}", parameter.name, format_parameter(parameter, run.values.at(parameter.name)));
        }
        if (!run.sources.list.empty())
            values += fmt::format("  sources={} hand_on={}", run.sources.text,
                                  hand_on_names[static_cast<size_t>(run.sources.hand_on)]);
        std::string settings;
        for (const Setting& setting : experiment.known_settings)
            if (setting.get(run.settings) != setting.get(defaults))
                settings += fmt::format(" {}={}", setting.name, format_parameter(setting, setting.get(run.settings)));
        fmt::print("{}  {} {} {} {}  {}{}\n", run.id, run.scene, run.view, size_text(run.size_px), settings,
                   run.technique, values);
    }
    fmt::print("{}, about {} on two CPU cores without a GPU{}\n", counted(runs.size(), "run"),
               duration_text(total_cost(runs, techniques, experiment.measure)),
               experiment.targets.empty() ? "" : "; the search for [targets] adds runs");
    return 0;
}

/// Of the validation layer, those after the first `reported`.
void report_messages(SweepContext& sweep, size_t& reported)
{
    const auto messages = validation_messages(sweep.gpu);
    for (; reported < messages.size(); ++reported, ++sweep.state.messages)
        sweep.progress.say("validation: " + messages[reported]);
}

/// A child ended at these: rows that say so, and no second try.
void record_lost(SweepContext& sweep, std::span<const Run> runs, const LostRun& lost)
{
    const auto at = std::ranges::find(runs, lost.run_id, &Run::id);
    if (at == runs.end()) throw_failure("run {} of the search for the targets: {}", lost.run_id, lost.why);
    const auto is_it = [&](const Run& run) { return lost.whole_picture ? same_picture(run, *at) : run.id == at->id; };
    for (const Run& run : runs) {
        if (!is_it(run)) continue;
        const Technique& technique = find_technique(sweep.techniques, run.technique);
        finish(sweep, run, failed_row(identity_row(sweep.experiment, run, technique), Failure(lost.why)));
    }
}

int run_sweep(const RunOptions& options, SweepState& state)
{
    const bool                    continues  = state.lost.run_id[0] != 0;
    const Catalogue               catalogue  = load_catalogue(options.techniques);
    const std::vector<Technique>& techniques = catalogue.techniques;
    Experiment                    experiment = load_experiment(options.specification, catalogue);
    const auto [runs, figures]               = plan_runs(options, experiment, techniques);
    if (!options.only.empty()) experiment.targets.clear(); // one run is asked for, no search
    const auto columns = result_columns(experiment, techniques);

    const Stopwatch stopwatch;
    Gpu             gpu = open_gpu(options.gpu);
    refuse_large_sizes(experiment, gpu.info);
    Environment environment = describe_environment(experiment, techniques, gpu.info, options.command_line);
    environment.figures     = figures;
    ResultFolder results(folder_of(options, experiment), columns, environment, options.resume || continues, !continues);
    std::vector<Run> pending = runs;
    std::erase_if(pending, [&](const Run& run) { return results.finished().contains(run.id); });

    Progress     progress(pending.size(), total_cost(pending, techniques, experiment.measure), options.quiet);
    SweepContext sweep{experiment, catalogue, techniques, gpu, results, progress, state, environment.identity};
    if (continues) record_lost(sweep, pending, state.lost);
    if (const std::string trouble = cache_trouble(truth_cache_dir(results.path())); !trouble.empty())
        progress.say("warning: " + trouble);
    for (const Technique& technique : techniques)
        if (std::ranges::count(technique.ignores, "unknown") > 0)
            progress.say(fmt::format("warning: {}: expected 'ignores': which of behind, surface and thickness its own "
                                     "hit test leaves out ([]: none)",
                                     short_path(technique.folder / "technique.toml")));
    size_t reported = 0;
    for (std::span<const Run> rest(runs); !rest.empty() && stop_requested() == 0;) {
        measure_sequence(sweep, take_sequence(rest));
        report_messages(sweep, reported);
    }
    results.require_unmoved();
    const double      took_s  = stopwatch.seconds();
    const std::string summary = fmt::format(
        "{}: {}, {} written now, {} of them failed; of {}, {:.0f} % went to frames that were timed, {:.0f} % "
        "to frames that were counted, {:.0f} % to truths\n",
        short_path(results.path() / "results.csv"), counted(results.finished().size(), "row"), state.written,
        state.failed, duration_text(took_s), 100 * sweep.timed_s / took_s, 100 * sweep.counted_s / took_s,
        100 * sweep.truths_s / took_s);
    std::fputs(summary.c_str(), stdout);
    if (stop_requested() != 0) {
        progress.say("stopped; the same command with --resume does the other runs");
        return 128 + stop_requested();
    }
    if (state.messages > 0) progress.say(counted(state.messages, "message") + " of the validation layer");
    return state.failed > 0 || state.messages > 0 ? 1 : 0;
}

} // namespace

int run_experiment(const RunOptions& options)
{
    if (options.dry_run) {
        const Catalogue  catalogue  = load_catalogue(options.techniques);
        const Experiment experiment = load_experiment(options.specification, catalogue);
        return list_runs(experiment, plan_runs(options, experiment, catalogue.techniques).runs, catalogue.techniques);
    }
    SweepState* state = shared_with_parent();
    if (state == nullptr) return supervise(own_command());
    listen_for_stop();
    return run_sweep(options, *state);
}

} // namespace ssrlab
