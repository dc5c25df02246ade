// From lists to runs.
#include "harness/experiment.h"

#include "core/error.h"
#include "core/files.h"
#include "scene/load_scene.h"

#include <set>

namespace ssrlab {
namespace {

double combinations(const ValueLists& lists)
{
    double count = 1;
    for (const auto& [name, values] : lists) count *= static_cast<double>(values.size());
    return count;
}

/// Every combination of one value per name, the last name running fastest.
std::vector<ParameterValues> cross_product(const ValueLists& lists)
{
    std::vector<ParameterValues> rows(1);
    for (const auto& [name, values] : lists) {
        std::vector<ParameterValues> longer;
        for (const ParameterValues& row : rows) {
            for (const double value : values) {
                longer.push_back(row);
                longer.back()[name] = value;
            }
        }
        rows = std::move(longer);
    }
    return rows;
}

ValueLists settings_of(const Experiment& experiment, const TechniqueSweep& sweep)
{
    ValueLists lists = experiment.settings;
    for (const auto& [name, values] : sweep.settings) lists[name] = values;
    return lists;
}

const std::vector<AskedSources>& sources_of(const Experiment& experiment, const TechniqueSweep& sweep)
{
    return sweep.sources.empty() ? experiment.sources : sweep.sources;
}

/// The part of a run that its settings decide.
Run run_with(std::span<const Setting> known, const ParameterValues& values)
{
    Run run;
    for (const Setting& setting : known) {
        const double value = values.at(setting.name);
        setting.set(run.settings, value);
        // An effect's parameter counts when it is not at its default: a new effect leaves the ids of earlier runs alone.
        if (setting.table != "trace" && value == setting.default_value) continue;
        std::string& text = setting.table == "trace" ? run.trace_text : run.passes_text;
        text += fmt::format("{}={}\n", setting.name, format_parameter(setting, value));
    }
    return run;
}

void refuse_cut_loops(const TechniqueSweep& sweep, const Technique& technique, const ParameterValues& values)
{
    const double bound = iteration_bound(technique, values);
    if (bound <= max_iterations) return;
    throw_spec_error("{}: {} with these values may need {} iterations of one ray; a driver may cut loops above {}",
                     sweep.place, technique.id, bound, max_iterations);
}

/// Settings and values do not depend on the picture. Runs with the same settings stand together: they share a truth.
std::vector<Run> expand_picture(const Experiment& experiment, std::span<const Technique> techniques)
{
    std::map<ParameterValues, std::vector<Run>> by_settings;
    int                                         number = 0;
    for (const TechniqueSweep& sweep : experiment.techniques) {
        const Technique& technique = find_technique(techniques, sweep.id);
        const auto       values    = cross_product(sweep.values);
        for (const ParameterValues& one : values) refuse_cut_loops(sweep, technique, one);
        for (const ParameterValues& settings : cross_product(settings_of(experiment, sweep))) {
            Run run       = run_with(experiment.known_settings, settings);
            run.technique = sweep.id;
            for (const ParameterValues& one : values)
                for (const AskedSources& asked : sources_of(experiment, sweep)) {
                    run.values  = one;
                    run.sources = asked;
                    run.number  = number++;
                    by_settings[settings].push_back(run);
                }
        }
    }
    std::vector<Run> runs;
    for (const auto& [settings, some] : by_settings) runs.insert(runs.end(), some.begin(), some.end());
    return runs;
}

/// A frame of another renderer has the size that it has.
std::vector<glm::ivec2> sizes_of(const Experiment& experiment, const std::string& scene)
{
    return is_frame(scene) ? std::vector{frame_size_px(scene)} : experiment.sizes_px;
}

/// A frame of another renderer is one frame.
std::vector<SequenceFrame> frames_of(const Experiment& experiment, const std::string& scene)
{
    return is_frame(scene) ? std::vector<SequenceFrame>(1) : experiment.frames;
}

} // namespace

std::string run_id(const Run& run)
{
    std::string identity = fmt::format("{}\n{}\n{}\n{}\n", run.scene, run.view, size_text(run.size_px), run.technique);
    // A still frame has the id that it had before there were sequences.
    if (run.at != SequenceFrame{})
        identity += fmt::format("frame={}\njitter_phases={}\n", run.at.frame, run.at.jitter_phases);
    if (!run.sources.list.empty())
        identity += fmt::format("sources={}\nhand_on={}\n", run.sources.text,
                                hand_on_names[static_cast<size_t>(run.sources.hand_on)]);
    identity += run.trace_text + run.passes_text;
    for (const auto& [name, value] : run.values) identity += fmt::format("{}={}\n", name, value);
    // The letter keeps spreadsheets from reading 12e4… as a number.
    return "r" + content_hash(identity);
}

bool same_sequence(const Run& a, const Run& b)
{
    return a.scene == b.scene && a.view == b.view && a.size_px == b.size_px && a.at.jitter_phases == b.at.jitter_phases;
}

bool same_picture(const Run& a, const Run& b) { return same_sequence(a, b) && a.at.frame == b.at.frame; }

std::string size_text(glm::ivec2 size_px) { return fmt::format("{}x{}", size_px.x, size_px.y); }

const std::vector<std::string>& views_of(const Experiment& experiment, const std::string& scene)
{
    const auto own = experiment.scene_views.find(scene);
    return own == experiment.scene_views.end() ? experiment.views : own->second;
}

double count_runs(const Experiment& experiment)
{
    double sweeps = 0;
    for (const TechniqueSweep& sweep : experiment.techniques) {
        sweeps += combinations(settings_of(experiment, sweep)) * combinations(sweep.values) *
                  static_cast<double>(sources_of(experiment, sweep).size());
    }
    size_t views = 0;
    for (const std::string& scene : experiment.scenes) views += views_of(experiment, scene).size();
    return static_cast<double>(views * experiment.sizes_px.size() * experiment.frames.size()) * sweeps;
}

std::vector<Run> expand(const Experiment& experiment, std::span<const Technique> techniques, bool many)
{
    const double count = count_runs(experiment);
    if (count > max_runs_unasked && !many) {
        throw_spec_error("{}: expands to {} runs, more than {}; shorten a list, or confirm with --yes",
                         short_path(experiment.file), count, max_runs_unasked);
    }
    const std::vector<Run> on_each_picture = expand_picture(experiment, techniques);
    std::vector<Run>       runs;
    std::set<std::string>  ids;
    for (const std::string& scene : experiment.scenes)
        for (const std::string& view : views_of(experiment, scene))
            for (const glm::ivec2& size_px : sizes_of(experiment, scene))
                for (const SequenceFrame& at : frames_of(experiment, scene))
                    for (Run run : on_each_picture) {
                        run.scene   = scene;
                        run.view    = view;
                        run.size_px = size_px;
                        run.at      = at;
                        run.id      = run_id(run);
                        if (ids.insert(run.id).second) runs.push_back(std::move(run));
                    }
    return runs;
}

} // namespace ssrlab
