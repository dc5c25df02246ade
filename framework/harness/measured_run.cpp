#include "harness/measured_run.h"

#include "compare/validate_result.h"
#include "core/files.h"
#include "harness/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <numeric>

namespace ssrlab {
namespace {

void add_summary(Row& row, const std::string& name, const Summary& summary)
{
    row[name + "_median"]  = number_text(summary.median);
    row[name + "_mad"]     = number_text(summary.mad);
    row[name + "_ci_low"]  = number_text(summary.ci_low);
    row[name + "_ci_high"] = number_text(summary.ci_high);
}

double mean(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

} // namespace

std::string number_text(double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value); }

Row identity_row(const Experiment& experiment, const Run& run, const Technique& technique)
{
    Row row = {{"run_id", run.id},
               {"experiment", experiment.name},
               {"run_number", std::to_string(run.number)},
               {"scene", run.scene},
               {"view", run.view},
               {"width", std::to_string(run.size_px.x)},
               {"height", std::to_string(run.size_px.y)},
               {"frame", std::to_string(run.at.frame)},
               {"jitter_phases", std::to_string(run.at.jitter_phases)},
               {"technique", run.technique},
               {"technique_ignores", fmt::format("{}", fmt::join(technique.ignores, " "))}};
    for (const Setting& setting : all_settings()) {
        row[setting.name] = format_parameter(setting, setting.get(run.settings));
    }
    for (const Parameter& parameter : technique.parameters) {
        row[parameter.name] = format_parameter(parameter, run.values.at(parameter.name));
    }
    return row;
}

void add_counts(Row& row, const TraceResult& counted)
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
    row["rays"]    = std::to_string(steps.size());
    row["outcome"] = steps.empty() ? "no_rays" : "ok";
    if (steps.empty()) return;
    for (size_t status = 1; status < ended.size(); ++status) {
        const double share                                       = ended[status] / static_cast<double>(steps.size());
        row[fmt::format("{}_share", trace_status_names[status])] = number_text(share);
    }
    row["steps_p99"] = number_text(quantile(steps, 0.99));
    add_measures(row, count_work(counted));
    if (fetches.empty()) return;
    row["fetches_mean"] = number_text(mean(fetches));
    for (const StructureFetches& structure : counted.structure_fetches)
        row[structure.structure + ".fetches_mean"] =
            number_text(std::accumulate(structure.fetches.begin(), structure.fetches.end(), 0.0) /
                        static_cast<double>(steps.size()));
    row["fetches_p50"] = number_text(quantile(fetches, 0.5));
    row["fetches_p99"] = number_text(quantile(fetches, 0.99));
    row["fetches_max"] = number_text(std::ranges::max(fetches));
}

void add_measures(Row& row, const MeasureValues& values)
{
    for (const auto& [name, value] : values) {
        if (value && name != "traced_rays") row[std::string(name)] = number_text(*value);
    }
}

void add_plan(Row& row, const std::vector<PlannedPass>& plan)
{
    std::string skipped, why;
    for (const PlannedPass& planned : plan) {
        if (!planned.runs) skipped += (skipped.empty() ? "" : " ") + planned.id;
        why += fmt::format("{}{}: {}", why.empty() ? "" : "; ", planned.id, planned.reason);
    }
    row["passes_skipped"] = skipped;
    row["passes_why"]     = why;
}

void add_repeat(Gpu& gpu, MeasuredRun& measured, double gbuffer_ms, int round)
{
    const std::clock_t cpu_before = std::clock();
    const FrameTimes   times      = run_frame(gpu, *measured.frame, measured.frames_per_submit);
    measured.cpu_ms.push_back(1000.0 * static_cast<double>(std::clock() - cpu_before) / CLOCKS_PER_SEC /
                              measured.frames_per_submit);
    measured.rounds.push_back(round);
    measured.pass_order.clear();
    for (const auto& [pass, ms] : times.passes_ms) {
        measured.pass_order.push_back(pass);
        measured.pass_ms[pass].push_back(ms);
    }
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

/// How much longer the later half of the repeats took than the earlier one.
std::string drift_text(std::span<const double> trace_ms)
{
    if (trace_ms.size() < 6) return "";
    const auto   half    = static_cast<std::ptrdiff_t>(trace_ms.size() / 2);
    const double earlier = quantile({trace_ms.begin(), trace_ms.begin() + half}, 0.5);
    const double later   = quantile({trace_ms.end() - half, trace_ms.end()}, 0.5);
    return earlier > 0 ? number_text(later / earlier - 1) : "";
}

void add_times(MeasuredRun& measured, double gbuffer_ms)
{
    Row&          row   = measured.row;
    const Summary frame = summarise(measured.frame_ms);
    add_summary(row, "trace_ms", summarise(measured.trace_ms));
    add_summary(row, "frame_ms", frame);
    row["repeats"]           = std::to_string(measured.trace_ms.size());
    row["frames_per_submit"] = std::to_string(measured.frames_per_submit);
    row["trace_drift"]       = drift_text(measured.trace_ms);
    row["gbuffer_ms_median"] = gbuffer_ms > 0 ? number_text(gbuffer_ms) : ""; // a frame of another renderer has none
    const auto median_ms     = [&](const std::string& pass) {
        const auto found = measured.pass_ms.find(pass);
        return found == measured.pass_ms.end() ? 0 : quantile(found->second, 0.5);
    };
    row["rays_ms_median"] = number_text(median_ms("classification") + median_ms("rays"));
    double structures_ms  = 0;
    for (const std::string& id : measured.structures) {
        row[id + ".ms_median"] = number_text(median_ms(id));
        structures_ms += median_ms(id);
    }
    row["structures_ms_median"] = number_text(structures_ms);
    row["shade_ms_median"]      = number_text(median_ms("hit_colour") + median_ms("composite"));
    std::string passes;
    for (const std::string& id : measured.pass_order)
        passes += fmt::format("{}{}={}", passes.empty() ? "" : " ", id, number_text(median_ms(id)));
    row["passes"] = passes;
    if (!measured.saved_ms.empty()) row["saved_ms"] = number_text(quantile(measured.saved_ms, 0.5));
    row["fps"]           = number_text(1000 / frame.median);
    row["inverse_fps_s"] = number_text(frame.median / 1000);
}

std::string trace_command(const Run& run, const Technique& technique)
{
    const std::filesystem::path in_tree = data_root() / "techniques";
    std::string                 text    = "ssrlab trace " + run.scene;
    if (technique.folder.parent_path() != in_tree) text += " --techniques " + short_path(technique.folder);
    const std::filesystem::path& surface = find_surface(run.settings.trace.surface).folder;
    if (surface.parent_path() != data_root() / "shaders/surfaces") text += " --techniques " + short_path(surface);
    text += fmt::format(" --view {} --size {} -t {}", run.view, size_text(run.size_px), technique.id);
    if (run.at.frame != 0) text += fmt::format(" --frame {}", run.at.frame);
    if (run.at.jitter_phases != 0) text += fmt::format(" --jitter {}", run.at.jitter_phases);
    for (const Parameter& parameter : technique.parameters)
        text += fmt::format(" -p {}={}", parameter.name, format_parameter(parameter, run.values.at(parameter.name)));
    for (const Setting& setting : all_settings())
        if (const double value = setting.get(run.settings); setting.table == "trace" && value != setting.default_value)
            text += fmt::format(" -p {}={}", setting.name, format_parameter(setting, value));
    return text + " -o hits.exr";
}

Row failed_row(Row row, const std::exception& error)
{
    row["outcome"] = dynamic_cast<const InvalidResult*>(&error) != nullptr ? "invalid" : "failed";
    row["message"] = error.what();
    return row;
}

} // namespace ssrlab
