#include "app/fit_command.h"

#include "app/fit_report.h"
#include "core/environment_variable.h"
#include "core/error.h"
#include "core/files.h"
#include "core/names.h"
#include "core/printable.h"
#include "gpu/compiled.h"
#include "harness/chip_cost.h"
#include "harness/columns.h"
#include "harness/supervise.h"
#include "harness/write_experiment.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

// The sweep, and then halvings of the ratio between its neighbours: of 8 to less than 1.1 (search_ratio) in six.
constexpr int most_rounds = 7;

struct Budget {
    FitUnit unit;
    double  most;
};

Budget budget_of(const FitOptions& options)
{
    std::vector<Budget> given;
    if (options.budget_ms) given.push_back({FitUnit::ms, *options.budget_ms});
    if (options.budget_fetches) given.push_back({FitUnit::fetches, *options.budget_fetches});
    if (options.budget_instructions) given.push_back({FitUnit::instructions, *options.budget_instructions});
    if (given.size() != 1)
        throw_spec_error("fit: expected a budget: --budget-ms, --budget-fetches or --budget-instructions, one of them");
    const Budget budget = given.front();
    if ((budget.unit == FitUnit::instructions) == options.chip.empty())
        throw_spec_error("fit: expected --budget-instructions and --chip together");
    return budget;
}

void require_folder(const FitOptions& options)
{
    std::error_code error;
    if (!options.resume && fs::exists(options.output, error) && !fs::is_empty(options.output, error))
        throw_spec_error("-o {}: expected a new or empty folder; --resume continues in an old one", options.output);
    if (!fs::create_directories(options.output, error) && error)
        throw_failure("-o {}: cannot be created: {}", options.output, error.message());
}

void narrow_to_techniques(Experiment& sweep, const std::vector<std::string>& techniques)
{
    if (techniques.empty()) return;
    std::vector<std::string> swept;
    for (const TechniqueSweep& one : sweep.techniques)
        if (std::ranges::find(swept, one.id) == swept.end()) swept.push_back(one.id);
    for (const std::string& id : techniques)
        if (std::ranges::find(swept, id) == swept.end())
            throw_spec_error("-t {}: {}", id, unknown_name("technique of the sweep", id, swept));
    std::erase_if(sweep.techniques,
                  [&](const TechniqueSweep& one) { return std::ranges::find(techniques, one.id) == techniques.end(); });
}

/// A setting that is given is not swept.
void give_value(Experiment& sweep, const Catalogue& catalogue, const std::string& pair)
{
    const std::string place  = "-p " + pair;
    const auto        equals = pair.find('=');
    if (equals == std::string::npos) throw_spec_error("{}: expected name=value", place);
    const std::string name = pair.substr(0, equals), text = pair.substr(equals + 1);
    const auto        setting = std::ranges::find(sweep.known_settings, name, &Setting::name);
    if (setting != sweep.known_settings.end()) {
        sweep.settings[name] = {parse_parameter(*setting, text, place)};
        for (TechniqueSweep& one : sweep.techniques) one.settings.erase(name);
        return;
    }
    bool                     known = false;
    std::vector<std::string> parameters;
    for (TechniqueSweep& one : sweep.techniques) {
        for (const auto& [parameter, values] : one.values) parameters.push_back(parameter);
        if (!one.values.contains(name)) continue;
        const Technique& technique = find_technique(catalogue.techniques, one.id);
        one.values[name]           = {parse_parameter(find_parameter(technique, name, place), text, place)};
        known                      = true;
    }
    std::ranges::sort(parameters);
    parameters.erase(std::unique(parameters.begin(), parameters.end()), parameters.end());
    if (!known)
        throw_spec_error(
            "{}: {}", place,
            unknown_name("parameter of the sweep's techniques", name, parameters, names_of(sweep.known_settings)));
}

std::vector<std::string> views_of_frame(const FitOptions& options, const std::string& name)
{
    const Scene scene = load_scene(name);
    if (options.objective == "flip" && scene.frame->reference.empty())
        throw_spec_error("{}: --objective flip: expected a frame with a 'reference', a picture of the true "
                         "reflections (docs/reference/frame_files.md)",
                         name);
    std::vector<std::string> views = options.views.empty() ? std::vector{Camera{}.name} : options.views;
    for (const std::string& view : views)
        for (const int frame : options.frames) view_at(scene, view, {}, {frame, 0});
    return views;
}

/// The views of a scene that are asked for. Throws SpecError for what the scene lacks.
std::vector<std::string> views_for(const FitOptions& options, const std::string& name)
{
    if (is_frame(name)) return views_of_frame(options, name);
    const ViewNames names = view_names(name);
    for (const std::string& view : options.views)
        if (!names.has(view)) throw SpecError(unknown_view(name, view, names));
    return options.views.empty() ? names.cameras : options.views;
}

void set_pictures(const FitOptions& options, Experiment& sweep)
{
    sweep.scenes = options.scenes;
    sweep.scene_views.clear();
    for (const std::string& scene : options.scenes) sweep.scene_views[scene] = views_for(options, scene);
    if (!options.size.empty()) sweep.sizes_px = {size_option(options.size)};
    sweep.sizes_px.resize(1);
    sweep.frames.clear();
    for (const int frame : options.frames) sweep.frames.push_back({frame, 0});
    sweep.sources = {{}};
}

/// Each surface model has a screen truth of its own, so F1 against it says nothing about which is the right one.
void keep_trace_settings(const CommonOptions& common, const FitOptions& options, Experiment& sweep)
{
    if (options.objective != "f1" || std::ranges::none_of(options.scenes, is_frame)) return;
    for (const Setting& setting : sweep.known_settings) {
        if (setting.table != "trace") continue;
        for (TechniqueSweep& one : sweep.techniques) one.settings.erase(setting.name);
        if (sweep.settings[setting.name].size() > 1) sweep.settings[setting.name] = {setting.default_value};
    }
    if (!common.quiet)
        std::fputs("note: a frame has no triangles, so F1 is that of the screen truth, and surface and thickness "
                   "stay as -p gives them\n",
                   stderr);
}

Experiment load_sweep(const CommonOptions& common, const FitOptions& options, const Catalogue& catalogue)
{
    const fs::path shipped = data_root() / "experiments" / ("fit_" + options.objective + ".toml");
    Experiment     sweep   = load_experiment(options.sweep.empty() ? shipped : fs::path(options.sweep), catalogue);
    narrow_to_techniques(sweep, options.techniques);
    set_pictures(options, sweep);
    keep_trace_settings(common, options, sweep);
    for (const std::string& pair : options.parameters) give_value(sweep, catalogue, pair);
    return sweep;
}

/// Fetches are the same in every frame, times are not.
std::string measure_text(const FitGoal& goal)
{
    std::string text = "double_twin  = false\npictures     = false\nsaved_time   = false\n";
    if (!goal.picture) text += "image_errors = false\n";
    return text + (goal.unit == FitUnit::ms
                       ? "min_repeats  = 6\nmax_repeats  = 30\nbudget_s     = 0.5\n"
                       : "warmup_s     = 0\nmin_repeats  = 1\nmax_repeats  = 1\nbudget_s     = 0\n");
}

std::vector<std::string> run_command(const CommonOptions& common, const fs::path& specification, const fs::path& folder)
{
    std::vector<std::string> command = {"ssrlab", "run", specification.string(), "-o", folder.string()};
    if (fs::exists(folder / "results.csv")) command.emplace_back("--resume");
    if (common.quiet) command.emplace_back("--quiet");
    if (common.gpu.validation) command.emplace_back("--validation");
    if (!common.gpu.device.empty()) command.insert(command.end(), {"--device", common.gpu.device});
    if (common.gpu.storage != TexelStorage::by_device)
        command.insert(
            command.end(),
            {"--storage", common.gpu.storage == TexelStorage::texel_buffers ? "texel-buffers" : "plain-buffers"});
    if (common.gpu.passes != PassStyle::by_device)
        command.insert(command.end(), {"--passes", common.gpu.passes == PassStyle::serial ? "serial" : "parallel"});
    for (const fs::path& folder_of_techniques : common.technique_dirs)
        command.insert(command.end(), {"--techniques", folder_of_techniques.string()});
    return command;
}

void add_rows(const fs::path& folder, const fs::path& specification, const Catalogue& catalogue,
              std::map<std::string, Record>& rows)
{
    const auto        columns = result_columns(load_experiment(specification, catalogue), catalogue.techniques);
    const std::string text    = read_file(folder / "results.csv");
    std::string_view  rest    = text;
    take_csv_record(rest); // the header
    while (const auto fields = take_csv_record(rest)) rows[fields->front()] = record_of(*fields, columns);
}

/// A device that compiles for the chip. The sweep's processes inherit the environment, and run where they would without it.
Gpu open_chip(const std::string& chip)
{
    const EnvironmentVariable family("RADV_FORCE_FAMILY"), driver("VK_ICD_FILENAMES"), drivers("VK_DRIVER_FILES");
    pretend_chip(chip);
    GpuOptions options;
    options.compiles_only = true;
    return open_gpu(options);
}

/// Adds the column "instructions" to the rows of a setting.
void add_instructions(const ChipCode& code, const Run& setting, std::span<const Run> pictures,
                      std::map<std::string, Record>& rows)
{
    for (const Run& picture : pictures) {
        const auto row = rows.find(on_picture(setting, picture).id);
        if (row == rows.end()) continue;
        if (const auto instructions = instructions_of(code, row->second, picture.size_px))
            row->second["instructions"] = *instructions;
    }
}

struct Measured {
    std::vector<Run>   pictures;
    std::vector<Tried> tried;
    int                code    = 0;     // of the sweep, as run_experiment() returns it
    bool               is_over = false; // stopped, or nothing could be measured
};

/// Runs of the first picture, and one of each picture.
std::pair<std::vector<Run>, std::vector<Run>> take_apart(std::span<const Run> runs)
{
    std::vector<Run> settings, pictures;
    for (const Run& run : runs) {
        if (same_picture(run, runs.front())) settings.push_back(run);
        if (pictures.empty() || !same_picture(run, pictures.back())) pictures.push_back(run);
    }
    return {settings, pictures};
}

void say_dropped(std::span<const Run> all, std::span<const Run> judged)
{
    for (const Run& picture : all)
        if (std::ranges::none_of(judged, [&](const Run& one) { return same_picture(one, picture); }))
            std::fprintf(stderr, "warning: %s %s: left out, nothing in it can be judged (results.csv says why)\n",
                         picture.scene.c_str(), picture.view.c_str());
}

/// The sweep, and then what next_tries() asks for, each into a folder of its own. chip: whose instructions are paid.
Measured measure(const CommonOptions& common, const FitOptions& options, const Catalogue& catalogue,
                 const Experiment& sweep, const FitGoal& goal, std::optional<Gpu>& chip)
{
    const double budget  = budget_of(options).most;
    auto [all, pictures] = take_apart(expand(sweep, catalogue.techniques));
    std::map<std::string, Record> rows;
    Measured                      measured;
    std::vector<Run>              next = all;
    // What is left out must not say where to search.
    const int rounds = options.leave_one_out ? 1 : most_rounds;
    for (int round = 1; !next.empty() && round <= rounds; ++round) {
        const fs::path folder        = fs::path(options.output) / fmt::format("round_{}", round);
        const fs::path specification = folder.string() + ".toml";
        write_file_atomically(specification,
                              experiment_text(folder.filename().string(), pictures, next, sweep.known_settings,
                                              catalogue.techniques, measure_text(goal)));
        std::vector<ChipCode> codes; // of `next`; none without a chip
        if (chip)
            for (const Run& run : next) codes.push_back(compile_for_chip(*chip, catalogue, run));
        const int code = supervise(run_command(common, specification, folder));
        measured.code  = std::max(measured.code, code);
        if (measured.is_over = code > 1 || !fs::exists(folder / "results.csv"); measured.is_over) return measured;
        add_rows(folder, specification, catalogue, rows);
        for (size_t i = 0; i < codes.size(); ++i) add_instructions(codes[i], next[i], pictures, rows);
        measured.pictures = judged_pictures(pictures, all, rows, goal);
        if (measured.pictures.size() < pictures.size()) say_dropped(pictures, measured.pictures);
        pictures       = measured.pictures;
        measured.tried = tried_on(pictures, all, rows, goal);
        next.clear();
        for (const double share : fit_shares)
            for (Run& run : next_tries(catalogue.techniques, measured.tried, share * budget, goal))
                if (std::ranges::find(next, run.id, &Run::id) == next.end()) next.push_back(std::move(run));
        all.insert(all.end(), next.begin(), next.end());
    }
    return measured;
}

} // namespace

int fit_to_budget(const CommonOptions& common, const FitOptions& options)
{
    const Budget     budget    = budget_of(options);
    const FitGoal    goal      = {options.objective == "flip", budget.unit};
    const Catalogue  catalogue = load_catalogue(common.technique_dirs);
    const Experiment sweep     = load_sweep(common, options, catalogue);
    if (options.leave_one_out && std::ranges::all_of(sweep.scenes, [&](const std::string& scene) {
            return views_of(sweep, scene).size() * sweep.frames.size() < 2 || is_frame(scene);
        }))
        throw_spec_error("--leave-one-out: expected a scene with two or more views");
    std::optional<Gpu> chip;
    if (goal.unit == FitUnit::instructions) chip = open_chip(options.chip);
    require_folder(options);
    const Measured measured = measure(common, options, catalogue, sweep, goal, chip);
    if (measured.is_over) return measured.code;
    const FitReport report{measured.pictures,    measured.tried, sweep.known_settings,
                           catalogue.techniques, goal,           budget.most};
    if (options.leave_one_out) {
        const std::string text = "`" + options.command_line + "`\n\n" + leave_one_out_text(report);
        const fs::path    file = fs::path(options.output) / "leave_one_out.md";
        write_file_atomically(file, text);
        std::fputs(text.c_str(), stdout);
        std::puts(file.string().c_str());
        return measured.code;
    }
    const Fit fit = require_fit(measured.tried, every_picture(report), budget.most, goal);
    print_fit(report, fit);
    std::vector<Run> pictures = measured.pictures;
    for (Run& picture : pictures) // so that choice.toml runs from any folder
        if (find_scene_file(picture.scene) == picture.scene && !picture.scene.empty())
            picture.scene = fs::absolute(picture.scene).lexically_normal().string();
    const fs::path choice = fs::path(options.output) / "choice.toml";
    write_file_atomically(choice, "# " + printable(options.command_line) + "\n" +
                                      experiment_text("fit_choice", pictures, std::span(&fit.best->run, 1),
                                                      sweep.known_settings, catalogue.techniques, ""));
    std::puts(choice.string().c_str());
    return measured.code;
}

} // namespace ssrlab
