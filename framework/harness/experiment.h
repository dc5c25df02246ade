// An experiment: a TOML file in which a list is a sweep; expanded, a list of runs.
#pragma once

#include "frame/stage.h"
#include "sources/answer_rays.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// The table [measure].
struct MeasureSettings {
    uint64_t seed              = 1;   // of the random order of repeats
    double   warmup_s          = 0.2; // untimed frames first, in which a GPU's clocks rise
    int      min_repeats       = 9;   // below 6 there is no confidence interval
    int      max_repeats       = 100;
    int      frames_per_submit = 0;    // the last is timed; 0: one on a CPU, more on a fast GPU
    double   time_limit_s      = 60;   // for preparing a run or one frame, without waiting for a processor
    double   budget_s          = 1;    // timing per run; a pilot frame decides how many repeats fit
    bool     truth             = true; // compare with the truths
    bool     image_errors      = true; // also compare images (SSIM, FLIP …), which takes longer than comparing rays
    bool     double_twin       = true; // trace again in double precision, to separate rounding
    bool     pictures          = true; // write the images of each run
    bool     saved_time        = true; // also time a few unculled frames; never with pass_set = shading
};

/// Values of a measure for which a search finds the cheapest settings.
struct Target {
    std::string         measure;
    std::vector<double> values;
    bool                higher_is_better = true;
};

using ValueLists = std::map<std::string, std::vector<double>>;

/// A list of [sources] that a run asks for answers beyond its frame.
struct AskedSources {
    std::string               text; // as in the specification: "frame,world"
    std::vector<ListedSource> list; // empty: none is asked
    HandOn                    hand_on = HandOn::uncertain;
};

/// A table [techniques.ID]: the values of every parameter, with defaults.
struct TechniqueSweep {
    std::string               id;
    std::string               place; // file:line
    ValueLists                values;
    ValueLists                settings; // those that the table itself sets, instead of the experiment's
    std::vector<AskedSources> sources;  // likewise; empty: the experiment's
};

/// A setting of [trace] or [passes], which is also a column of the record.
struct Setting : Parameter {
    std::string                                 table;
    std::function<double(const FrameSettings&)> get;
    std::function<void(FrameSettings&, double)> set;
};
/// The settings' names.
std::vector<std::string> names_of(std::span<const Setting> settings);
/// Returns all settings; the catalogue's surface models and reprojection strategies are choices among them.
std::vector<Setting> all_settings(const Catalogue& catalogue);

struct Experiment {
    std::filesystem::path                           file;
    std::string                                     text; // the whole file
    std::string                                     name, title;
    std::vector<std::string>                        scenes, views;
    std::map<std::string, std::vector<std::string>> scene_views =
        {};                                               // of scenes that have views of their own, instead of `views`
    std::string                scenes_place, views_place; // file:line
    std::vector<glm::ivec2>    sizes_px;
    std::vector<SequenceFrame> frames = {{}};
    /// The values of every setting by Setting::name, with defaults.
    ValueLists                  settings;
    std::vector<TechniqueSweep> techniques;
    std::vector<AskedSources>   sources = {{}}; // each list makes a run
    MeasureSettings             measure;
    std::vector<Target>         targets        = {};
    std::vector<Setting>        known_settings = {};
    std::vector<Surface>        known_surfaces = {};
    /// file:line of `sizes`, `frames`, `jitter_phases` and the settings that the specification names.
    std::map<std::string, std::string> places = {};
};

/// One technique with one set of values on one frame.
struct Run {
    std::string     id; // short hash of everything below; the same in every experiment and on every machine
    std::string     scene, view;
    glm::ivec2      size_px{0, 0};
    FrameSettings   settings;
    std::string     technique;
    ParameterValues values;
    AskedSources    sources = {};
    SequenceFrame   at      = {};
    std::string     trace_text, passes_text; // the settings as text, for the id
    int             number = 0;              // among the frame's runs, in the order of the specification
};

inline constexpr int    max_size_px      = 16384;
inline constexpr double max_runs_unasked = 100000;

/// Reads an experiment. Throws SpecError with file and line for what is unknown, missing or out of range.
Experiment load_experiment(const std::filesystem::path& file, const Catalogue& catalogue);

const std::vector<std::string>& views_of(const Experiment& experiment, const std::string& scene);

/// Returns the number of runs that expand() would make.
double count_runs(const Experiment& experiment);

/// Returns whether two runs share scene, view, size and frame of the sequence.
bool same_picture(const Run& a, const Run& b);
/// Returns whether two runs share all of these except the frame.
bool same_sequence(const Run& a, const Run& b);

/// Returns the runs ordered by scene, view, size and frame, each once. Throws SpecError for a run whose loop a driver
/// may cut, and for more than max_runs_unasked runs unless `many` is set.
std::vector<Run> expand(const Experiment& experiment, std::span<const Technique> techniques, bool many = false);

/// Returns the hash for Run::id.
std::string run_id(const Run& run);

std::string size_text(glm::ivec2 size_px); // "1280x720"

} // namespace ssrlab
