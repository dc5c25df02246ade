#include "app/ray_command.h"

#include "app/pixel_sources.h"
#include "app/python_script.h"
#include "check/ray_report.h"
#include "core/error.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "core/printable.h"
#include "harness/choose_technique.h"
#include "harness/experiment.h"
#include "truth/reflected_rays.h"
#include "truth/scene_bvh.h"
#include "truth/screen_ray.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace ssrlab {
namespace {

glm::ivec2 pixel_option(const std::string& text, glm::ivec2 size_px)
{
    glm::ivec2  pixel(-1);
    const auto  comma = text.find(',');
    const char* end   = text.data() + text.size();
    const bool  read  = comma != std::string::npos &&
                      std::from_chars(text.data(), end, pixel.x).ptr == text.data() + comma &&
                      std::from_chars(text.data() + comma + 1, end, pixel.y).ptr == end;
    if (!read) throw_spec_error("--pixel: expected X,Y, got '{}'", text);
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size_px.x || pixel.y >= size_px.y)
        throw_spec_error("--pixel {}: outside the image of {}x{} pixels", text, size_px.x, size_px.y);
    return pixel;
}

/// What "exact" may stand for, by the parameters that an exact technique has; empty: it is not asked for.
std::vector<AskedTechnique> exact_ones(const RayOptions& options, const Catalogue& catalogue)
{
    if (std::ranges::find(options.techniques, fastest_exact) == options.techniques.end()) return {};
    std::vector<std::string> pairs;
    std::ranges::copy_if(options.picture.parameters, std::back_inserter(pairs), [&](const std::string& pair) {
        return std::ranges::any_of(catalogue.techniques, [&](const Technique& technique) {
            return technique.exact && takes(catalogue, technique, pair);
        });
    });
    return asked_techniques(catalogue, fastest_exact, pairs);
}

/// A parameter counts for every technique that has it. `exact`: the technique that "exact" stands for.
std::vector<RayQuestion> questions_of(const RayOptions& options, const Catalogue& catalogue, const Technique* exact,
                                      FrameSettings& settings)
{
    std::vector<const Technique*> techniques;
    for (const std::string& id : options.techniques)
        techniques.push_back(id == fastest_exact ? exact : &find_technique(catalogue.techniques, id));
    std::vector<RayQuestion> questions;
    for (const Choice& choice : parse_choices(catalogue, techniques, options.picture.parameters)) {
        settings = choice.settings;
        questions.push_back({techniques[questions.size()], choice.values});
    }
    return questions;
}

std::optional<TrueEnd> true_end_of(const Stage& stage, const Setup& setup, glm::ivec2 pixel)
{
    if (stage.scene.frame) return std::nullopt;
    const SceneBvh      bvh(stage.scene);
    const ReflectedRays reflected(bvh, stage.scene, setup.gbuffer, setup.settings.max_distance_m);
    const SceneRay      ray   = reflected.ray_from(pixel, mirror_direction_vs(setup.gbuffer, pixel));
    const RayEnd        end   = reflected.follow(std::span(&ray, 1))[0];
    const size_t        index = pixel_index(pixel, setup.gbuffer.view.size_px);
    return TrueEnd{end.cls, end.distance_m, end.point_px, reflected.count_off_surface(std::span(&index, 1)) > 0};
}

RayInput ray_of_pixel(Stage& stage, const Setup& setup, const RayQuestion& question, glm::ivec2 pixel)
{
    if (!reflects(setup.gbuffer, pixel, setup.settings)) {
        const size_t i = pixel_index(pixel, setup.gbuffer.view.size_px);
        throw_spec_error("pixel {},{} does not reflect: depth {:g}, metallic {:g}", pixel.x, pixel.y,
                         setup.gbuffer.depth[i], setup.gbuffer.metallic[i]);
    }
    const LabPtr    lab    = make_lab(stage, *question.technique, question.values, setup.settings);
    const TracerPtr tracer = make_tracer(stage.gpu, lab);
    for (const RayInput& ray : set_up_rays(stage.gpu, *tracer))
        if (ray.pixel == pixel) return ray;
    throw_failure("pixel {},{} has no ray", pixel.x, pixel.y);
}

void print_report(const RayOptions& options, const RayReport& report)
{
    const RayInput&   ray       = report.ray;
    const bool        unlimited = !(ray.length_m < TraceSettings{}.max_distance_m);
    const std::string length    = unlimited ? "no limit of length" : fmt::format("{:.4g} m", ray.length_m);
    std::puts(fmt::format("Ray of pixel ({}, {}) of {}: {}, {:.1f} px on screen, crosses {}", ray.pixel.x, ray.pixel.y,
                          options.picture.scene, length, glm::length(glm::dvec2(ray.delta_px_depth)),
                          counted(report.walk.size(), "pixel"))
                  .c_str());
    std::puts(("screen truth: " + report.exact_ending).c_str());
    if (!report.true_end)
        std::puts("scene truth: not known: a frame of another renderer has no triangles");
    else if (report.true_end->cls == TruthClass::sky)
        std::puts("scene truth: sky, the ray meets nothing");
    else
        std::puts(fmt::format("scene truth: {}, {:.4g} m along the ray, at ({:.2f}, {:.2f}) px",
                              truth_class_names[static_cast<size_t>(report.true_end->cls)], report.true_end->distance_m,
                              report.true_end->point_px.x, report.true_end->point_px.y)
                      .c_str());
    if (report.true_end && report.true_end->starts_off_surface)
        std::puts("  it may be false: the depth that was drawn here is off every surface of the scene");
    for (const TechniqueReport& technique : report.techniques) {
        std::puts(fmt::format("\n{}: {}\n{}; {} steps, {} depth fetches, {} structure fetches", technique.id,
                              technique.ending, technique.verdict, technique.outcome.steps,
                              technique.outcome.depth_fetches, technique.outcome.structure_fetches)
                      .c_str());
        std::fputs(visits_table(technique).c_str(), stdout);
        if (technique.visit_count > technique.visits.size() && technique.visit_count > 65536)
            std::puts(fmt::format("  the first 65536 of {} visits", technique.visit_count).c_str());
    }
}

/// The part of the lit picture around the ray, for the screen view.
nlohmann::json background_of(const Setup& setup, const RayReport& report)
{
    constexpr int    margin_px = 6;
    const glm::ivec2 size_px   = setup.gbuffer.view.size_px;
    const glm::dvec2 from = report.ray.origin_px_depth, to = from + glm::dvec2(report.ray.delta_px_depth);
    const glm::ivec2 first = glm::clamp(glm::ivec2(glm::min(from, to)) - margin_px, glm::ivec2(0), size_px - 1);
    const glm::ivec2 last  = glm::clamp(glm::ivec2(glm::max(from, to)) + margin_px, glm::ivec2(0), size_px - 1);
    nlohmann::json   rows  = nlohmann::json::array();
    for (int y = first.y; y <= last.y; ++y) {
        nlohmann::json row = nlohmann::json::array();
        for (int x = first.x; x <= last.x; ++x) {
            const size_t    i      = pixel_index({x, y}, size_px);
            const glm::vec3 colour = glm::min(setup.gbuffer.radiance[i] + setup.gbuffer.highlight[i], 1.0F);
            row.push_back({colour.x, colour.y, colour.z});
        }
        rows.push_back(std::move(row));
    }
    return {{"first", {first.x, first.y}}, {"rows", std::move(rows)}};
}

void draw_ray(nlohmann::json json, const Setup& setup, const RayReport& report, const std::filesystem::path& output)
{
    json["background"]               = background_of(setup, report);
    const std::filesystem::path data = output.string() + ".json.tmp";
    write_file_atomically(data, json.dump());
    const auto remove = [&] {
        std::error_code ignored;
        std::filesystem::remove(data, ignored);
    };
    try {
        run_python("experiments/plot", {"ray", data.string(), output.string()});
    } catch (...) {
        remove();
        throw;
    }
    remove();
}

} // namespace

int explain_ray(const CommonOptions& common, const RayOptions& options)
{
    const std::filesystem::path output    = options.picture.output;
    const std::string           extension = output.extension().string();
    if (!output.empty()) require_output(options.picture.output, {".json", ".png"});
    const Catalogue catalogue = load_catalogue(common.technique_dirs);
    FrameSettings   settings;
    const auto      exact = exact_ones(options, catalogue);
    auto questions        = questions_of(options, catalogue, exact.empty() ? nullptr : exact[0].technique, settings);
    const std::vector<ListedSource> listed = options.sources.empty()
                                                 ? std::vector<ListedSource>{}
                                                 : parse_sources(options.sources, "--sources " + options.sources);
    Stage                           stage  = open_stage(common, catalogue, options.picture);
    if (exact.size() > 1)
        questions = questions_of(options, catalogue, choose_technique(stage, exact, common.quiet).technique, settings);
    say(common, lacked_channel_text(stage.scene, catalogue, settings.trace));
    if (stage.drawing) draw_layers(stage.gpu, *stage.drawing, settings.trace.layers);
    const Setup      setup{"", read_gbuffer(stage.gpu, *stage.gbuffer), settings.trace, {}};
    const glm::ivec2 pixel  = pixel_option(options.pixel, stage.view.size_px);
    const RayInput   ray    = ray_of_pixel(stage, setup, questions.front(), pixel);
    RayReport        report = report_ray(stage.gpu, catalogue, setup, ray, questions);
    report.true_end         = true_end_of(stage, setup, pixel);
    std::optional<PixelSources> sources;
    if (!listed.empty())
        sources =
            ask_about_pixel(stage, *questions.front().technique, questions.front().values, settings,
                            options.picture.view, options.picture.at, listed, pixel_index(pixel, stage.view.size_px));

    nlohmann::json json = to_json(report, setup);
    if (sources) json["sources"] = to_json(*sources);
    json["scene"] = options.picture.scene;
    json["view"]  = options.picture.view;
    if (options.json)
        std::puts(json.dump(1).c_str());
    else
        print_report(options, report);
    if (sources && !options.json) print_pixel_sources(*sources);
    if (extension == ".json") write_file_atomically(output, json.dump(1) + "\n");
    if (extension == ".png") draw_ray(json, setup, report, output);
    if (!output.empty() && !options.json) std::puts(options.picture.output.c_str());
    return report_messages(stage);
}

} // namespace ssrlab
