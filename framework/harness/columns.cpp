#include "harness/columns.h"

#include "compare/measures.h"
#include "core/error.h"
#include "core/files.h"
#include "core/trace_image.h"

#include <algorithm>

namespace ssrlab {
namespace {

using enum ColumnType;

const std::vector<Column> identity = {
    {"run_id",
     "hash of the run: scene, view, size, technique, settings, parameters; content hashes are in "
     "environment.json",
     words},
    {"experiment", "name of the specification", words},
    {"run_number",
     "position in the specification's list of runs of this frame, from 0; the others are compared with run 0", whole},
    {"scene", "file, recipe or builtin:NAME", words},
    {"view", "camera", words},
    {"width", "pixels", whole},
    {"height", "pixels", whole},
    {"frame", "of the sequence: 0 is the scene as loaded and the start of a camera path", whole},
    {"jitter_phases", "sub-pixel offsets of the camera (Halton 2, 3) that repeat after so many frames; 0: none", whole},
    {"technique", "folder of the technique", words},
    {"sources", "list of sources asked for answers beyond the frame; empty: none", words},
    {"hand_on", "which rays each further source of the list gets: lost or uncertain", words},
};

const std::vector<Column> times = {
    {"trace_ms_median", "GPU time of the trace pass, median over the repeats"},
    {"trace_ms_mad", "its median absolute deviation"},
    {"trace_ms_ci_low", "lower end of the 95 % confidence interval of the median; empty below six repeats"},
    {"trace_ms_ci_high", "upper end"},
    {"repeats", "timed frames", whole},
    {"frames_per_submit", "frames that a repeat submits together; the last is timed", whole},
    {"trace_drift",
     "median trace time of the later half of the repeats over that of the earlier half, minus 1: far from 0 where the "
     "device's clocks moved; empty below six repeats"},
    {"gbuffer_ms_median", "rendering the G-buffer, measured once per scene, view and size"},
    {"rays_ms_median", "finding the tiles that reflect and making the rays"},
    {"structures_ms_median", "building the structures that the technique reads; 0 without any"},
    {"shade_ms_median", "all passes after the trace, which turn hits into the finished picture"},
    {"passes_ran", "passes of the frame that ran; passes.csv says of each whether it ran, how long it took, and why",
     whole},
    {"saved_ms",
     "time saved by skipping: the unculled frame (skip_unneeded_passes = false) minus the planned one, median over "
     "five pairs; empty if only disabled passes were skipped, or if it was not measured (saved_time = false, "
     "pass_set = shading)"},
    {"frame_ms_median", "sum of all passes with the G-buffer's median, per repeat; median over the repeats"},
    {"frame_ms_mad", "its median absolute deviation"},
    {"frame_ms_ci_low", "lower end of the 95 % confidence interval of the median"},
    {"frame_ms_ci_high", "upper end"},
    {"fps", "1000 / frame_ms_median"},
    {"inverse_fps_s", "frame_ms_median / 1000"},
};

const std::vector<Column> counts = {
    {"rays", "traced rays: pixels that reflect", whole},
    {"fetches_mean", "reads of depth and of structures per traced ray"},
    {"fetches_p50", "median over the rays"},
    {"fetches_p99", "99th percentile over the rays"},
    {"fetches_max", "of the worst ray"},
    {"steps_p99", "loop iterations, 99th percentile over the rays"},
};

const std::vector<Column> price_of_sources = {
    {"sources_asked", "sources of the list; sources.csv says of each what it answered and at what price", whole},
    {"sources_ms", "time of drawing, tracing and shading all sources of the list"},
    {"sources_megabytes", "device memory of all sources of the list beyond what the frame needs"},
};

const std::vector<Column> ending = {
    {"picture",
     "the reflected picture, relative to this file; beside it NAME_agreement.png (right and wrong in false "
     "colours), NAME_causes.png (why rays are wrong), NAME_fetches.png (work per ray) and NAME_flip.png "
     "(difference from truth_picture)",
     words},
    {"truth_picture", "the same picture with the scene truth's reflection; beside it NAME_off.png, without reflections",
     words},
    {"technique_ignores",
     "of behind, surface and thickness: what the technique's own hit test does not ask, by its "
     "manifest; empty: it asks all of them; unknown: the manifest does not say",
     words},
    {"frame_lacks",
     "solid_back: the surface model asks where solids end, and the frame file does not say, so every surface counts as "
     "thin; empty: nothing is missing",
     words},
    {"no_screen_truth", "why the measures that need the screen truth are empty; empty: they have a value", words},
    {"no_scene_truth", "why the measures that need the scene's triangles are empty; empty: they have a value", words},
    {"outcome",
     "ok; no_rays: nothing in the picture reflects; failed: see message; invalid: a ray has an answer that "
     "cannot be, see message",
     words},
    {"message", "what went wrong", words},
};

void append(std::vector<Column>& columns, const std::vector<Column>& more)
{
    columns.insert(columns.end(), more.begin(), more.end());
}

std::vector<Column> settings(const Experiment& experiment)
{
    std::vector<Column> columns;
    for (const Setting& setting : experiment.known_settings)
        columns.push_back({setting.name, setting.doc, ColumnType::setting});
    return columns;
}

/// The union over the techniques: what two of them call alike shares a column.
std::vector<Column> parameters(const Experiment& experiment, std::span<const Technique> techniques)
{
    std::vector<Column> columns;
    for (const TechniqueSweep& sweep : experiment.techniques) {
        for (const Parameter& parameter : find_technique(techniques, sweep.id).parameters) {
            if (std::ranges::find(columns, parameter.name, &Column::name) == columns.end()) {
                columns.push_back({parameter.name, parameter.doc, ColumnType::setting});
            }
        }
    }
    return columns;
}

/// Of each structure that some technique reads.
std::vector<Column> structure_columns(const Experiment& experiment, std::span<const Technique> techniques)
{
    std::vector<Column> columns;
    for (const TechniqueSweep& sweep : experiment.techniques)
        for (const Structure& structure : find_technique(techniques, sweep.id).structures) {
            const std::string ms = structure.id + ".ms_median";
            if (std::ranges::find(columns, ms, &Column::name) != columns.end()) continue;
            columns.push_back({ms, fmt::format("building the structure {}", structure.id)});
            columns.push_back({structure.id + ".fetches_mean",
                               fmt::format("reads of the structure {} per traced ray", structure.id)});
        }
    return columns;
}

std::vector<Column> shares()
{
    std::vector<Column> columns;
    for (size_t status = 1; status < trace_status_names.size(); ++status) {
        columns.push_back({fmt::format("{}_share", trace_status_names[status]),
                           fmt::format("rays that ended as {}, of the traced ones", trace_status_names[status])});
    }
    return columns;
}

std::vector<Column> quality()
{
    std::vector<Column> columns;
    for (const Measure& measure : measures()) {
        if (measure.name == "traced_rays") continue; // "rays" above
        columns.push_back({std::string(measure.name), fmt::format("{} ({})", measure.formula, measure.unit)});
    }
    return columns;
}

void refuse_same_names(const Experiment& experiment, std::span<const Technique> techniques,
                       std::span<const Column> built_in)
{
    for (const TechniqueSweep& sweep : experiment.techniques) {
        const Technique& technique = find_technique(techniques, sweep.id);
        for (const Parameter& parameter : technique.parameters) {
            if (std::ranges::find(built_in, parameter.name, &Column::name) == built_in.end()) continue;
            throw_spec_error("{}: parameter '{}' has the name of a column of results.csv; call it otherwise",
                             short_path(technique.folder / "technique.toml"), parameter.name);
        }
    }
}

} // namespace

std::vector<Column> setting_columns(const Experiment& experiment, std::span<const Technique> techniques)
{
    std::vector<Column> columns = identity;
    append(columns, settings(experiment));
    append(columns, parameters(experiment, techniques));
    return columns;
}

std::vector<Column> result_columns(const Experiment& experiment, std::span<const Technique> techniques)
{
    std::vector<Column> front = identity;
    append(front, settings(experiment));
    std::vector<Column> back = times;
    append(back, counts);
    append(back, structure_columns(experiment, techniques));
    append(back, quality());
    append(back, price_of_sources);
    append(back, shares());
    append(back, ending);
    refuse_same_names(experiment, techniques, front);
    refuse_same_names(experiment, techniques, back);
    std::vector<Column> columns = setting_columns(experiment, techniques);
    append(columns, back);
    return columns;
}

} // namespace ssrlab
