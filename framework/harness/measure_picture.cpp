#include "harness/measure_picture.h"

#include "compare/image_io.h"
#include "compare/pictures.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel_rows.h"
#include "core/stopwatch.h"
#include "harness/choice.h"
#include "harness/environment.h"
#include "harness/no_hits.h"
#include "harness/passes.h"
#include "harness/picture.h"
#include "harness/samples.h"
#include "harness/search.h"
#include "harness/sequence_frame.h"
#include "harness/source_rows.h"
#include "harness/statistics.h"
#include "harness/stop_signal.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <map>

namespace ssrlab {
namespace {

// Runs that are timed interleaved, and so in pairs: most frames have fewer; few enough that a kill loses little. A search has all of its
// frame's runs in one batch, since what it compares must be paired.
constexpr size_t batch_size = 64;

double cost_of(const SweepContext& sweep, const Run& run)
{
    return estimated_seconds(run, find_technique(sweep.techniques, run.technique), sweep.experiment.measure);
}

/// Shaders are read when a run is prepared: one that was edited under a sweep must not end in the same file. Asked after preparing,
/// before anything of it is written.
void refuse_changed_sources(const SweepContext& sweep)
{
    const auto changed =
        differences(sweep.identity, describe_identity(sweep.experiment, sweep.techniques, sweep.gpu.info));
    if (changed.empty()) return;
    throw_failure("{}: stopped, because these changed while it was measured: {}; its rows are from before",
                  short_path(sweep.results.path()), fmt::join(changed, ", "));
}

/// Tries a step of one run; when it throws, the run's row says why and the run is over.
template <typename Step> bool try_step(SweepContext& sweep, MeasuredRun& measured, const Step& step)
{
    try {
        step();
        return true;
    } catch (const std::exception& error) {
        refuse_changed_sources(sweep);
        finish(sweep, *measured.run, failed_row(measured.row, error));
        lose_sequence(sweep, *measured.run);
        measured.run = nullptr;
        return false;
    }
}

/// It has its row.
bool is_over(const MeasuredRun& measured) { return measured.run == nullptr; }

/// pictures/SCENE_VIEW_SIZE_TECHNIQUE_ID, without the ending.
std::string picture_name(const Run& run)
{
    std::string name =
        fmt::format("{}_{}_{}_{}_{}", run.scene, run.view, size_text(run.size_px), run.technique, run.id);
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; }, '_');
    return "pictures/" + name;
}

/// The plan of the run's frame, and the frame.
void plan_run(SweepContext& sweep, const MeasuredPicture& picture, MeasuredRun& measured)
{
    const Run&            run       = *measured.run;
    const Technique&      technique = find_technique(sweep.techniques, run.technique);
    const FrameHistoryPtr history   = history_of(sweep, run);
    Stage&                stage     = sweep.scene->stage;
    measured.lab                    = make_lab(stage, technique, run.values, run.settings.trace);
    measured.plan                   = plan_frame(stage, measured.lab, picture.buffers, run.settings, history);
    measured.frame                  = make_frame(sweep.gpu, measured.lab, picture.buffers, measured.plan, history);
    sweep.counted_s += measured.plan.counting_s;
}

/// Everything on the device but the timed repeats: warm-up, picture, counts.
Observed observe(SweepContext& sweep, MeasuredRun& measured)
{
    const MeasureSettings& measure = sweep.experiment.measure;
    return clocked(sweep.counted_s, [&] {
        const TracerPtr tracer  = make_tracer(sweep.gpu, measured.lab);
        const bool      doubled = measure.truth && measure.double_twin && sweep.gpu.info.float64;
        const TracerPtr twin    = doubled ? make_tracer(sweep.gpu, measured.lab, NumberFormat::float64) : nullptr;
        run_frame(sweep.gpu, *measured.frame);
        for (const PassTraffic& pass : count_traffic(sweep.gpu, *measured.frame)) measured.traffic[pass.pass] = pass;
        Observed observed{read_shaded(sweep.gpu, *measured.frame), trace_gbuffer(sweep.gpu, *tracer),
                          read_hidden_hits(sweep.gpu, *measured.frame)};
        observed.reprojection = read_reprojection(sweep.gpu, *measured.frame);
        observed.history      = read_history_counts(sweep.gpu, *measured.frame);
        if (twin) observed.twin = trace_gbuffer(sweep.gpu, *twin);
        return observed;
    });
}

/// The name of the run's true picture. Runs that trace alike share it, whichever of them a sweep that is resumed begins with.
std::string truth_name(const Run& run)
{
    Run named         = run;
    named.technique   = "truth";
    named.values      = {};
    named.sources     = {};
    named.passes_text = "";
    named.id          = run_id(named);
    return picture_name(named);
}

/// The picture with true reflections, and beside it the one without any; those of the first run stay.
void write_references(SweepContext& sweep, MeasuredPicture& picture, const MeasuredRun& measured, const Image& truth)
{
    if (!sweep.experiment.measure.pictures) return;
    const std::string           name  = truth_name(*measured.run);
    const std::filesystem::path path  = sweep.results.path() / (name + ".png"),
                                plain = sweep.results.path() / (name + "_off.png");
    picture.reference_file            = name + ".png";
    const std::vector<glm::vec4> none(pixel_count(truth.size_px), glm::vec4(0, 0, 0, -1));
    std::filesystem::create_directories(path.parent_path());
    if (!std::filesystem::exists(path)) write_image(path, truth);
    if (!std::filesystem::exists(plain)) write_image(plain, composite_reflection(sweep.gpu, *measured.frame, none));
}

/// Makes what judging the run needs, unless the last run had the same settings.
void make_references(SweepContext& sweep, MeasuredPicture& picture, const MeasuredRun& measured)
{
    const FrameSettings& settings     = measured.run->settings;
    const bool           image_errors = sweep.experiment.measure.image_errors;
    if (!picture.truths) return;
    clocked(sweep.truths_s, [&] {
        if (picture.truths->known_layers() < static_cast<size_t>(settings.trace.layers))
            picture.truths->know_layers(read_gbuffer(sweep.gpu, *sweep.scene->stage.gbuffer).layers);
        const std::string lacked = picture.truths->without_scene();
        picture.truths->make(settings.trace, image_errors);
        if (const std::string& lacks = picture.truths->without_scene(); !lacks.empty() && lacks != lacked)
            sweep.progress.say(fmt::format("warning: {} {}: no scene truth: {}", measured.run->scene,
                                           size_text(measured.run->size_px), lacks));
        if (!image_errors || (picture.reference && picture.reference_for == settings.trace)) return;
        picture.reference.reset();
        picture.reference_file.clear();
        const std::optional<Image> given = picture.truths->given_picture();
        if (!given && !picture.truths->without_scene().empty()) return;
        picture.reference     = given ? Reference(*given) : picture.truths->true_reference();
        picture.reference_for = settings.trace;
        write_references(sweep, picture, measured, given ? *given : picture.truths->true_picture());
    });
}

/// What was seen, how right it is, and how hard it was; the path without the ending.
void write_pictures(const std::filesystem::path& path, const MeasuredPicture& picture, const Observed& observed)
{
    std::filesystem::create_directories(path.parent_path());
    const auto write = [&](const char* ending, const Image& image) { write_image(path.string() + ending, image); };
    parallel_rows(5, 0, [&](int i) {
        if (i == 0) write(".png", observed.shaded);
        if (i == 1) write("_fetches.png", fetch_heat_map(observed.counted));
        if (i == 2 && picture.truths)
            if (const auto agreement = picture.truths->agreement(observed.counted)) write("_agreement.png", *agreement);
        if (i == 4 && picture.truths)
            if (const auto causes = picture.truths->causes(observed.counted)) write("_causes.png", *causes);
        if (i == 3 && picture.reference)
            write("_flip.png", picture.truths->flip_of(observed.shaded, *picture.reference));
    });
}

/// A value that is no number spreads into every mean.
void warn_of_not_finite(const SweepContext& sweep, const MeasuredPicture& picture, MeasuredRun& measured,
                        const Observed& observed)
{
    const MeasureValues found =
        count_not_finite(observed.shaded, picture.truths ? &picture.truths->gbuffer() : nullptr);
    add_measures(measured.row, found);
    if (const double pixels = found.at("not_finite").value_or(0); pixels > 0)
        sweep.progress.say(fmt::format("warning: {}: {} pixels of the picture or its G-buffer are not finite",
                                       measured.run->id, pixels));
}

/// Pictures, counts and comparisons with the truths.
void judge(const SweepContext& sweep, MeasuredPicture& picture, MeasuredRun& measured, const Observed& observed)
{
    const MeasureSettings& measure = sweep.experiment.measure;
    if (measure.pictures) {
        const std::string name = picture_name(*measured.run);
        write_pictures(sweep.results.path() / name, picture, observed);
        measured.row["picture"] = name + ".png";
        if (!picture.reference_file.empty()) measured.row["truth_picture"] = picture.reference_file;
    }
    add_counts(measured.row, observed.counted);
    warn_of_not_finite(sweep, picture, measured, observed);
    if (!picture.truths) return;
    const auto pointer = [](const std::optional<TraceImage>& result) { return result ? &*result : nullptr; };
    measured.row["no_scene_truth"]  = picture.truths->without_scene();
    measured.row["no_screen_truth"] = Truths::without_screen(measured.run->settings.trace);
    add_measures(measured.row,
                 picture.truths->compare(observed.counted, pointer(observed.twin), pointer(observed.hidden)));
    if (measure.image_errors && picture.reference)
        add_measures(measured.row, picture.truths->compare_picture(observed.shaded, *picture.reference));
}

/// Nothing is measured by answers that cannot be.
void refuse_impossible(const SweepContext& sweep, const Run& run, const Observed& observed)
{
    const Technique& technique = find_technique(sweep.techniques, run.technique);
    const double     steps     = declared_steps(technique, run.values);
    const auto       refuse    = [&](const TraceImage& result, const char* where) {
        if (const auto found = find_impossible(result, steps))
            throw InvalidResult(
                         fmt::format("{}{}; {}", where, *found, trace_command(sweep.experiment, run, technique)));
    };
    refuse(observed.counted, "");
    if (observed.twin) refuse(*observed.twin, "in double precision: ");
    if (observed.hidden) refuse(*observed.hidden, "in the second layer: ");
}

/// What sources build is kept for the next run that traces alike.
SourceContext& sources_of(SweepContext& sweep, MeasuredPicture& picture, const Run& run)
{
    const Run& last  = picture.sources_for;
    const bool alike = last.technique == run.technique && last.values == run.values && last.settings == run.settings;
    if (picture.sources && alike) return *picture.sources;
    picture.sources.reset(); // before the next one is made: one in memory at a time
    picture.sources     = std::make_unique<SourceContext>(context_of_frame(sweep.scene->stage,
                                                                           find_technique(sweep.techniques, run.technique),
                                                                           run.values, run.settings, run.view, run.at));
    picture.sources_for = run;
    return *picture.sources;
}

void ask_listed_sources(SweepContext& sweep, MeasuredPicture& picture, MeasuredRun& measured)
{
    const AskedSources& asked = measured.run->sources;
    if (asked.list.empty()) return;
    if (const std::string& why = picture.truths->without_scene(); !why.empty())
        throw_failure("sources cannot be judged: no scene truth: {}", why);
    const UnderWay under_way(sweep.state, measured.run->id, sweep.experiment.measure.time_limit_s);
    clocked(sweep.counted_s, [&] {
        SourceContext& context = sources_of(sweep, picture, *measured.run);
        measured.sources       = ask_sources(context, choose_sources(context, asked.list, asked.hand_on), asked.hand_on,
                                             picture.truths->scene_truth());
    });
}

/// Everything but the timed repeats.
void prepare(SweepContext& sweep, MeasuredPicture& picture, MeasuredRun& measured)
{
    const Observed observed = [&] {
        const UnderWay under_way(sweep.state, measured.run->id, sweep.experiment.measure.time_limit_s);
        plan_run(sweep, picture, measured);
        return observe(sweep, measured);
    }();
    refuse_impossible(sweep, *measured.run, observed);
    make_references(sweep, picture, measured);
    judge(sweep, picture, measured, observed);
    judge_sequence(sweep, picture, measured, observed);
    ask_listed_sources(sweep, picture, measured);
}

/// The pilot: one warm frame, whose time is not recorded, says how many repeats fit into the budget.
void plan_repeats(SweepContext& sweep, MeasuredRun& measured)
{
    clocked(sweep.counted_s, [&] {
        const UnderWay  under_way(sweep.state, measured.run->id, sweep.experiment.measure.time_limit_s);
        const Stopwatch stopwatch;
        const double    frame_ms   = run_frame(sweep.gpu, *measured.frame).total_ms();
        const double    pilot_s    = stopwatch.seconds();
        measured.frames_per_submit = frames_for(frame_ms, sweep.experiment.measure, sweep.gpu.info);
        measured.repeats           = repeats_for(pilot_s * measured.frames_per_submit, sweep.experiment.measure);
    });
}

/// The same frame, unculled, where that is more.
void prepare_comparison(SweepContext& sweep, const MeasuredPicture& picture, MeasuredRun& measured)
{
    if (!sweep.experiment.measure.saved_time || !skips_work(measured.plan)) return;
    const size_t   known = pipelines_made(sweep.gpu);
    const UnderWay under_way(sweep.state, measured.run->id, sweep.experiment.measure.time_limit_s);
    measured.unculled =
        make_frame(sweep.gpu, measured.lab, picture.buffers, unculled(measured.plan), history_of(sweep, *measured.run));
    // A driver may compile a pipeline when it first runs.
    if (pipelines_made(sweep.gpu) != known) clocked(sweep.counted_s, [&] { run_frame(sweep.gpu, *measured.unculled); });
}

double warm_frame_ms(SweepContext& sweep, MeasuredRun& measured)
{
    double ms = 0;
    try_step(sweep, measured, [&] {
        const UnderWay under_way(sweep.state, measured.run->id, sweep.experiment.measure.time_limit_s);
        ms = run_frame(sweep.gpu, *measured.frame).total_ms();
    });
    return ms;
}

/// Untimed frames of all runs in turn for half a second or longer: the device's time for a frame of each, as a mean over whole turns.
double warm_turns_ms(SweepContext& sweep, std::vector<MeasuredRun>& open)
{
    const Stopwatch stopwatch;
    double          sum_ms = 0, turns = 0;
    for (; !open.empty() && stop_requested() == 0 && stopwatch.seconds() < 0.5; ++turns) {
        for (MeasuredRun& measured : open) sum_ms += warm_frame_ms(sweep, measured);
        std::erase_if(open, is_over);
    }
    return turns > 0 ? sum_ms / turns : 0;
}

/// Untimed frames: a GPU that was idle raises its clocks in steps, some tenths of a second apart. It is warm when frames no longer get faster.
void warm_up(SweepContext& sweep, std::vector<MeasuredRun>& open)
{
    const double     warmup_s = sweep.experiment.measure.warmup_s;
    constexpr double most_s = 5, faster = 0.97;
    clocked(sweep.counted_s, [&] {
        const Stopwatch stopwatch;
        for (size_t i = 0; !open.empty() && stop_requested() == 0 && stopwatch.seconds() < warmup_s; ++i) {
            warm_frame_ms(sweep, open[i % open.size()]);
            std::erase_if(open, is_over);
        }
        if (sweep.gpu.info.type == "Cpu" || warmup_s <= 0) return;
        double before_ms = warm_turns_ms(sweep, open), now_ms = 0;
        for (; stopwatch.seconds() < most_s && !open.empty() && stop_requested() == 0; before_ms = now_ms) {
            now_ms = warm_turns_ms(sweep, open);
            if (now_ms >= faster * before_ms) return;
        }
    });
}

void finish_measured(SweepContext& sweep, const MeasuredPicture& picture, MeasuredRun& measured)
{
    add_times(measured, picture.gbuffer_ms);
    add_sources(measured.row, measured.sources);
    finish(sweep, *measured.run, measured.row, {samples_text(measured), passes_text(measured), sources_text(measured)});
}

/// Timed repeats, every round in another order, until each run has those planned for it or a stop was requested.
void repeat_until_final(SweepContext& sweep, MeasuredPicture& picture, std::vector<MeasuredRun>& open)
{
    const auto is_last = [](const MeasuredRun& measured) {
        return static_cast<int>(measured.rounds.size()) >= measured.repeats;
    };
    while (!open.empty() && stop_requested() == 0) {
        std::ranges::shuffle(open, sweep.random);
        for (MeasuredRun& measured : open) {
            if (stop_requested() != 0) break;
            try_step(sweep, measured, [&] {
                const UnderWay under_way(sweep.state, measured.run->id, sweep.experiment.measure.time_limit_s);
                clocked(sweep.timed_s, [&] { add_repeat(sweep.gpu, measured, picture.gbuffer_ms, picture.round); });
                if (is_last(measured)) leave_history(sweep, *measured.run, *measured.frame);
            });
            if (is_over(measured) || !is_last(measured)) continue;
            finish_measured(sweep, picture, measured);
            measured.run = nullptr;
        }
        std::erase_if(open, is_over);
        ++picture.round;
        sweep.progress.tick();
    }
}

/// On a stop, what was measured often enough is kept; the rest is left for --resume.
void keep_measured(SweepContext& sweep, const MeasuredPicture& picture, std::vector<MeasuredRun>& open)
{
    for (MeasuredRun& measured : open) {
        if (static_cast<int>(measured.trace_ms.size()) < sweep.experiment.measure.min_repeats) continue;
        finish_measured(sweep, picture, measured);
    }
}

/// Those with the same settings one after another: truths and true pictures depend on them.
std::vector<const Run*> by_settings(std::span<const Run> runs)
{
    std::vector<const Run*> grouped;
    for (const Run& run : runs) grouped.push_back(&run);
    for (auto rest = grouped.begin(); rest != grouped.end();)
        rest = std::stable_partition(
            rest, grouped.end(), [&settings = (*rest)->settings](const Run* run) { return run->settings == settings; });
    return grouped;
}

/// All of a run but its timed repeats; a run that fails is over.
void open_run(SweepContext& sweep, MeasuredPicture& picture, const Run& run, std::vector<MeasuredRun>& open)
{
    sweep.progress.tick();
    MeasuredRun measured;
    measured.run               = &run;
    const Technique& technique = find_technique(sweep.techniques, run.technique);
    measured.row               = identity_row(sweep.experiment, run, technique);
    for (const Structure& structure : technique.structures) measured.structures.push_back(structure.id);
    const Scene&         scene    = sweep.scene->stage.scene;
    const TraceSettings& settings = run.settings.trace;
    measured.row["frame_lacks"]   = lacked_channel(scene, find_surface(sweep.catalogue.surfaces, settings.surface));
    const std::string lacked      = lacked_channel_text(scene, sweep.catalogue, settings);
    if (!lacked.empty() && sweep.said.insert(lacked).second) sweep.progress.say(lacked);
    const auto prepare_all = [&] {
        prepare(sweep, picture, measured);
        prepare_comparison(sweep, picture, measured);
        plan_repeats(sweep, measured);
    };
    if (!try_step(sweep, measured, prepare_all)) return;
    const std::string no_hits = no_hits_text(technique, settings, scene, measured.plan.statistics.trace);
    if (!no_hits.empty() && sweep.said.insert(technique.id).second) sweep.progress.say(no_hits);
    sweep.progress.prepared_run(run.id, cost_of(sweep, run));
    open.push_back(std::move(measured));
}

void time_runs(SweepContext& sweep, MeasuredPicture& picture, std::vector<MeasuredRun>& open)
{
    refuse_changed_sources(sweep);
    finish_pipelines(sweep.gpu);
    warm_up(sweep, open);
    repeat_until_final(sweep, picture, open);
    keep_measured(sweep, picture, open);
}

void measure_batch(SweepContext& sweep, MeasuredPicture& picture, std::span<const Run> runs)
{
    std::vector<MeasuredRun> open;
    for (const Run* run : by_settings(runs)) {
        if (stop_requested() != 0) return;
        open_run(sweep, picture, *run, open);
    }
    time_runs(sweep, picture, open);
}

/// The picture, or rows that say why there is none.
std::optional<MeasuredPicture> try_picture(SweepContext& sweep, std::span<const Run> runs,
                                           std::span<const Run> replayed = {})
{
    try {
        const Run&     any = runs.empty() ? replayed.front() : runs.front();
        const UnderWay under_way(sweep.state, any.id, 0, true);
        return make_picture(sweep, any);
    } catch (const std::exception& error) {
        refuse_changed_sources(sweep);
        for (const Run& run : runs) {
            const Technique& technique = find_technique(sweep.techniques, run.technique);
            finish(sweep, run, failed_row(identity_row(sweep.experiment, run, technique), error));
            lose_sequence(sweep, run);
        }
        for (const Run& run : replayed) lose_sequence(sweep, run);
        return std::nullopt;
    }
}

std::vector<Run> without_row(const SweepContext& sweep, std::span<const Run> runs)
{
    std::vector<Run> pending(runs.begin(), runs.end());
    std::erase_if(pending, [&](const Run& run) { return sweep.results.finished().contains(run.id); });
    return pending;
}

/// Measures are known before a run is timed. So the search comes first, and then all runs of the picture, listed ones and those of the
/// search, are timed in the same rounds.
void search_and_measure(SweepContext& sweep, std::span<const Run> listed)
{
    std::map<std::string, Record>  rows = sweep.results.rows();
    std::vector<Run>               all(listed.begin(), listed.end());
    std::deque<Run>                opened; // keeps addresses
    std::vector<MeasuredRun>       open;
    std::optional<MeasuredPicture> picture;
    for (std::vector<Run> next = all; !next.empty();) {
        const std::vector<Run> pending = without_row(sweep, next);
        if (!picture && !pending.empty()) picture = try_picture(sweep, pending);
        if (!picture && !pending.empty()) return;
        for (const Run* run : by_settings(pending)) {
            if (stop_requested() != 0) return;
            open_run(sweep, *picture, opened.emplace_back(*run), open);
        }
        for (const MeasuredRun& measured : open) rows[measured.run->id] = measured.row;
        next = next_probes(sweep.experiment, sweep.techniques, all, rows);
        all.insert(all.end(), next.begin(), next.end());
        const std::vector<Run> added = without_row(sweep, next);
        double                 cost  = 0;
        for (const Run& run : added) cost += cost_of(sweep, run);
        sweep.progress.add_runs(added.size(), cost);
    }
    if (picture) time_runs(sweep, *picture, open);
}

} // namespace

void finish(SweepContext& sweep, const Run& run, const Record& row, const RunLines& lines)
{
    sweep.results.append(row, lines);
    ++sweep.state.written;
    if (row.contains("message")) {
        ++sweep.state.failed;
        sweep.progress.say(fmt::format("run {} {}: {}", run.id, words_of(row, "outcome"), words_of(row, "message")));
    }
    sweep.progress.finish_run(run.id, cost_of(sweep, run));
}

void measure_picture(SweepContext& sweep, std::span<const Run> listed, std::span<const Run> replayed)
{
    if (listed.empty() && replayed.empty()) return;
    const Run&        first = listed.empty() ? replayed.front() : listed.front();
    const std::string frame = first.at == SequenceFrame{} ? "" : fmt::format(" frame {}", first.at.frame);
    sweep.progress.start_picture(fmt::format("{} {} {}{}", first.scene, first.view, size_text(first.size_px), frame));
    if (!sweep.experiment.targets.empty()) return search_and_measure(sweep, listed);
    const std::vector<Run> pending = without_row(sweep, listed);
    if (pending.empty() && replayed.empty()) return;
    std::optional<MeasuredPicture> picture = try_picture(sweep, pending, replayed);
    for (std::span<const Run> rest(pending); picture && !rest.empty() && stop_requested() == 0;) {
        const auto batch = rest.first(std::min(batch_size, rest.size()));
        rest             = rest.subspan(batch.size());
        measure_batch(sweep, *picture, batch);
    }
    for (const Run& run : replayed)
        if (picture && stop_requested() == 0) replay(sweep, *picture, run);
}

} // namespace ssrlab
