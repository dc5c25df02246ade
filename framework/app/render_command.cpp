#include "app/render_command.h"

#include "compare/image_io.h"
#include "compare/pictures.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "harness/choose_sources.h"
#include "harness/choose_technique.h"
#include "harness/no_hits.h"
#include "harness/quality.h"
#include "sources/answered_frame.h"
#include "truth/glossy_truth.h"
#include "truth/scene_truth.h"
#include "truth/screen_truth.h"
#include "truth/truth_cache.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace ssrlab {
namespace {

constexpr double most_stops = 32;

enum class Shows { nothing, traced, truth }; // what stands in the reflections' place

std::vector<Shows> shown_by(const RenderOptions& options)
{
    if (options.side_by_side) return {Shows::nothing, Shows::traced, Shows::truth};
    return {options.truth ? Shows::truth : Shows::traced};
}

std::string label_of(Shows shows, const std::string& technique)
{
    if (shows == Shows::nothing) return "no reflections";
    return shows == Shows::traced ? "SSR: " + technique : "true reflection";
}

/// Fails before the work starts rather than after it.
std::vector<AskedTechnique> checked_techniques(const Catalogue& catalogue, const RenderOptions& options)
{
    const bool exr = options.picture.output.ends_with(".exr");
    require_output(options.picture.output, {".png", ".exr"});
    if (!options.picture.size.empty()) size_option(options.picture.size);
    if (!options.show.empty() && (options.truth || options.side_by_side || options.samples > 1 || options.frames > 0 ||
                                  options.exposure_ev != 0 || options.display != "clip"))
        throw_spec_error("--show {}: shows the rays of one frame; expected none of --truth, --side-by-side, --samples, "
                         "--frames, --exposure and --display",
                         options.show);
    if (!(std::abs(options.exposure_ev) <= most_stops)) // NaN, too
        throw_spec_error("--exposure {}: expected stops from -{} to {}", options.exposure_ev, most_stops, most_stops);
    if (options.errors && (!options.show.empty() || options.truth || options.samples > 1))
        throw_spec_error("--errors: of one traced picture; expected none of --show, --truth and --samples");
    if (exr && (options.exposure_ev != 0 || options.display != "clip"))
        throw_spec_error("-o {}: an EXR holds linear radiance; --exposure and --display need a .png",
                         options.picture.output);
    return asked_techniques(catalogue, options.picture.technique, options.picture.parameters);
}

/// A jittered sequence is for people: it accumulates its pictures unless told otherwise.
RenderOptions presented(RenderOptions options)
{
    const bool told = std::ranges::any_of(options.picture.parameters, [](const std::string& pair) {
        return pair.starts_with("picture_history_weight=");
    });
    if (options.frames > 0 && options.picture.at.jitter_phases > 0 && !told)
        options.picture.parameters.emplace_back("picture_history_weight=0.9");
    return options;
}

/// "pan.png" is "pan_0007.png" in frame 7.
std::string numbered(const std::string& output, int frame)
{
    const std::filesystem::path path(output);
    return (path.parent_path() / fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()))
        .string();
}

/// The command that makes the same picture, but for the output.
std::string command_of(const RenderOptions& options, const Technique& technique, int at_frame)
{
    const PictureOptions& picture = options.picture;
    std::string           text    = "ssrlab render " + picture.scene + " --view " + picture.view;
    if (at_frame > 0) text += fmt::format(" --frame {}", at_frame);
    if (picture.at.jitter_phases > 0) text += fmt::format(" --jitter {}", picture.at.jitter_phases);
    if (!picture.size.empty()) text += " --size " + picture.size;
    text += " -t " + technique.id;
    for (const std::string& pair : picture.parameters) text += " -p " + pair;
    if (options.samples > 1) text += fmt::format(" --samples {}", options.samples);
    if (options.exposure_ev != 0) text += fmt::format(" --exposure {}", options.exposure_ev);
    if (options.display != "clip") text += " --display " + options.display;
    if (!options.show.empty()) text += " --show " + options.show;
    if (!options.sources.empty()) text += " --sources " + options.sources;
    if (options.truth) text += " --truth";
    if (options.side_by_side) text += " --side-by-side";
    return text;
}

void warn_without_reflections(const CommonOptions& common, const FramePlan& plan)
{
    if (common.quiet || plan.statistics.gbuffer.reflecting_pixels > 0) return;
    std::fputs("warning: nothing reflects: no pixel of this frame is metal, or smooth enough to reflect\n", stderr);
}

/// Hammersley points (J. Hammersley 1960), centred: their mean moves the picture by at most half of a sample's share.
glm::dvec2 sample_offset_px(int sample, int samples)
{
    if (samples == 1) return {0, 0};
    double mirrored = 0, digit = 0.5; // the binary digits of `sample` behind the point, in reverse order
    for (int rest = sample; rest > 0; rest /= 2, digit /= 2) mirrored += rest % 2 * digit;
    return glm::dvec2((sample + 0.5) / samples, mirrored + 0.5 / samples) - 0.5;
}

void refuse_false(std::optional<double> off_surface)
{
    if (const std::string why = drawn_elsewhere(off_surface); !why.empty()) throw_failure("no scene truth: {}", why);
}

/// What the truth is made with: the scene's hierarchy is built once.
class TrueReflections {
public:
    TrueReflections(const Stage& stage, int samples, std::optional<float> metallic_exponent)
        : stage_(stage), samples_(samples), metallic_exponent_(metallic_exponent)
    {
    }

    Image picture(Gpu& gpu, const TraceSettings& settings, int sample)
    {
        const GBufferImage gbuffer = read_gbuffer(gpu, *stage_.gbuffer);
        if (stage_.scene.frame) {
            const std::optional<Image> given = Truths(stage_.scene, gbuffer, {}).given_picture();
            if (!given)
                throw_spec_error("a frame of another renderer has no true reflection, unless it names a picture of it");
            return *given;
        }
        if (!bvh_ || anything_moves(stage_.first)) {
            bvh_ = std::make_unique<SceneBvh>(stage_.scene);
            refuse_false(off_surface_share(*bvh_, stage_.scene, gbuffer, settings));
        }
        // As many rays a pixel in all as one picture has; an even number.
        const int rays = 2 * std::max(1, (GlossySettings{}.rays / 2 + samples_ - 1) / samples_);
        return true_picture(
            glossy_truth(*bvh_, stage_.scene, gbuffer, settings,
                         {.rays = rays, .first = sample * rays, .metallic_exponent = metallic_exponent_}),
            gbuffer, stage_.scene.ambient);
    }

private:
    const Stage&              stage_;
    int                       samples_;
    std::optional<float>      metallic_exponent_;
    std::unique_ptr<SceneBvh> bvh_;
};

/// How right the rays are, how wrong, or how hard.
Image false_colours(Stage& stage, const TraceImage& counted, const TraceSettings& settings, const std::string& show)
{
    if (show == "fetches") return fetch_heat_map(counted);
    const GBufferImage gbuffer = read_gbuffer(stage.gpu, *stage.gbuffer); // with the layers that were traced
    if (!stage.scene.frame) {
        const SceneTruth truth = scene_truth(SceneBvh(stage.scene), stage.scene, gbuffer, settings);
        refuse_false(off_surface_share(truth));
        return show == "causes" ? causes_picture(counted, truth, gbuffer) : agreement_picture(counted, truth);
    }
    if (show == "causes")
        throw_spec_error("--show causes: needs the scene's triangles, which a frame of another renderer does not have");
    return agreement_picture(counted, screen_truth(gbuffer, settings));
}

/// Which source answered each ray, and whether rightly.
Image source_colours(Stage& stage, const Technique& technique, const Choice& choice,
                     std::span<const ListedSource> sources)
{
    SourceContext      context = make_source_context(stage, technique, choice.values, choice.settings);
    const AnsweredRays answered =
        answer_rays(context, choose_sources(context, sources, HandOn::uncertain).list, HandOn::uncertain);
    const SceneTruth truth = scene_truth(SceneBvh(stage.scene), stage.scene, context.image, choice.settings.trace);
    refuse_false(off_surface_share(truth));
    return sources_picture(answered.answers, truth, context.image);
}

struct Rendered {
    std::vector<LabelledImage> pictures;
    double                     trace_ms = 0;
};

/// Draws the traced picture, and returns the milliseconds of the trace. `asked`: what may answer rays beside the frame.
double run_traced(Stage& stage, ReadyFrame& frame, const LabPtr& lab, const RenderOptions& options,
                  std::span<const ListedSource> asked, int number)
{
    if (asked.empty()) {
        run_frame(stage.gpu, frame); // a driver may compile a pipeline when it first runs
        return run_frame(stage.gpu, frame).of("trace");
    }
    SourceContext context = make_source_context(stage, lab);
    for (int before = number - 1; before >= 0; --before)
        context.earlier.push_back(
            view_at(stage.scene, options.picture.view, stage.view.size_px, {before, options.picture.at.jitter_phases}));
    return run_answered_frame(context, frame, asked, HandOn::uncertain).of("trace");
}

/// Says how far the traced picture is from the one with the true reflections.
void print_errors(Stage& stage, const ReadyFrame& frame, const RenderOptions& options, const TraceSettings& settings,
                  std::optional<float> metallic_exponent)
{
    if (stage.scene.frame)
        throw_spec_error("--errors: needs the scene's triangles, which a frame of another renderer does not have");
    const GBufferImage gbuffer = read_gbuffer(stage.gpu, *stage.gbuffer);
    const auto         cache   = truth_cache_dir(options.picture.output);
    const SceneTruth   truth   = cached_scene_truth(cache, stage.scene, gbuffer, settings);
    refuse_false(off_surface_share(truth));
    const Image real = true_picture(
        cached_glossy_truth(cache, stage.scene, gbuffer, settings, {.metallic_exponent = metallic_exponent}), gbuffer,
        stage.scene.ambient);
    const MeasureValues errors = compare_pictures(read_shaded(stage.gpu, frame), Reference(real), truth, gbuffer);
    for (const char* name : {"picture_flip", "picture_rmse", "picture_visible_rmse"})
        std::puts(fmt::format("{} {:.4f}", name, errors.at(name).value_or(0)).c_str());
}

/// Adds the pictures of one place of the camera.
void add_sample(Stage& stage, ReadyFrame& frame, const LabPtr& lab, const FrameSettings& settings,
                const RenderOptions& options, std::span<const ListedSource> asked, TrueReflections& truth, int sample,
                int number, Rendered& rendered)
{
    const auto    kinds = shown_by(options);
    const Display display{options.exposure_ev,
                          options.display == "agx" ? Display::Transform::agx : Display::Transform::clip};
    rendered.trace_ms += run_traced(stage, frame, lab, options, asked, number) / options.samples;
    if (options.errors) print_errors(stage, frame, options, settings.trace, metallic_exponent_of(settings.passes));
    if (options.frames > 0)
        keep_history(stage.gpu, frame, number); // before other reflections take the place of the traced one
    // The traced picture first: the others leave theirs in its buffers.
    for (const Shows shows : {Shows::traced, Shows::nothing, Shows::truth}) {
        const auto at = std::ranges::find(kinds, shows);
        if (at == kinds.end()) continue;
        Image image;
        if (shows == Shows::traced) image = read_shaded(stage.gpu, frame);
        if (shows == Shows::truth) image = truth.picture(stage.gpu, settings.trace, sample);
        if (shows == Shows::nothing)
            image = composite_reflection(stage.gpu, frame,
                                         std::vector(pixel_count(stage.view.size_px), glm::vec4(0, 0, 0, -1)));
        // Pictures for people are averaged as they are shown, or the edges of very bright things would stay jagged.
        if (options.picture.output.ends_with(".png")) image = to_display(image, display);
        add_to(rendered.pictures[static_cast<size_t>(at - kinds.begin())].image, image);
    }
}

} // namespace

int render_picture(const CommonOptions& common, const RenderOptions& given)
{
    const RenderOptions   options   = presented(given);
    const PictureOptions& picture   = options.picture;
    const Catalogue       catalogue = load_catalogue(common.technique_dirs);
    const auto            asked_for = checked_techniques(catalogue, options);
    const std::string     list =
        options.sources.empty() && options.show == "sources" ? std::string("frame,world") : options.sources;
    auto  asked                = list.empty() ? std::vector<ListedSource>{} : parse_sources(list, "--sources " + list);
    Stage stage                = open_stage(common, catalogue, picture);
    const auto [named, choice] = choose_technique(stage, asked_for, common.quiet);
    const Technique& technique = *named;
    if (asked.size() == 1 && asked[0].source->id == "auto" && options.show.empty()) {
        SourceContext       context = make_source_context(stage, technique, choice.values, choice.settings);
        const ChosenSources chosen  = choose_sources(context, asked, HandOn::uncertain);
        if (!chosen.reason.empty() && !common.quiet) std::puts(("auto, " + chosen.reason).c_str());
        asked = chosen.list;
    }
    if (options.samples > 1 && stage.scene.frame)
        throw_spec_error("--samples: expected 1 for a frame of another renderer, which cannot be rendered anew; got {}",
                         options.samples);
    TrueReflections            truth(stage, options.samples, metallic_exponent_of(choice.settings.passes));
    std::optional<std::string> impossible;
    // Each sample has frames of its own before it.
    std::vector<FrameHistoryPtr> histories(static_cast<size_t>(options.samples));
    for (FrameHistoryPtr& history : histories)
        if (options.frames > 0) history = make_history(stage.gpu, stage.view.size_px);
    for (int i = 0; i < std::max(options.frames, 1); ++i) {
        Rendered rendered;
        for (const Shows shows : shown_by(options)) rendered.pictures.push_back({label_of(shows, technique.id), {}});
        for (int sample = 0; sample < options.samples; ++sample) {
            if (i > 0 || options.samples > 1)
                show(stage, picture.view, stage.view.size_px, {picture.at.frame + i, picture.at.jitter_phases},
                     sample_offset_px(sample, options.samples));
            const FrameHistoryPtr& history = histories[static_cast<size_t>(sample)];
            const LabPtr           lab     = make_lab(stage, technique, choice.values, choice.settings.trace);
            const FrameBuffersPtr  buffers = make_frame_buffers(stage);
            const FramePlan        plan    = plan_frame(stage, lab, buffers, choice.settings, history);
            const FramePtr         frame =
                make_frame(stage.gpu, lab, buffers, plan, history, asked.empty() ? Answers::own : Answers::given);
            if (sample == 0) warn_without_reflections(common, plan);
            if (i == 0 && sample == 0) say(common, lacked_channel_text(stage.scene, catalogue, choice.settings.trace));
            if (i == 0 && sample == 0 && !options.truth)
                say(common, no_hits_text(technique, choice.settings.trace, stage.scene, plan.statistics.trace));
            const bool                first = i == 0 && sample == 0 && !options.truth;
            std::optional<TraceImage> counted;
            if (first || !options.show.empty()) counted = trace_gbuffer(stage.gpu, *make_tracer(stage.gpu, lab));
            if (first) impossible = find_impossible(*counted, declared_steps(technique, choice.values));
            if (options.show == "sources")
                rendered.pictures.front().image = source_colours(stage, technique, choice, asked);
            else if (!options.show.empty())
                rendered.pictures.front().image = false_colours(stage, *counted, choice.settings.trace, options.show);
            else
                add_sample(stage, *frame, lab, choice.settings, options, asked, truth, sample, picture.at.frame + i,
                           rendered);
        }
        for (LabelledImage& one : rendered.pictures) one.image = mean_of(std::move(one.image), options.samples);
        Image image = options.side_by_side ? side_by_side(rendered.pictures) : rendered.pictures.front().image;
        image.metadata["ssrlab:version"] = SSRLAB_VERSION; // without the commit: the same picture gives the same file
        image.metadata["ssrlab:command"] = command_of(options, technique, picture.at.frame + i);
        const std::string file = options.frames > 0 ? numbered(picture.output, picture.at.frame + i) : picture.output;
        write_image(file, image);
        const std::string timed = options.show.empty() ? fmt::format(", trace {:.2f} ms", rendered.trace_ms) : "";
        std::puts(fmt::format("{}: {}x{}{} on {}", file, stage.view.size_px.x, stage.view.size_px.y, timed,
                              stage.gpu.info.name)
                      .c_str());
        if (impossible) throw InvalidResult(*impossible);
    }
    return report_messages(stage);
}

} // namespace ssrlab
