#include "app/export_command.h"

#include "check/run_check.h"
#include "core/error.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "core/temporary_folder.h"
#include "export/export.h"
#include "harness/csv.h"
#include "harness/experiment.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <span>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// Hard cases whose rays a port gets wrong first.
constexpr std::array proof_cases = {"axis_aligned", "exact_diagonal", "crossings_of_odd_sizes", "sphere_on_floor",
                                    "orthographic"};

/// Of a drawn scene; a frame file has its own size.
constexpr const char* proof_size = "160x90";

/// The largest image that WebGPU promises, and all that SwiftShader has.
constexpr int webgpu_size_px = 8192;

ExportLanguage language_of(const std::string& name)
{
    static const std::map<std::string, ExportLanguage> languages = {{"glsl", ExportLanguage::glsl},
                                                                    {"hlsl", ExportLanguage::hlsl},
                                                                    {"msl", ExportLanguage::msl},
                                                                    {"essl", ExportLanguage::essl},
                                                                    {"wgsl", ExportLanguage::wgsl}};
    return languages.at(name);
}

/// Every setting of [trace] and every parameter with its value, as -p takes them. Which materials reflect is left to
/// the host.
std::vector<std::pair<std::string, std::string>> chosen_values(const Catalogue& catalogue, const Technique& technique,
                                                               const Choice& choice)
{
    std::vector<std::pair<std::string, std::string>> chosen;
    for (const Setting& setting : all_settings(catalogue))
        if (setting.table == "trace" && !setting.name.starts_with("dielectric_"))
            chosen.emplace_back(setting.name, format_parameter(setting, setting.get(choice.settings)));
    for (const Parameter& parameter : technique.parameters)
        chosen.emplace_back(parameter.name, format_parameter(parameter, choice.values.at(parameter.name)));
    return chosen;
}

/// Throws SpecError for a parameter that is no number of the technique.
std::set<std::string> kept_numbers(const Technique& technique, std::span<const std::string> names)
{
    for (const std::string& name : names) {
        const auto found = std::ranges::find(technique.parameters, name, &Parameter::name);
        if (found == technique.parameters.end() || !found->choices.empty() || name.find('.') != std::string::npos)
            throw_spec_error("--keep {}: expected a number among the parameters of {}", name, technique.id);
    }
    return {names.begin(), names.end()};
}

/// Of the device that exports: what every device can do, by the passes that need no subgroups.
GpuOptions portable(GpuOptions options)
{
    options.storage = TexelStorage::plain_buffers;
    if (options.passes == PassStyle::by_device) options.passes = PassStyle::serial;
    return options;
}

/// The frame under the near and far plane of the export.
ExportFrame on_view(ExportFrame frame, const View& view)
{
    frame.gbuffer.view.near_m = view.near_m;
    frame.gbuffer.view.far_m  = view.far_m;
    return frame;
}

/// Depths that host_depth() must tell apart: in each row a pixel of its own depth in the sky, and rays that meet it if it is
/// taken for a surface. NaN is left to the hard cases: not every compiler keeps it.
ExportFrame depths_of_the_host(const View& view)
{
    constexpr float infinity    = std::numeric_limits<float>::infinity(),
                    before_near = 1 + std::numeric_limits<float>::epsilon();
    constexpr std::array depths{0.0F, -0.25F, -infinity, before_near, 1.25F, 5.0F, infinity, 1.0F, 0.75F};
    const glm::ivec2     size_px(41, static_cast<int>(depths.size()));
    const bool           flat = view.projection == Projection::orthographic;
    const auto           sky  = [](glm::ivec2) { return 0.0; };
    ExportFrame          frame{
        "host_depth", "depths without a surface, and surfaces at the near plane",
        picture_of(flat ? orthographic_view(size_px, 2, view.near_m, view.far_m) : bench_view(size_px, view.near_m),
                   sky)};
    for (int y = 0; y < size_px.y; ++y) {
        const glm::ivec2 pixel(20, y), start(0, y);
        const glm::dvec2 from(0.5, y + 0.5);
        frame.gbuffer.depth[pixel_index(pixel, size_px)] = depths[static_cast<size_t>(y)];
        frame.rays.push_back({{from, 1}, {40, 0, 0}, 1, TraceStatus::left_screen, start});
        frame.rays.push_back({{from, 1}, {40, 0, -0.5}, 1, TraceStatus::left_screen, start}); // at 0.75 in the pixel
        frame.rays.push_back(
            {{from, 0.5}, {20, 0, -0.5}, INFINITY, TraceStatus::past_max_distance, start}); // ends at 0
    }
    return frame;
}

/// A few hard cases with the projection of the view, and the scene.
std::vector<ExportFrame> proof_frames(const GBufferImage& scene, const ExportOptions& options)
{
    std::vector<ExportFrame> frames;
    for (const char* name : proof_cases) {
        const HardCase& hard_case = find_case(name);
        for (Setup& setup : hard_case.setups()) {
            if (setup.gbuffer.view.projection != scene.view.projection || setup.gbuffer.depth.size() > 65536) continue;
            ExportFrame frame{name, fmt::format("hard case: {}", hard_case.breaks), std::move(setup.gbuffer),
                              setup.rays};
            frames.push_back(on_view(std::move(frame), scene.view));
            break;
        }
    }
    frames.push_back(depths_of_the_host(scene.view));
    frames.push_back({"scene", options.picture.scene, scene});
    return frames;
}

constexpr size_t most_listed = 10; // differing rays of a frame

struct DifferenceCounts {
    size_t rays = 0, set_ups = 0, near_ties = 0;
};

DifferenceCounts counts_of(const FrameVerdict& verdict)
{
    DifferenceCounts counts;
    for (const AnswerDifference& difference : verdict.differences) {
        ++(difference.is_set_up ? counts.set_ups : counts.rays);
        if (difference.is_near_tie) ++counts.near_ties;
    }
    return counts;
}

std::string cause_of(const AnswerDifference& difference) { return difference.is_near_tie ? "rounding" : "unexplained"; }

std::string line_of(const AnswerDifference& difference)
{
    const std::string pixel = fmt::format("({}, {})", difference.pixel.x, difference.pixel.y);
    const std::string apart =
        difference.is_near_tie ? fmt::format("{:.2g} px apart: rounding", difference.apart_px) : cause_of(difference);
    if (!difference.is_set_up)
        return fmt::format("ray {} of pixel {}: {}, expected {} ({})", difference.ray, pixel, difference.answered,
                           difference.expected, apart);
    return fmt::format("the ray of pixel {} is set up otherwise: {} {}, expected {} ({})", pixel, difference.values,
                       difference.answered, difference.expected, apart);
}

/// are_ties_right: WGSL has no `precise`, so that its compilers may round otherwise.
int print_verdicts(std::span<const FrameVerdict> verdicts, const std::string& device, bool are_ties_right = false)
{
    size_t rays = 0, differing = 0, near_ties = 0;
    for (const FrameVerdict& verdict : verdicts) {
        const DifferenceCounts counts = counts_of(verdict);
        rays += verdict.rays + verdict.set_up;
        differing += verdict.differences.size();
        near_ties += counts.near_ties;
        std::puts(fmt::format("{}: {} of {} rays differ{}", verdict.frame, counts.rays, verdict.rays,
                              verdict.set_up == 0 ? "" : fmt::format("; {} are set up otherwise", counts.set_ups))
                      .c_str());
        const size_t listed = std::min(most_listed, verdict.differences.size());
        for (const AnswerDifference& difference : std::span(verdict.differences).first(listed))
            std::puts(("  " + line_of(difference)).c_str());
    }
    std::puts(fmt::format("{} of {} answers differ on {}{}", differing, rays, device,
                          differing == 0 ? "" : fmt::format(", {} of them by rounding alone", near_ties))
                  .c_str());
    return differing == (are_ties_right ? near_ties : 0) && rays > 0 ? 0 : 1;
}

/// A setup of a hard case, exported by itself, since each has its own settings.
struct ExportedSetup {
    std::string hard_case, label, surface;
    fs::path    folder;
};

/// WGSL and ESSL have no numbers of 64 bits, MSL no doubles, and spirv-cross writes no vectors of 64-bit integers for HLSL.
bool can_hold(const std::string& language, Gpu gpu, const Technique& technique, const ParameterValues& values)
{
    if (language != "glsl") gpu.info.int64 = false;
    return missing_feature(gpu, technique, values).empty();
}

std::vector<ExportedSetup> export_hard_cases(Gpu& gpu, const Catalogue& catalogue, const Technique& technique,
                                             const Choice& choice, const ExportOptions& options, const fs::path& root)
{
    std::vector<ExportedSetup> exported;
    Translations               translations;
    for (const CaseFamily& family : hard_cases())
        for (const HardCase& hard_case : family.cases) {
            if (!options.only_case.empty() && options.only_case != hard_case.name) continue;
            const ParameterValues values = adjusted(hard_case, technique, choice.values);
            if (!can_hold(options.language, gpu, technique, values)) continue;
            for (Setup& setup : hard_case.setups()) {
                if (std::ranges::count(technique.ignores, "behind") > 0) setup.settings.behind = Behind::hit;
                if (setup.settings.layers > 1) continue; // no export holds them
                const glm::ivec2 size_px = setup.gbuffer.view.size_px;
                if (options.language == "wgsl" && std::max(size_px.x, size_px.y) > webgpu_size_px) continue;
                const Export      what{catalogue, technique, values, setup.settings, language_of(options.language), ""};
                const ExportFrame frame{"case", "", setup.gbuffer, setup.rays};
                exported.push_back(
                    {hard_case.name, setup.label, setup.settings.surface, root / std::to_string(exported.size())});
                write_export(gpu, what, std::span(&frame, 1), translations, exported.back().folder);
            }
        }
    return exported;
}

/// Writes setups.csv, a row for each setup, and differing.csv, a row for each answer that differs.
void write_tables(const fs::path& folder, const Technique& technique, const std::string& language,
                  std::span<const ExportedSetup> exported, const WgslVerdicts& found)
{
    std::string setups  = csv_line({"technique", "language", "device", "case", "setup", "surface", "rays",
                                    "rays_differing", "set_ups", "set_ups_differing", "largest_px", "unexplained"});
    std::string answers = csv_line({"technique", "language", "device", "case", "setup", "surface", "x_px", "y_px",
                                    "ray", "values", "expected", "answered", "apart_px", "cause"});
    for (size_t i = 0; i < exported.size(); ++i) {
        const FrameVerdict&    verdict = found.frames[i];
        const DifferenceCounts counts  = counts_of(verdict);
        const CsvRecord        key{technique.id,          language,          found.device,
                            exported[i].hard_case, exported[i].label, exported[i].surface};
        double                 largest_px = 0;
        for (const AnswerDifference& one : verdict.differences) {
            largest_px    = std::max(largest_px, one.apart_px);
            CsvRecord row = key;
            for (const std::string& text :
                 {std::to_string(one.pixel.x), std::to_string(one.pixel.y),
                  one.is_set_up ? "set-up" : std::to_string(one.ray), one.values, one.expected, one.answered,
                  fmt::format("{:.3g}", one.apart_px), cause_of(one)})
                row.push_back(text);
            answers += csv_line(row);
        }
        CsvRecord row = key;
        for (const size_t count : {verdict.rays, counts.rays, verdict.set_up, counts.set_ups})
            row.push_back(std::to_string(count));
        row.push_back(fmt::format("{:.3g}", largest_px));
        row.push_back(std::to_string(verdict.differences.size() - counts.near_ties));
        setups += csv_line(row);
    }
    fs::create_directories(folder);
    write_file_atomically(folder / "setups.csv", setups);
    write_file_atomically(folder / "differing.csv", answers);
}

int verify_hard_cases(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const Choice& choice,
                      const ExportOptions& options)
{
    const TemporaryFolder temporary("ssrlab_hard_cases");
    const auto            exported = export_hard_cases(gpu, catalogue, technique, choice, options, temporary.path);
    std::vector<fs::path> folders;
    for (const ExportedSetup& one : exported) folders.push_back(one.folder);
    const bool   is_wgsl = options.language == "wgsl";
    WgslVerdicts found{.frames = {}, .device = gpu.info.name};
    if (is_wgsl)
        found = verify_wgsl_exports(folders);
    else
        for (const fs::path& folder : folders) found.frames.push_back(verify_export(gpu, folder).front());
    for (size_t i = 0; i < exported.size(); ++i)
        found.frames[i].frame =
            exported[i].hard_case + (exported[i].label.empty() ? "" : fmt::format(" ({})", exported[i].label));
    if (!options.picture.output.empty())
        write_tables(options.picture.output, technique, options.language, exported, found);
    return print_verdicts(found.frames, found.device, is_wgsl);
}

} // namespace

int export_technique(const CommonOptions& common, const ExportOptions& options, const std::string& command_line)
{
    if (!options.verified.empty()) {
        if (!options.picture.technique.empty() || !options.picture.output.empty())
            throw_spec_error("--verify runs a folder that was exported: give no technique and no -o");
        if (is_wgsl_export(options.verified)) {
            const fs::path     folder = options.verified;
            const WgslVerdicts found  = verify_wgsl_exports(std::span(&folder, 1));
            return print_verdicts(found.frames, found.device, true);
        }
        Gpu gpu = open_gpu(common.gpu);
        return print_verdicts(verify_export(gpu, options.verified), gpu.info.name);
    }
    if (options.picture.technique.empty())
        throw_spec_error("export: expected a technique (see ssrlab list) or --verify");
    if (options.language.empty()) throw_spec_error("--to: expected glsl, hlsl, msl, essl or wgsl");
    if (options.picture.output.empty() && !options.hard_cases)
        throw_spec_error("-o: expected a folder to write, or --hard-cases");
    const Catalogue  catalogue = load_catalogue(common.technique_dirs);
    const Technique& technique = find_technique(catalogue.techniques, options.picture.technique);
    const Choice     choice    = parse_choice(catalogue, technique, options.picture.parameters);
    CommonOptions    device    = common;
    device.gpu                 = portable(common.gpu);
    if (options.hard_cases) {
        if (options.language == "msl" || options.language == "essl")
            throw_spec_error("--hard-cases: expected --to glsl, hlsl or wgsl, which are run here");
        if (!options.only_case.empty()) find_case(options.only_case);
        Gpu gpu                = open_gpu(device.gpu);
        gpu.info.cheap_doubles = false; // rays are set up by floats, as on every device
        return verify_hard_cases(gpu, catalogue, technique, choice, options);
    }
    PictureOptions picture = options.picture;
    if (picture.size.empty() && !is_frame(picture.scene)) picture.size = proof_size;
    Stage stage = open_stage(device, catalogue, picture);
    if (!can_hold(options.language, stage.gpu, technique, choice.values))
        throw_spec_error(
            "--to {}: expected values of {} without 64-bit integers and doubles, which only GLSL can be given",
            options.language, technique.id);
    stage.gpu.info.cheap_doubles = false;
    GBufferImage scene           = read_gbuffer(stage.gpu, *stage.gbuffer);
    if (options.near_m > 0) scene.view.near_m = options.near_m;
    const Export what{catalogue,
                      technique,
                      choice.values,
                      choice.settings.trace,
                      language_of(options.language),
                      command_line,
                      chosen_values(catalogue, technique, choice),
                      kept_numbers(technique, options.kept)};
    Translations translations;
    write_export(stage.gpu, what, proof_frames(scene, options), translations, options.picture.output);
    std::puts(fmt::format("wrote {0}; ssrlab export --verify {0} runs it", options.picture.output).c_str());
    return 0;
}

} // namespace ssrlab
