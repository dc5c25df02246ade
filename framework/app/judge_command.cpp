#include "app/judge_command.h"

#include "app/cases.h"
#include "app/judge_report.h"
#include "compare/image_io.h"
#include "core/error.h"
#include "core/names.h"
#include "core/plane_gradient.h"
#include "core/printable.h"
#include "harness/bake_scene.h"
#include "harness/experiment.h"
#include "harness/measured_run.h"
#include "harness/quality.h"
#include "truth/scene_truth.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using Json   = nlohmann::ordered_json;

void set_pairs(const std::vector<Setting>& settings, const std::vector<std::string>& pairs, bool strict,
               FrameSettings& to)
{
    std::vector<std::string> known;
    for (const Setting& setting : settings)
        if (setting.table == "trace") known.push_back(setting.name);
    for (const std::string& pair : pairs) {
        const auto        equals = pair.find('=');
        const std::string name   = pair.substr(0, equals);
        const auto        found  = std::ranges::find_if(
                    settings, [&](const Setting& setting) { return setting.table == "trace" && setting.name == name; });
        if (found != settings.end() && equals != std::string::npos)
            found->set(to, parse_parameter(*found, pair.substr(equals + 1), "-p " + pair));
        else if (strict && equals == std::string::npos)
            throw_spec_error("-p {}: expected name=value of a setting of [trace] (docs/reference/settings.md)", pair);
        else if (strict)
            throw_spec_error("-p {}: {}", pair, unknown_name("setting of [trace]", name, known));
    }
}

/// Those of -p, over those that ssrlab trace wrote into the file.
FrameSettings settings_of(const Catalogue& catalogue, const HitsFile& hits, const std::vector<std::string>& pairs,
                          std::vector<std::string>& in_words)
{
    const std::vector<Setting> settings = all_settings(catalogue);
    FrameSettings              result;
    set_pairs(settings, stated_parameters(hits), false, result);
    set_pairs(settings, pairs, true, result);
    const FrameSettings defaults;
    for (const Setting& setting : settings)
        if (setting.table == "trace" && setting.get(result) != setting.get(defaults))
            in_words.push_back(setting.name + "=" + format_parameter(setting, setting.get(result)));
    return result;
}

Scene load_judged_frame(const CommonOptions& common, const std::string& name)
{
    if (!name.ends_with(".exr")) throw_spec_error("{}: expected a frame file (.exr), or a folder of cases", name);
    Scene scene = load_scene(name);
    say_warnings(common, scene);
    return scene;
}

Scene load_triangles(const CommonOptions& common, const JudgeOptions& options)
{
    Scene scene = load_scene(options.scene);
    if (scene.frame) throw_spec_error("--scene {}: a frame has no triangles; expected a scene", options.scene);
    bake_scene(scene, [&](const std::string& text) { say(common, text); });
    return options.at_frame > 0 ? scene_at(scene, options.at_frame) : scene;
}

/// All surfaces of the frame must be the scene's, not only those that reflect: floors of scenes may coincide.
void require_same_scene(const JudgeOptions& options, const Scene& scene, GBufferImage gbuffer)
{
    std::ranges::fill(gbuffer.metallic, 1.0F);
    const std::optional<double> off = off_surface_share(SceneBvh(scene), scene, gbuffer, {});
    if (!drawn_elsewhere(off).empty())
        throw_failure(
            "--scene {}: at {:.0f} % of the frame's pixels this scene has no surface. Expected the same scene "
            "in the same place, and in the frame's [camera] position, right, up and forward in metres of that "
            "scene (docs/reference/frame_files.md)",
            options.scene, 100 * *off);
}

fs::path truth_cache()
{
    const char* folder = std::getenv("SSRLAB_CACHE");
    return folder != nullptr ? folder : "";
}

void write_picture(const JudgeOptions& options, const Truths& truths, const TraceImage& answers)
{
    const auto picture = options.show == "causes" ? truths.causes(answers) : truths.agreement(answers);
    if (!picture) throw_spec_error("--show causes: needs the scene's triangles; give --scene");
    write_image(options.output, *picture);
}

Judged judge_file(const CommonOptions& common, const Catalogue& catalogue, const JudgeOptions& options)
{
    Scene        frame   = load_judged_frame(common, options.frame);
    GBufferImage gbuffer = frame.frame->gbuffer;
    complete_gradients(gbuffer);
    const HitsFile hits = read_hits(options.hits, gbuffer.view.size_px);
    for (const std::string& warning : hits.warnings) say(common, "warning: " + warning);
    Judged              judged{options.frame, options.hits, gbuffer.view.size_px, {}, {}, {}, false, {}};
    const FrameSettings settings = settings_of(catalogue, hits, options.parameters, judged.settings);
    say(common, lacked_channel_text(frame, catalogue, settings.trace));
    judged.judgement = judge_frame(gbuffer, settings.trace, hits);
    if (judged.judgement.rays == 0)
        throw_spec_error("{}: no pixel reflects under these settings, so there is nothing to judge", options.frame);
    const Scene scene = options.scene.empty() ? std::move(frame) : load_triangles(common, options);
    if (!options.scene.empty()) require_same_scene(options, scene, gbuffer);
    Truths truths(scene, std::move(gbuffer), truth_cache());
    truths.make(settings.trace, false);
    judged.has_scene          = truths.without_scene().empty();
    const TraceImage& answers = judged.judgement.usable;
    add_counts(judged.measures, answers);
    judged.measures.erase("structures.fetches_mean"); // the file adds up the reads of all structures
    if (!hits.has_steps)
        std::erase_if(judged.measures, [](const auto& column) { return column.first.starts_with("steps_"); });
    add_measures(judged.measures, truths.compare(answers, nullptr, nullptr));
    judged.f1 = number_of(judged.measures, judged.has_scene ? "f1_1px" : "screen_f1_1px");
    if (!options.output.empty()) write_picture(options, truths, answers);
    return judged;
}

bool passes(const Judged& judged, const JudgeOptions& options, bool any_wrong_fails)
{
    if (judged.judgement.of(Fault::impossible) > 0) return false;
    if (options.min_f1) return judged.f1.value_or(1) >= *options.min_f1;
    return !any_wrong_fails || judged.judgement.wrong() == 0;
}

/// A misspelt name would otherwise look like a case that was not traced.
void refuse_unknown_hits(const JudgeOptions& options, const std::vector<ExportedCase>& cases)
{
    std::vector<std::string> names, unknown;
    std::ranges::transform(cases, std::back_inserter(names), &ExportedCase::name);
    for (const auto& entry : fs::directory_iterator(options.hits))
        if (entry.path().extension() == ".exr" && std::ranges::find(names, entry.path().stem().string()) == names.end())
            unknown.push_back(entry.path().stem().string());
    std::ranges::sort(unknown);
    if (!unknown.empty())
        throw_spec_error("{}: expected NAME.exr for the names in {}/manifest.json, got {}.exr{}{}", options.hits,
                         options.frame, unknown.front(), suggestion(unknown.front(), names),
                         unknown.size() > 1 ? fmt::format(" and {} more that it does not name", unknown.size() - 1)
                                            : "");
}

/// Of a folder that export-cases wrote: the options of each case that has hits, and the names of the others.
struct FolderCases {
    std::vector<JudgeOptions> with_hits;
    std::vector<std::string>  without;
};

FolderCases cases_of(const JudgeOptions& options)
{
    if (!options.scene.empty() || !options.output.empty() || !options.parameters.empty())
        throw_spec_error("{}: the cases have their own settings and no scene: give no --scene, -p and -o",
                         options.frame);
    const std::vector<ExportedCase> all = read_cases(options.frame);
    if (!fs::is_directory(options.hits))
        throw_spec_error("{}: expected a folder with NAME.exr for the names in {}/manifest.json", options.hits,
                         options.frame);
    refuse_unknown_hits(options, all);
    FolderCases cases;
    for (const ExportedCase& one : all) {
        JudgeOptions own = options;
        own.frame        = one.frame.string();
        own.hits         = (fs::path(options.hits) / (one.name + ".exr")).string();
        own.parameters   = one.settings;
        if (fs::exists(own.hits))
            cases.with_hits.push_back(own);
        else
            cases.without.push_back(one.name);
    }
    if (cases.with_hits.empty())
        throw_spec_error("{}: no hits: expected NAME.exr for the names in {}/manifest.json", options.hits,
                         options.frame);
    return cases;
}

int judge_folder(const CommonOptions& common, const Catalogue& catalogue, const JudgeOptions& options)
{
    Json          all    = Json::array();
    size_t        failed = 0, count = 0;
    CommonOptions quiet     = common;
    quiet.quiet             = true; // the frames are ours
    const FolderCases cases = cases_of(options);
    for (const JudgeOptions& one : cases.with_hits) {
        const Judged judged = judge_file(quiet, catalogue, one);
        const bool   passed = passes(judged, one, true);
        failed += !passed;
        ++count;
        if (options.json) {
            all.push_back(json_of(judged));
            all.back()["passed"] = passed;
            continue;
        }
        std::puts(fmt::format("{} {}: {} rays, {} wrong{}", passed ? "pass" : "FAIL",
                              fs::path(one.hits).stem().string(), judged.judgement.rays, judged.judgement.wrong(),
                              fault_counts(judged.judgement))
                      .c_str());
        if (!passed) print_findings(judged.judgement.findings);
    }
    for (const std::string& name : options.partial ? std::vector<std::string>() : cases.without) {
        ++failed, ++count;
        if (options.json)
            all.push_back({{"frame", (fs::path(options.frame) / "frames" / (name + ".exr")).string()},
                           {"hits", nullptr},
                           {"passed", false}});
        else
            std::puts(fmt::format("FAIL {}: no hits", name).c_str());
    }
    if (options.json)
        std::puts(all.dump(1).c_str());
    else
        std::puts(fmt::format("{} of {} cases pass{}", count - failed, count,
                              options.partial && !cases.without.empty()
                                  ? fmt::format("; --partial: {} without hits do not count", cases.without.size())
                                  : "")
                      .c_str());
    return failed == 0 ? 0 : 1;
}

} // namespace

int judge_hits(const CommonOptions& common, const JudgeOptions& options)
{
    if (!options.output.empty()) require_output(options.output, {".png"});
    if (options.show == "causes" && options.scene.empty())
        throw_spec_error("--show causes: needs the scene's triangles; give --scene");
    const Catalogue catalogue = load_catalogue(common.technique_dirs);
    if (fs::is_directory(options.frame)) return judge_folder(common, catalogue, options);
    const Judged judged = judge_file(common, catalogue, options);
    const bool   passed = passes(judged, options, false);
    if (options.json) {
        Json json      = json_of(judged);
        json["passed"] = passed;
        std::puts(json.dump(1).c_str());
        return passed ? 0 : 1;
    }
    print(judged);
    if (!options.output.empty()) std::puts(options.output.c_str());
    if (judged.judgement.of(Fault::impossible) > 0) std::puts("fails: answers that cannot be");
    if (options.min_f1)
        std::puts(fmt::format("F1 {} against the {} truth, at least {:.6g}: {}",
                              judged.f1 ? fmt::format("{:.6g}", *judged.f1) : "none",
                              judged.has_scene ? "scene" : "screen", *options.min_f1, passed ? "passes" : "fails")
                      .c_str());
    return passed ? 0 : 1;
}

} // namespace ssrlab
