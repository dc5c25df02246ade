// An experiment is a TOML file in which a list is a sweep; expanded, it is a list of runs.
#pragma once

#include "frame/stage.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// How long and how often is measured.
struct MeasureSettings {
    uint64_t seed            = 1;   // of the random order of repeats
    double   warmup_s        = 0.2; // of untimed frames before the timed ones, in which a GPU's clocks rise
    int      min_repeats     = 9;   // below 6 there is no 95 % interval
    int      max_repeats     = 100;
    int    frames_per_submit = 0;  // one after another, of which the last is timed; 0: one on a CPU, more on a fast GPU
    double time_limit_s      = 60; // a run fails whose preparation or frame takes longer; waiting for a processor does not count
    double budget_s          = 1;  // a run has as many repeats as its pilot frame says fit into this
    bool   truth             = true; // compare with the truths
    bool   image_errors = true; // also compare the pictures (SSIM, FLIP …), which takes longer than comparing rays
    bool   double_twin  = true; // trace once more in double precision, to tell rounding from the other errors
    bool   pictures     = true; // write the reflected picture of each run
    bool   saved_time   = true; // time a few unculled frames, too; never with pass_set = shading
};

/// Values of a measure that a search makes techniques reach.
struct Target {
    std::string         measure;
    std::vector<double> values;
    bool                higher_is_better = true;
};

using ValueLists = std::map<std::string, std::vector<double>>;

/// One [techniques.ID] table: every parameter's values, defaults filled in.
struct TechniqueSweep {
    std::string id;
    std::string place; // file:line
    ValueLists  values;
    ValueLists  settings; // those that the table names itself, in place of the experiment's
};

/// A setting of [trace] or [passes]: key in the specification and column of the record, from this one table.
struct Setting : Parameter {
    std::string                                 table;
    std::function<double(const FrameSettings&)> get;
    std::function<void(FrameSettings&, double)> set;
};
/// Surface models and reprojection strategies are settings, too: those of the catalogue.
std::vector<Setting> all_settings(const Catalogue& catalogue);

struct Experiment {
    std::filesystem::path                           file;
    std::string                                     text; // the whole file
    std::string                                     name, title;
    std::vector<std::string>                        scenes, views;
    std::map<std::string, std::vector<std::string>> scene_views =
        {};                                  // in the place of `views`, of scenes that name them
    std::string                scenes_place; // file:line
    std::vector<glm::ivec2>    sizes_px;
    std::vector<SequenceFrame> frames = {{}};
    /// Every setting's values by Setting::name, defaults filled in.
    ValueLists                  settings;
    std::vector<TechniqueSweep> techniques;
    MeasureSettings             measure;
    std::vector<Target>         targets        = {};
    std::vector<Setting>        known_settings = {};
    std::vector<Surface>        known_surfaces = {};
};

/// One technique with one set of values on one picture: everything that decides its outcome, and its number.
struct Run {
    std::string     id; // short hash of all that follows; the same in every experiment and on every machine
    std::string     scene, view;
    glm::ivec2      size_px{0, 0};
    FrameSettings   settings;
    std::string     technique;
    ParameterValues values;
    SequenceFrame   at = {};
    std::string     trace_text, passes_text; // of the settings, as the id has them
    int             number = 0;              // among the picture's runs as the specification lists them
};

inline constexpr int    max_size_px      = 16384;
inline constexpr double max_runs_unasked = 100000;

/// Throws SpecError with file and line for whatever is unknown, missing, of the wrong type or out of range.
Experiment load_experiment(const std::filesystem::path& file, const Catalogue& catalogue);

const std::vector<std::string>& views_of(const Experiment& experiment, const std::string& scene);

/// The number of runs that expand() makes, without making them.
double count_runs(const Experiment& experiment);

/// Whether two runs share a picture: scene, view, size and frame of the sequence.
bool same_picture(const Run& a, const Run& b);
/// The same but for the frame.
bool same_sequence(const Run& a, const Run& b);

/// Scene by scene, view by view, size by size, frame by frame; a run listed twice comes once. Throws SpecError for a run whose iterations a
/// driver may cut, and for more than max_runs_unasked runs unless `many` is set.
std::vector<Run> expand(const Experiment& experiment, std::span<const Technique> techniques, bool many = false);

/// The short hash that is Run::id.
std::string run_id(const Run& run);

std::string size_text(glm::ivec2 size_px); // "1280x720"

} // namespace ssrlab
