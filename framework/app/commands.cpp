#include "app/commands.h"

#include "app/python_script.h"
#include "app/stage.h"
#include "compare/image_io.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/files.h"
#include "harness/measured_run.h"

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

PreparedFramePtr prepare(const CommonOptions& common, const PictureOptions& options, Stage& stage)
{
    const auto       techniques = list_techniques(common.technique_dirs);
    const Technique& technique  = find_technique(techniques, options.technique);
    const Choice     choice     = parse_choice(technique, options.parameters);
    return prepare_frame(stage.gpu, make_frame_buffers(stage.gpu, stage.gbuffer), technique, choice.values,
                         choice.settings);
}

/// Fails before the work starts rather than after it.
void check_choice(const CommonOptions& common, const PictureOptions& options)
{
    const auto techniques = list_techniques(common.technique_dirs);
    parse_choice(find_technique(techniques, options.technique), options.parameters);
    if (!options.size.empty()) size_option(options.size);
}

double most_steps_of(const CommonOptions& common, const PictureOptions& options)
{
    const auto       techniques = list_techniques(common.technique_dirs);
    const Technique& technique  = find_technique(techniques, options.technique);
    return declared_steps(technique, parse_choice(technique, options.parameters).values);
}

/// "pan.png" is "pan_0007.png" in frame 7.
std::string numbered(const std::string& output, int frame)
{
    const std::filesystem::path path(output);
    return (path.parent_path() / fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()))
        .string();
}

std::string status_legend()
{
    std::string text;
    for (size_t i = 0; i < trace_status_names.size(); ++i)
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", i, trace_status_names[i]);
    return text;
}

/// The command that makes the same picture, but for the output.
std::string command_of(const PictureOptions& options, int at_frame)
{
    std::string text = "ssrlab render " + options.scene + " --view " + options.view;
    if (at_frame > 0) text += fmt::format(" --frame {}", at_frame);
    if (options.at.jitter_phases > 0) text += fmt::format(" --jitter {}", options.at.jitter_phases);
    if (!options.size.empty()) text += " --size " + options.size;
    text += " -t " + options.technique;
    for (const std::string& pair : options.parameters) text += " -p " + pair;
    return text;
}

void warn_without_reflections(const CommonOptions& common, const PreparedFrame& frame)
{
    if (common.quiet || reflecting_pixels_of(frame) > 0) return;
    std::fputs("warning: nothing reflects: no pixel of this frame has a metallic value above 0\n", stderr);
}

} // namespace

int render_picture(const CommonOptions& common, const PictureOptions& options)
{
    check_choice(common, options);
    require_ending(options.output, {".png", ".exr"});
    Stage stage = prepare_stage(common, options);
    for (int i = 0; i < std::max(options.frames, 1); ++i) {
        if (i > 0) show_frame(stage, options.view, {options.at.frame + i, options.at.jitter_phases});
        const auto frame = prepare(common, options, stage);
        run_frame(stage.gpu, *frame);
        const FrameTimes  times = run_frame(stage.gpu, *frame);
        const std::string file  = options.frames > 0 ? numbered(options.output, options.at.frame + i) : options.output;
        Image             image = read_shaded(stage.gpu, *frame);
        image.metadata["ssrlab:version"] = SSRLAB_VERSION; // without the commit: the same picture gives the same file
        image.metadata["ssrlab:command"] = command_of(options, options.at.frame + i);
        write_image(file, image);
        warn_without_reflections(common, *frame);
        std::puts(fmt::format("{}: {}x{}, trace {:.2f} ms on {}", file, stage.view.size_px.x, stage.view.size_px.y,
                              times.of("trace"), stage.gpu.info.name)
                      .c_str());
    }
    return report_messages(stage);
}

int trace_hits(const CommonOptions& common, const PictureOptions& options)
{
    check_choice(common, options);
    require_ending(options.output, {".exr"});
    Stage             stage  = prepare_stage(common, options);
    const auto        frame  = prepare(common, options, stage);
    const TraceResult result = count_frame(stage.gpu, *frame);
    Image             image{result.size_px,
                {"hit.x", "hit.y", "hit.t", "hit.z", "pixel.x", "pixel.y", "status", "steps", "depth_fetches",
                             "structure_fetches"},
                {},
                {}};
    image.metadata["ssrlab:status_names"] = status_legend();
    image.metadata["ssrlab:technique"]    = options.technique;
    image.metadata["ssrlab:parameters"]   = fmt::format("{}", fmt::join(options.parameters, " "));
    for (size_t i = 0; i < result.status.size(); ++i) {
        const bool hit = result.status[i] == TraceStatus::hit;
        // A miss has no hit point: zeros, and the status says so.
        const glm::dvec3 point = hit ? result.hit_px_depth[i] : glm::dvec3(0);
        const glm::dvec2 pixel = hit ? glm::dvec2(result.hit_pixel[i]) : glm::dvec2(0);
        for (const double value :
             {point.x, point.y, hit ? result.hit_t[i] : 0.0, point.z, pixel.x, pixel.y,
              static_cast<double>(result.status[i]), static_cast<double>(result.steps[i]),
              static_cast<double>(result.depth_fetches[i]), static_cast<double>(structure_fetches_of(result, i))})
            image.values.push_back(static_cast<float>(value));
    }
    write_image(options.output, image);
    std::puts(options.output.c_str());
    require_possible(result, most_steps_of(common, options));
    return report_messages(stage);
}

int write_gbuffer(const CommonOptions& common, const PictureOptions& options)
{
    if (!options.size.empty()) size_option(options.size);
    require_ending(options.output, {".exr"});
    Stage stage = prepare_stage(common, options);
    write_image(options.output, frame_image(read_gbuffer(stage.gpu, *stage.gbuffer)));
    std::puts(options.output.c_str());
    return report_messages(stage);
}

int plot_results(const std::string& folder)
{
    const std::filesystem::path table = std::filesystem::path(folder) / "results.csv";
    if (!std::filesystem::exists(table)) throw_spec_error("{}: no such file; ssrlab run writes it", table.string());
    run_python("experiments/plot.py", {folder});
    return 0;
}

} // namespace ssrlab
