// The command line: names and help here, the work in commands.cpp and harness/.
#include "app/cases.h"
#include "app/check_command.h"
#include "app/commands.h"
#include "app/export_command.h"
#include "app/fit_command.h"
#include "app/judge_command.h"
#include "app/new_technique.h"
#include "app/plan_command.h"
#include "app/ray_command.h"
#include "app/render_command.h"
#include "app/shaders_command.h"
#include "app/sources_command.h"
#include "core/error.h"
#include "core/names.h"
#include "core/printable.h"
#include "core/version.h"
#include "harness/merge_results.h"
#include "harness/run_experiment.h"
#include "viewer/viewer.h"

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <fcntl.h>
#include <functional>
#include <limits>
#include <unistd.h>

namespace {

/// A file opened later would get the number of a stream that is closed, and with it whatever is printed.
void open_closed_streams()
{
    for (int fd = ::open("/dev/null", O_RDWR); fd >= 0; fd = ::open("/dev/null", O_RDWR)) {
        if (fd <= 2) continue;
        ::close(fd);
        return;
    }
}

/// Refuses a word that is none of these, and says which is near.
CLI::Validator one_of(const std::vector<std::string>& names)
{
    return {[names](const std::string& word) {
                const bool known = std::ranges::find(names, word) != names.end();
                return known ? std::string() : ssrlab::unknown_name("value", word, names);
            },
            fmt::format("{{{}}}", fmt::join(names, ","))};
}

void append_options(std::vector<std::string>& names, const CLI::App& app)
{
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
}

/// What is wrong with the first word that is no option, if it is no command; or else with the first option that the command lacks.
std::string unknown_word(const CLI::App& app, int argc, char** argv)
{
    std::vector<std::string> known, options;
    for (const CLI::App* command : app.get_subcommands(nullptr)) known.push_back(command->get_name());
    const CLI::App* command = nullptr;
    for (int i = 1; command == nullptr && i < argc; ++i) {
        const std::string word = argv[i];
        if (word.starts_with("-")) {
            const CLI::Option* option = app.get_option_no_throw(word);
            if (option != nullptr && option->get_items_expected_max() > 0) ++i; // its value
            continue;
        }
        if (std::ranges::find(known, word) == known.end()) return ssrlab::unknown_name("command", word, known);
        command = app.get_subcommand(word);
    }
    append_options(options, app);
    if (command != nullptr) append_options(options, *command);
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i], name = word.substr(0, word.find('='));
        if (name.starts_with("--") && name != "--" && std::ranges::find(options, name) == options.end())
            return ssrlab::unknown_name(command == nullptr ? "option" : "option of " + command->get_name(), name,
                                        options);
    }
    return "";
}

/// What an option's number has to be, said as -p says it: "expected a number above 0, got '0.1m'".
template <typename Number> CLI::Validator within(const std::string& expected, Number min, Number max)
{
    return {[=](const std::string& text) {
                Number      value = 0;
                const char *begin = text.data() + (text.starts_with('+') ? 1 : 0), *end = text.data() + text.size();
                const auto  parsed = std::from_chars(begin, end, value);
                const bool  right  = parsed.ec == std::errc() && parsed.ptr == end && value >= min && value <= max;
                return right ? "" : fmt::format("expected {}, got '{}'", expected, text);
            },
            ""};
}

constexpr double largest = std::numeric_limits<double>::max();

CLI::Validator any_number() { return within("a number", -largest, largest); }

CLI::Validator number_above_0()
{
    return within("a number above 0", std::numeric_limits<double>::denorm_min(), largest);
}

CLI::Validator number_in(double min, double max)
{
    return within(fmt::format("a number in [{}, {}]", min, max), min, max);
}

CLI::Validator integer_in(int min, int max)
{
    return within(fmt::format("an integer in [{}, {}]", min, max), min, max);
}

void add_frame_options(CLI::App& command, ssrlab::PictureOptions& options)
{
    command.add_option("--frame", options.at.frame, "Frame of the scene's motion and of a camera path")
        ->capture_default_str()
        ->check(integer_in(0, ssrlab::max_frames));
    command
        .add_option("--jitter", options.at.jitter_phases,
                    "Sub-pixel offsets of the camera that repeat after this many frames; 0: none")
        ->capture_default_str()
        ->check(integer_in(0, ssrlab::max_jitter_phases));
}

/// Which picture of which scene.
void add_scene_options(CLI::App& command, ssrlab::PictureOptions& options)
{
    command
        .add_option("SCENE", options.scene,
                    "A .glb or .gltf file, a scene recipe, builtin:NAME (see ssrlab list), or a frame of another "
                    "renderer (.exr)")
        ->required();
    command.add_option("--size", options.size, "WIDTHxHEIGHT in pixels; default: the view's own");
    command.add_option("--view", options.view, "Name of a view or camera path of the scene")->capture_default_str();
    add_frame_options(command, options);
}

void add_parameter_option(CLI::App& command, ssrlab::PictureOptions& options)
{
    command
        .add_option("-p,--parameter", options.parameters,
                    "name=value: a parameter of the technique (see ssrlab show), or a setting such as thickness_m")
        ->allow_extra_args(false);
}

CLI::Option* add_technique_option(CLI::App& command, ssrlab::PictureOptions& options)
{
    add_parameter_option(command, options);
    return command.add_option("-t,--technique", options.technique,
                              "Technique (see ssrlab list), or exact: the fastest exact one on this device");
}

void add_output_option(CLI::App& command, ssrlab::PictureOptions& options)
{
    command.add_option("-o,--output", options.output, "File to write")->required();
}

void add_presentation_options(CLI::App& command, ssrlab::RenderOptions& options)
{
    command.add_option("--frames", options.frames, "Write this many numbered pictures, beginning with this frame")
        ->check(integer_in(1, ssrlab::max_frames));
    command
        .add_option("--samples", options.samples,
                    "Anti-aliasing: the mean of this many camera positions within a pixel")
        ->capture_default_str()
        ->check(integer_in(1, ssrlab::max_samples));
    command.add_option("--exposure", options.exposure_ev, "Exposure of a .png, in stops")
        ->capture_default_str()
        ->check(any_number());
    command
        .add_option("--display", options.display,
                    "Tone curve of a .png: clip (at 1), or agx, which keeps bright colours")
        ->capture_default_str()
        ->check(one_of({"clip", "agx"}));
    command
        .add_option("--show", options.show,
                    "False colours instead of the picture (docs/how-to/read_the_report.md): agreement (right and wrong "
                    "rays), causes (why rays are wrong), fetches (work per ray), sources (which source answered)")
        ->check(one_of({"agreement", "causes", "fetches", "sources"}));
    command.add_option("--sources", options.sources,
                       "Sources that answer the rays, in this order: frame,world (ssrlab sources); without: the frame");
    command.add_flag("--errors", options.errors, "Print the errors of the picture against the true reflection");
    auto* truth = command.add_flag("--truth", options.truth, "The true reflection instead of the traced one");
    command
        .add_flag("--side-by-side", options.side_by_side,
                  "Three labelled pictures in one: without reflections, traced, true")
        ->excludes(truth);
}

void add_judge_options(CLI::App& command, ssrlab::JudgeOptions& options)
{
    command.add_option("FRAME", options.frame, "Frame file (.exr), or the folder that export-cases wrote")->required();
    command
        .add_option("HITS", options.hits,
                    "Hits of that frame (.exr; docs/reference/hit_files.md), or a folder with NAME.exr for each case")
        ->required();
    command.add_option("--scene", options.scene, "Scene of the frame: also judge by its triangles");
    command.add_option("--frame", options.at_frame, "Frame of that scene's motion")
        ->capture_default_str()
        ->check(integer_in(0, ssrlab::max_frames));
    command
        .add_option("-p,--parameter", options.parameters,
                    "name=value: a setting of [trace] under which the renderer traced, such as thickness_m")
        ->allow_extra_args(false);
    command.add_option("-o,--output", options.output, "Also write a picture in false colours (.png)");
    command.add_option("--show", options.show, "What it shows: agreement, or causes (needs --scene)")
        ->capture_default_str()
        ->check(one_of({"agreement", "causes"}));
    command.add_option("--min-f1", options.min_f1, "Exit code 1 if F1 is lower; with --scene that of the scene truth")
        ->check(number_in(0, 1));
    command.add_flag("--partial", options.partial,
                     "Of a folder: judge the cases that have hits, and pass without the others");
    command.add_flag("--json", options.json, "As JSON, with every wrong ray");
}

void add_chip_option(CLI::App& command, std::string& chip, const char* meaning)
{
    command.add_option("--chip", chip, fmt::format("{}: {}", meaning, fmt::join(ssrlab::known_chips(), ", ")));
}

void add_fit_options(CLI::App& command, ssrlab::FitOptions& options)
{
    command.add_option("SCENE", options.scenes, "Scenes as for render, and frames of other renderers (.exr)")
        ->required();
    command
        .add_option("--budget-ms", options.budget_ms,
                    "Milliseconds of this device: structures and trace; with --objective flip all passes after the "
                    "G-buffer")
        ->check(number_above_0());
    command
        .add_option("--budget-fetches", options.budget_fetches,
                    "Reads of depth and structures per ray: exact, and the same on every device")
        ->check(number_above_0());
    command
        .add_option("--budget-instructions", options.budget_instructions,
                    "Instructions of a chip per ray: structures and trace, as its compiler makes them")
        ->check(number_above_0());
    add_chip_option(command, options.chip, "The AMD GPU of --budget-instructions, which need not be there");
    command
        .add_option("--objective", options.objective,
                    "f1: of the rays, against the scene truth; flip: of the picture, against the true reflection")
        ->capture_default_str()
        ->check(one_of({"f1", "flip"}));
    command.add_option("--view", options.views, "Views or camera paths; default: all views of each scene")
        ->allow_extra_args(false);
    command.add_option("--frame", options.frames, "Frames of the scenes' motion and of camera paths")
        ->capture_default_str()
        ->allow_extra_args(false)
        ->check(integer_in(0, ssrlab::max_frames));
    command.add_option("--size", options.size, "WIDTHxHEIGHT in pixels; default: that of the sweep");
    command.add_option("-t,--technique", options.techniques, "Only these techniques of the sweep")
        ->allow_extra_args(false);
    command.add_option("-p,--parameter", options.parameters, "name=value: not swept, but as given")
        ->allow_extra_args(false);
    command.add_option("--sweep", options.sweep,
                       "Experiment whose techniques and settings are tried; default: experiments/fit_f1.toml or "
                       "fit_flip.toml");
    command.add_flag("--leave-one-out", options.leave_one_out,
                     "Instead: fit to all views of a scene but one, and say what that loses on the one");
    command.add_option("-o,--output", options.output, "Folder to write: new or empty")->capture_default_str();
    command.add_flag("--resume", options.resume, "Continue in a folder that was begun");
}

void add_bandwidth_option(CLI::App& command, double& bandwidth_gbps)
{
    command
        .add_option("--bandwidth-gbps", bandwidth_gbps,
                    "Memory bandwidth of a card: also print the time that the bytes of each pass need at the least")
        ->check(number_above_0());
}

/// One line in a terminal, whatever a file holds.
void say_error(const std::string& what) { std::fprintf(stderr, "ssrlab: %s\n", ssrlab::printable(what).c_str()); }

} // namespace

int main(int argc, char** argv)
{
    using namespace ssrlab;
    open_closed_streams();
    CLI::App app(
        "ssrlab: what does each bit of accuracy of a screen-space reflection tracer cost in time, on your scene?",
        "ssrlab");
    CommonOptions  common;
    PictureOptions picture;
    RunOptions     run;
    std::string    technique, results;
    app.require_subcommand(1);
    app.fallthrough();
    app.set_version_flag("--version", version_text());
    app.add_option("--device", common.gpu.device,
                   "Vulkan device by index or part of its name; default: a discrete GPU if present, else the first");
    app.add_option("--techniques", common.technique_dirs,
                   "A further folder of techniques, structures, reprojections and surface models, or of such folders; "
                   "may be repeated (also $SSRLAB_TECHNIQUES)")
        ->allow_extra_args(false);
    app.add_option(
           "--storage", common.gpu.storage,
           "How shaders read lists and depth: texel-buffers or plain-buffers; default: by the limits of the device")
        ->transform(CLI::Transformer(std::map<std::string, TexelStorage>{
            {"texel-buffers", TexelStorage::texel_buffers}, {"plain-buffers", TexelStorage::plain_buffers}}))
        ->transform(one_of({"texel-buffers", "plain-buffers"})) // the last one is asked first
        ->option_text("texel-buffers|plain-buffers");
    app.add_option("--passes", common.gpu.passes,
                   "How the passes before the trace share work: serial (an invocation per tile or ray group) or "
                   "parallel (one per pixel, several per ray group); default: serial on a CPU, parallel on a GPU")
        ->transform(CLI::Transformer(
            std::map<std::string, PassStyle>{{"serial", PassStyle::serial}, {"parallel", PassStyle::parallel}}))
        ->transform(one_of({"serial", "parallel"}))
        ->option_text("serial|parallel");
    app.add_flag("--validation", common.gpu.validation,
                 "Load the Khronos validation layer; any message fails the command");

    app.add_flag("--quiet", common.quiet, "Print no warnings and no progress, only errors");

    std::function<int()> command;
    bool                 json = false;
    auto* list = app.add_subcommand("list", "List techniques, surface models, scenes, settings and devices");
    list->add_flag("--json", json, "As JSON, with everything that show prints");
    bool markdown = false;
    list->add_flag("--markdown", markdown, "Settings and parameters alone, as Markdown tables");
    list->callback(
        [&] { command = [&] { return markdown ? list_as_markdown(common) : list_everything(common, json); }; });
    auto* show = app.add_subcommand("show", "Describe a technique, a surface model or a setting");
    show->add_option("TECHNIQUE|SURFACE|SETTING", technique)->required();
    show->add_flag("--json", json, "As JSON");
    show->callback([&] { command = [&] { return show_entry(common, technique, json); }; });
    RenderOptions rendered;
    auto*         render = app.add_subcommand("render", "Render a picture with reflections (.png or .exr)");
    add_scene_options(*render, rendered.picture);
    add_technique_option(*render, rendered.picture)->default_val(fastest_exact)->capture_default_str();
    add_output_option(*render, rendered.picture);
    add_presentation_options(*render, rendered);
    render->callback([&] { command = [&] { return render_picture(common, rendered); }; });
    auto* trace = app.add_subcommand(
        "trace", "Write what each ray found and why it stopped (.exr), of a frame or of each of a folder's cases");
    add_scene_options(*trace, picture);
    add_technique_option(*trace, picture)->required();
    add_output_option(*trace, picture);
    trace->callback([&] { command = [&] { return trace_hits(common, picture); }; });
    auto* gbuffer = app.add_subcommand("gbuffer", "Write what the camera sees (.exr)");
    add_scene_options(*gbuffer, picture);
    add_output_option(*gbuffer, picture);
    gbuffer->callback([&] { command = [&] { return write_gbuffer(common, picture); }; });

    RayOptions ray;
    auto*      explained = app.add_subcommand(
             "ray", "Explain one ray: what each technique read, where and why it stopped, and where it should have");
    add_scene_options(*explained, ray.picture);
    explained->add_option("--pixel", ray.pixel, "X,Y of the pixel that reflects, from the top left")->required();
    explained
        ->add_option("-t,--technique", ray.techniques, "Technique, or exact, as for render; several may be compared")
        ->required()
        ->allow_extra_args(false);
    explained
        ->add_option("-p,--parameter", ray.picture.parameters,
                     "name=value, as for render; for every technique that has it")
        ->allow_extra_args(false);
    explained->add_option(
        "--sources", ray.sources,
        "Also say which source of this list answers the ray, as frame,world (docs/explanation/beyond.md)");
    explained->add_option("-o,--output", ray.picture.output, "Also write a picture (.png) or all numbers (.json)");
    explained->add_flag("--json", ray.json, "Print all numbers as JSON instead of the table");
    explained->callback([&] { command = [&] { return explain_ray(common, ray); }; });

    JudgeOptions judged;
    auto*        judge = app.add_subcommand(
               "judge", "Judge the hits of any renderer by the hit contract and the truths (docs/how-to/judge_a_renderer.md)");
    add_judge_options(*judge, judged);
    judge->callback([&] { command = [&] { return judge_hits(common, judged); }; });

    FitOptions fit;
    auto*      fitted = app.add_subcommand(
             "fit", "Find the setting that is best within a budget on your scenes (docs/how-to/fit_to_a_budget.md)");
    add_fit_options(*fitted, fit);
    fitted->callback([&] {
        command = [&] {
            fit.command_line = fmt::format("ssrlab {}", fmt::join(argv + 1, argv + argc, " "));
            return fit_to_budget(common, fit);
        };
    });

    auto* cases = app.add_subcommand("export-cases",
                                     "Write the hard cases as frame files with their right answers, for any renderer");
    cases->add_option("FOLDER", results, "Folder to write: new or empty")->required();
    cases->callback([&] { command = [&] { return export_cases(common, results); }; });

    ViewOptions view;
    auto* viewed = app.add_subcommand("view", "Open a window in which camera, technique and settings change live");
    add_scene_options(*viewed, view.picture);
    add_technique_option(*viewed, view.picture)->default_val("hiz")->capture_default_str();
    viewed->add_option("--script", view.script,
                       "File of commands instead of mouse and keyboard (docs/how-to/viewer.md)");
    viewed->callback([&] { command = [&] { return view_scene(common, view); }; });

    PlanOptions plan;
    auto* planned = app.add_subcommand("plan", "Show which passes a frame needs, why, and what they cost or save");
    add_scene_options(*planned, plan.picture);
    add_technique_option(*planned, plan.picture)->default_val("hiz")->capture_default_str();
    planned->add_option("--repeats", plan.repeats, "Timed frames")
        ->capture_default_str()
        ->check(integer_in(1, std::numeric_limits<int>::max()));
    add_bandwidth_option(*planned, plan.bandwidth_gbps);
    planned->callback([&] { command = [&] { return print_plan(common, plan); }; });

    SourcesOptions sources;
    auto* asked = app.add_subcommand("sources", "Measure which source answers each ray, how rightly and at what price");
    add_scene_options(*asked, sources.picture);
    add_technique_option(*asked, sources.picture)->default_val("hiz")->capture_default_str();
    asked
        ->add_option("--sources", sources.lists,
                     "Sources in the order in which they are asked, as frame,layers:count=2,world; several lists may "
                     "be compared")
        ->default_val(std::vector<std::string>{"frame,world", "world"})
        ->allow_extra_args(false);
    asked
        ->add_option(
            "--hand-on", sources.hand_on,
            "Which rays the next source gets: lost (no answer) or uncertain (those that no source vouches for, too)")
        ->capture_default_str();
    asked->add_option("-o,--output", sources.picture.output, "Append a row for each source of each list to this .csv");
    asked->callback([&] { command = [&] { return compare_sources(common, sources); }; });

    auto* sweep =
        app.add_subcommand("run", "Run an experiment: every combination of its lists becomes a row of results.csv");
    sweep->add_option("SPEC", run.specification, "Experiment (.toml; see docs/how-to/experiments.md)")->required();
    sweep->add_option("-o,--output", run.folder, "Results folder; default: results/NAME");
    sweep->add_flag(
        "--resume", run.resume,
        "Do the runs that are missing or failed; refused if specification, shaders, scenes or device changed");
    sweep->add_option("--only", run.only, "Only the run with this id (first column of results.csv)");
    sweep->add_option("--shard", run.shard,
                      "I/N: the I-th of N parts, cut between frames, for N machines or processes; see ssrlab merge");
    sweep->add_flag("--dry-run", run.dry_run, "List the runs and the estimated time; write nothing");
    sweep->add_flag("--yes", run.yes, "Allow more than 100,000 runs");
    sweep->callback([&] {
        command = [&] {
            run.techniques   = common.technique_dirs;
            run.quiet        = common.quiet;
            run.gpu          = common.gpu;
            run.command_line = fmt::format("{}", fmt::join(argv, argv + argc, " "));
            return run_experiment(run);
        };
    });
    std::filesystem::path              merged;
    std::vector<std::filesystem::path> parts;
    auto* merge = app.add_subcommand("merge", "Merge the parts that run --shard wrote into one results folder");
    merge->add_option("-o,--output", merged, "Folder to write")->required();
    merge->add_option("DIR", parts, "Results folders of one experiment")->required();
    merge->callback([&] { command = [&] { return merge_results(merged, parts); }; });
    auto* plot = app.add_subcommand("plot", "Write plots, summary and report of a results folder");
    plot->add_option("DIR", results, "Results folder")->required();
    double bandwidth_gbps = 0;
    add_bandwidth_option(*plot, bandwidth_gbps);
    plot->callback([&] { command = [&] { return plot_results(results, bandwidth_gbps); }; });
    app.add_subcommand("measures", "Print what every column of results.csv means (docs/reference/columns.md)")
        ->callback([&] { command = [&] { return print_measures(common); }; });

    ShadersOptions shaders;
    auto*          compiled = app.add_subcommand(
                 "shaders",
                 "Show what a GPU's compiler makes of each pass: registers, code, the innermost loop (docs/how-to/devices.md)");
    compiled->add_option("TECHNIQUE", shaders.techniques, "Techniques; default: all");
    add_chip_option(*compiled, shaders.chip,
                    "Compile for this AMD GPU without having it; default: for the present device");
    compiled
        ->add_option("-p,--parameter", shaders.parameters, "name=value, as for render; for every technique that has it")
        ->allow_extra_args(false);
    compiled->add_option("--assembly", shaders.assembly, "Also write the assembly of each pass into this folder");
    compiled->add_flag("--files", shaders.files,
                       "Instead: the files that the compiler reads of each technique, and their lines of code");
    add_bandwidth_option(*compiled, shaders.bandwidth_gbps);
    compiled->add_flag("--json", shaders.json, "As JSON, with all that the driver says");
    compiled->callback([&] { command = [&] { return describe_shaders(common, shaders); }; });

    ExportOptions exported;
    auto*         taken = app.add_subcommand(
                "export",
                "Write a technique as shaders for an engine, with frames that prove them (docs/how-to/export_a_tracer.md)");
    taken->add_option("TECHNIQUE", exported.picture.technique, "Technique (see ssrlab list)");
    add_parameter_option(*taken, exported.picture);
    taken->add_option("--to", exported.language, "Shading language")
        ->check(one_of({"glsl", "hlsl", "msl", "essl", "wgsl"}));
    taken->add_option("-o,--output", exported.picture.output, "Folder to write: new or empty");
    taken
        ->add_option("--scene", exported.picture.scene,
                     "Scene or frame file of the proof; its view decides projection, near and far plane")
        ->default_val("builtin:corridor")
        ->capture_default_str();
    taken->add_option("--view", exported.picture.view, "View of that scene")->capture_default_str();
    taken->add_option("--size", exported.picture.size, "Size of its image; default: 160x90, or that of a frame file");
    taken->add_option("--near", exported.near_m, "Near plane in metres; default: that of the view")
        ->check(number_above_0());
    taken
        ->add_option("--keep", exported.kept,
                     "A parameter that stays a specialization constant (WGSL: override), instead of its value; may be "
                     "repeated")
        ->allow_extra_args(false);
    taken->add_option("--verify", exported.verified,
                      "Run the shaders of a folder that was exported, and compare every ray");
    auto* hard =
        taken->add_flag("--hard-cases", exported.hard_cases,
                        "Export every hard case, run it and compare; -o is the folder for tables of what differs");
    taken->add_option("--case", exported.only_case, "Only this case")->needs(hard);
    taken->callback([&] {
        command = [&] {
            return export_technique(common, exported, fmt::format("ssrlab {}", fmt::join(argv + 1, argv + argc, " ")));
        };
    });

    auto* begin = app.add_subcommand("new-technique", "Write a folder to begin with: a tracer that passes check");
    begin->add_option("FOLDER", results, "Its name becomes the technique's id")->required();
    begin->callback([&] { command = [&] { return write_new_technique(results); }; });

    HardCaseOptions hard_cases;
    auto*           check = app.add_subcommand(
                  "check",
                  "Run techniques against the hard cases (docs/explanation/hard_cases.md); fails if one breaks what it claims");
    check->add_option("TECHNIQUE|DIR", hard_cases.subject, "A technique, or a folder of techniques; default: all");
    check
        ->add_option("-p,--parameter", hard_cases.parameters,
                     "name=value of the techniques, instead of the default (see ssrlab show)")
        ->allow_extra_args(false);
    check->add_option("--case", hard_cases.only_case, "Only this case");
    check->add_option("--ray", hard_cases.ray, "SETUP:RAY of the case: show its path, pixel by pixel");
    check->add_option("--markdown", hard_cases.markdown, "Write the table to this file");
    check->add_flag("--quick", hard_cases.quick, "Leave out double precision and robust buffer access");
    check->add_flag("--stability", hard_cases.stability, "Also measure sub-pixel jitter and depth formats");
    check->callback([&] {
        command = [&] {
            hard_cases.command_line = fmt::format("ssrlab {}", fmt::join(argv + 1, argv + argc, " "));
            return check_techniques(common, hard_cases);
        };
    });

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (const std::string wrong = unknown_word(app, argc, argv); !wrong.empty() && error.get_exit_code() != 0) {
            say_error(wrong);
            return 2;
        }
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return command();
    } catch (const SpecError& error) {
        say_error(error.what());
        return 2;
    } catch (const std::exception& error) {
        say_error(error.what());
        return 1;
    }
}
