#include "harness/measured_run.h"

#include "compare/validate_result.h"
#include "core/files.h"
#include "harness/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>
#include <numeric>

namespace ssrlab {
namespace {

void add_summary(Record& row, const std::string& name, const Summary& summary)
{
    put(row, name + "_median", summary.median);
    put(row, name + "_mad", summary.mad);
    put(row, name + "_ci_low", summary.ci_low);
    put(row, name + "_ci_high", summary.ci_high);
}

double mean(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A number as one, a switch or a choice in words.
Value value_of(const Parameter& parameter, double value)
{
    const bool in_words = parameter.type == ParameterType::boolean || parameter.type == ParameterType::choice;
    return in_words ? Value(format_parameter(parameter, value)) : Value(value);
}

} // namespace

Record identity_row(const Experiment& experiment, const Run& run, const Technique& technique)
{
    Record row = {{"run_id", run.id},
                  {"experiment", experiment.name},
                  {"run_number", run.number},
                  {"scene", run.scene},
                  {"view", run.view},
                  {"width", run.size_px.x},
                  {"height", run.size_px.y},
                  {"frame", run.at.frame},
                  {"jitter_phases", run.at.jitter_phases},
                  {"technique", run.technique},
                  {"technique_ignores", fmt::format("{}", fmt::join(technique.ignores, " "))}};
    for (const Setting& setting : experiment.known_settings) {
        row[setting.name] = value_of(setting, setting.get(run.settings));
    }
    for (const Parameter& parameter : technique.parameters) {
        row[parameter.name] = value_of(parameter, run.values.at(parameter.name));
    }
    if (run.sources.list.empty()) return row;
    row["sources"] = run.sources.text;
    row["hand_on"] = std::string(hand_on_names[static_cast<size_t>(run.sources.hand_on)]);
    return row;
}

void add_counts(Record& row, const TraceImage& counted)
{
    require_possible(counted);
    std::array<double, trace_status_names.size()> ended{};
    std::vector<double>                           fetches, steps;
    for (size_t i = 0; i < counted.status.size(); ++i) {
        if (counted.status[i] == TraceStatus::not_traced) continue;
        ended[static_cast<size_t>(counted.status[i])] += 1;
        steps.push_back(counted.steps[i]);
        if (!counted.depth_fetches.empty())
            fetches.push_back(counted.depth_fetches[i] + structure_fetches_of(counted, i));
    }
    row["rays"]    = static_cast<int64_t>(steps.size());
    row["outcome"] = steps.empty() ? "no_rays" : "ok";
    if (steps.empty()) return;
    for (size_t status = 1; status < ended.size(); ++status) {
        const double share                                       = ended[status] / static_cast<double>(steps.size());
        row[fmt::format("{}_share", trace_status_names[status])] = share;
    }
    row["steps_p99"] = quantile(steps, 0.99);
    add_measures(row, count_work(counted));
    if (fetches.empty()) return;
    row["fetches_mean"] = mean(fetches);
    for (const StructureFetches& structure : counted.structure_fetches)
        row[structure.structure + ".fetches_mean"] =
            std::accumulate(structure.fetches.begin(), structure.fetches.end(), 0.0) /
            static_cast<double>(steps.size());
    row["fetches_p50"] = quantile(fetches, 0.5);
    row["fetches_p99"] = quantile(fetches, 0.99);
    row["fetches_max"] = std::ranges::max(fetches);
}

void add_measures(Record& row, const MeasureValues& values)
{
    for (const auto& [name, value] : values)
        if (value && name != "traced_rays") put(row, std::string(name), *value);
}

void add_repeat(Gpu& gpu, MeasuredRun& measured, double gbuffer_ms, int round)
{
    const std::clock_t cpu_before = std::clock();
    const FrameTimes   times      = run_frame(gpu, *measured.frame, measured.frames_per_submit);
    measured.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - cpu_before) / CLOCKS_PER_SEC /
                              measured.frames_per_submit);
    measured.rounds.push_back(round);
    for (const auto& [pass, ms] : times.passes_ms) measured.pass_ms[pass].push_back(ms);
    measured.trace_ms.push_back(times.of("trace"));
    measured.frame_ms.push_back(gbuffer_ms + times.total_ms());
    if (measured.unculled && measured.saved_ms.size() < saved_pairs)
        measured.saved_ms.push_back(run_frame(gpu, *measured.unculled, measured.frames_per_submit).total_ms() -
                                    times.total_ms());
}

int frames_for(double frame_ms, const MeasureSettings& measure, const GpuInfo& device)
{
    constexpr double filled_ms = 5, most = 64;
    if (measure.frames_per_submit > 0) return measure.frames_per_submit;
    return device.type == "Cpu" ? 1 : static_cast<int>(std::clamp(std::ceil(filled_ms / frame_ms), 1.0, most));
}

int repeats_for(double pilot_s, const MeasureSettings& measure)
{
    return static_cast<int>(std::clamp(measure.budget_s / pilot_s, static_cast<double>(measure.min_repeats),
                                       static_cast<double>(measure.max_repeats)));
}

/// How much longer the later half of the repeats took than the earlier one; NaN below six repeats.
double drift_of(std::span<const double> trace_ms)
{
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    if (trace_ms.size() < 6) return unknown;
    const auto   half    = static_cast<std::ptrdiff_t>(trace_ms.size() / 2);
    const double earlier = quantile({trace_ms.begin(), trace_ms.begin() + half}, 0.5);
    const double later   = quantile({trace_ms.end() - half, trace_ms.end()}, 0.5);
    return earlier > 0 ? later / earlier - 1 : unknown;
}

void add_times(MeasuredRun& measured, double gbuffer_ms)
{
    Record&       row   = measured.row;
    const Summary frame = summarise(measured.frame_ms);
    add_summary(row, "trace_ms", summarise(measured.trace_ms));
    add_summary(row, "frame_ms", frame);
    row["repeats"]           = static_cast<int64_t>(measured.trace_ms.size());
    row["frames_per_submit"] = measured.frames_per_submit;
    put(row, "trace_drift", drift_of(measured.trace_ms));
    if (gbuffer_ms > 0) row["gbuffer_ms_median"] = gbuffer_ms; // a frame of another renderer has none
    const auto median_ms = [&](const std::string& pass) {
        const auto found = measured.pass_ms.find(pass);
        return found == measured.pass_ms.end() ? 0 : quantile(found->second, 0.5);
    };
    row["rays_ms_median"] = median_ms("classification") + median_ms("rays");
    double structures_ms  = 0;
    for (const std::string& id : measured.structures) {
        row[id + ".ms_median"] = median_ms(id);
        structures_ms += median_ms(id);
    }
    row["structures_ms_median"] = structures_ms;
    double shade_ms             = 0;
    for (auto pass = std::ranges::find(measured.plan.passes, "trace", &PlannedPass::id);
         pass != measured.plan.passes.end(); ++pass)
        if (pass->id != "trace") shade_ms += median_ms(pass->id);
    row["shade_ms_median"] = shade_ms;
    row["passes_ran"]      = std::ranges::count(measured.plan.passes, true, &PlannedPass::runs);
    if (!measured.saved_ms.empty()) row["saved_ms"] = quantile(measured.saved_ms, 0.5);
    row["fps"]           = 1000 / frame.median;
    row["inverse_fps_s"] = frame.median / 1000;
}

std::string trace_command(const Experiment& experiment, const Run& run, const Technique& technique)
{
    const std::filesystem::path in_tree = data_root() / "techniques";
    std::string                 text    = "ssrlab trace " + run.scene;
    if (technique.folder.parent_path() != in_tree) text += " --techniques " + short_path(technique.folder);
    const std::filesystem::path& surface = find_surface(experiment.known_surfaces, run.settings.trace.surface).folder;
    if (surface.parent_path() != data_root() / "shaders/surfaces") text += " --techniques " + short_path(surface);
    text += fmt::format(" --view {} --size {} -t {}", run.view, size_text(run.size_px), technique.id);
    if (run.at.frame != 0) text += fmt::format(" --frame {}", run.at.frame);
    if (run.at.jitter_phases != 0) text += fmt::format(" --jitter {}", run.at.jitter_phases);
    for (const Parameter& parameter : technique.parameters)
        text += fmt::format(" -p {}={}", parameter.name, format_parameter(parameter, run.values.at(parameter.name)));
    for (const Setting& setting : experiment.known_settings)
        if (const double value = setting.get(run.settings); setting.table == "trace" && value != setting.default_value)
            text += fmt::format(" -p {}={}", setting.name, format_parameter(setting, value));
    return text + " -o hits.exr";
}

Record failed_row(Record row, const std::exception& error)
{
    row["outcome"] = dynamic_cast<const InvalidResult*>(&error) != nullptr ? "invalid" : "failed";
    row["message"] = error.what();
    return row;
}

} // namespace ssrlab
