#include "app/judge_command.h"

#include "check/judge_frame.h"
#include "compare/causes.h"
#include "compare/image_io.h"
#include "core/error.h"
#include "core/files.h"
#include "core/plane_gradient.h"
#include "core/printable.h"
#include "harness/experiment.h"
#include "harness/measured_run.h"
#include "harness/quality.h"
#include "truth/scene_truth.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;
using Json   = nlohmann::ordered_json;

constexpr size_t most_lines = 10; // of findings, in the table; JSON has all

/// One hits file, judged.
struct Judged {
    std::string              frame, hits;
    glm::ivec2               size_px{0, 0};
    std::vector<std::string> settings; // name=value
    FrameJudgement           judgement;
    Record                   measures; // the columns of results.csv that a run would have
    bool                     has_scene = false;
    std::optional<double>    f1; // of the scene truth, else of the screen truth; none: nothing is to be hit, nor is it
};

void set_pairs(const std::vector<Setting>& settings, const std::vector<std::string>& pairs, bool strict,
               FrameSettings& to)
{
    for (const std::string& pair : pairs) {
        const auto        equals = pair.find('=');
        const std::string name   = pair.substr(0, equals);
        const auto        found  = std::ranges::find_if(
                    settings, [&](const Setting& setting) { return setting.table == "trace" && setting.name == name; });
        if (found != settings.end() && equals != std::string::npos)
            found->set(to, parse_parameter(*found, pair.substr(equals + 1), "-p " + pair));
        else if (strict)
            throw_spec_error("-p {}: expected name=value of a setting of [trace] (docs/reference/settings.md)", pair);
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
    if (!common.quiet)
        for (const std::string& warning : scene.warnings)
            std::fprintf(stderr, "warning: %s\n", printable(warning).c_str());
    return scene;
}

Scene load_triangles(const JudgeOptions& options)
{
    Scene scene = load_scene(options.scene);
    if (scene.frame) throw_spec_error("--scene {}: a frame has no triangles; expected a scene", options.scene);
    return options.at_frame > 0 ? scene_at(scene, options.at_frame) : scene;
}

/// All surfaces of the frame must be the scene's, not only those that reflect: floors of scenes may coincide.
void require_same_scene(const JudgeOptions& options, const Scene& scene, GBufferImage gbuffer)
{
    std::ranges::fill(gbuffer.metallic, 1.0F);
    const std::optional<double> off = off_surface_share(SceneBvh(scene), scene, gbuffer, {});
    if (!drawn_elsewhere(off).empty())
        throw_failure("--scene {}: at {:.0f} % of the frame's pixels this scene has no surface; is it the same scene, "
                      "in the same place?",
                      options.scene, 100 * *off);
}

fs::path truth_cache()
{
    const char* folder = std::getenv("SSRLAB_CACHE");
    return folder != nullptr ? folder : "";
}

void write_picture(const JudgeOptions& options, const Truths& truths, const TraceResult& answers)
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
    const HitsFile      hits = read_hits(options.hits, gbuffer.view.size_px);
    Judged              judged{options.frame, options.hits, gbuffer.view.size_px, {}, {}, {}, false, {}};
    const FrameSettings settings = settings_of(catalogue, hits, options.parameters, judged.settings);
    judged.judgement             = judge_frame(gbuffer, settings.trace, hits);
    if (judged.judgement.rays == 0)
        throw_spec_error("{}: no pixel reflects under these settings, so there is nothing to judge", options.frame);
    const Scene scene = options.scene.empty() ? std::move(frame) : load_triangles(options);
    if (!options.scene.empty()) require_same_scene(options, scene, gbuffer);
    Truths truths(scene, std::move(gbuffer), truth_cache());
    truths.make(settings.trace, false);
    judged.has_scene           = truths.without_scene().empty();
    const TraceResult& answers = judged.judgement.usable;
    add_counts(judged.measures, answers);
    judged.measures.erase("structures.fetches_mean"); // the file adds up the reads of all structures
    if (!hits.has_steps)
        std::erase_if(judged.measures, [](const auto& column) { return column.first.starts_with("steps_"); });
    add_measures(judged.measures, truths.compare(answers, nullptr, nullptr));
    judged.f1 = number_of(judged.measures, judged.has_scene ? "f1_1px" : "screen_f1_1px");
    if (!options.output.empty()) write_picture(options, truths, answers);
    return judged;
}

Json json_of(const Judged& judged)
{
    Json json{{"frame", judged.frame},
              {"hits", judged.hits},
              {"size_px", {judged.size_px.x, judged.size_px.y}},
              {"settings", judged.settings},
              {"rays", judged.judgement.rays},
              {"answers_of_other_pixels", judged.judgement.ignored},
              {"wrong", judged.judgement.wrong()},
              {"by_contract", Json::object()},
              {"f1_truth", judged.has_scene ? "scene" : "screen"},
              {"f1", nullptr},
              {"measures", Json::object()},
              {"findings", Json::array()}};
    if (judged.f1) json["f1"] = *judged.f1;
    for (size_t i = 0; i < fault_names.size(); ++i)
        json["by_contract"][std::string(fault_names[i])] = judged.judgement.count[i];
    for (const auto& [column, value] : judged.measures)
        if (const auto number = number_of(judged.measures, column)) json["measures"][column] = *number;
    for (const Finding& finding : judged.judgement.findings)
        json["findings"].push_back({{"pixel", {finding.pixel.x, finding.pixel.y}},
                                    {"fault", fault_names[static_cast<size_t>(finding.fault)]},
                                    {"expected", finding.expected},
                                    {"got", finding.got},
                                    {"why", finding.why}});
    return json;
}

std::string percent(const Record& measures, const std::string& column)
{
    const auto value = number_of(measures, column);
    return value ? fmt::format("{:.2f} %", 100 * *value) : "none";
}

/// The shares of the columns PREFIX + name + SUFFIX that are above 0.
std::string shares(const Record& measures, std::span<const std::string_view> names, std::string_view prefix,
                   std::string_view suffix)
{
    std::string text;
    for (const std::string_view name : names)
        if (const double share = number_of(measures, fmt::format("{}{}{}", prefix, name, suffix)).value_or(0);
            share > 0)
            text += fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", name, 100 * share);
    return text.empty() ? "none" : text;
}

std::string fault_counts(const FrameJudgement& judgement)
{
    std::string text;
    for (size_t i = static_cast<size_t>(Fault::impossible); i < fault_names.size(); ++i)
        if (judgement.count[i] > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", fault_names[i], judgement.count[i]);
    return text.empty() ? "" : fmt::format(" ({})", text);
}

void print_findings(const std::vector<Finding>& findings)
{
    for (size_t i = 0; i < std::min(findings.size(), most_lines); ++i) {
        const Finding& found = findings[i];
        std::puts(fmt::format("  ({}, {}) {}: got {}; expected {}", found.pixel.x, found.pixel.y,
                              fault_names[static_cast<size_t>(found.fault)], found.got, found.expected)
                      .c_str());
        if (!found.why.empty()) std::puts(fmt::format("    {}", found.why).c_str());
    }
    if (findings.size() > most_lines)
        std::puts(fmt::format("  and {} more; --json lists all", findings.size() - most_lines).c_str());
}

void print(const Judged& judged)
{
    const FrameJudgement& judgement = judged.judgement;
    const Record&         m         = judged.measures;
    std::puts(fmt::format("{} of {}, {}: {} rays{}{}", judged.hits, judged.frame, size_text(judged.size_px),
                          judgement.rays, judged.settings.empty() ? "" : "; ", fmt::join(judged.settings, " "))
                  .c_str());
    if (judgement.ignored > 0)
        std::puts(
            fmt::format("ignored: {} answers of pixels that do not reflect under these settings", judgement.ignored)
                .c_str());
    std::puts(fmt::format("ends: {}", shares(m, trace_status_names, "", "_share")).c_str());
    std::puts(fmt::format("hit contract: {} right, {} near ties, {} wrong{}", judgement.of(Fault::right),
                          judgement.of(Fault::near_tie), judgement.wrong(), fault_counts(judgement))
                  .c_str());
    print_findings(judgement.findings);
    const auto line = [&](const char* truth, const char* prefix) {
        std::puts(
            fmt::format("{}: recall {}, precision {}, F1 {}", truth, percent(m, fmt::format("{}recall_1px", prefix)),
                        percent(m, fmt::format("{}precision_1px", prefix)), percent(m, fmt::format("{}f1_1px", prefix)))
                .c_str());
    };
    line("screen truth", "screen_");
    if (!judged.has_scene) return;
    line("scene truth", "");
    std::puts(fmt::format("wrong rays: {}; by cause: {}", percent(m, "wrong_rays"),
                          shares(m, wrong_cause_names, "wrong_", ""))
                  .c_str());
}

bool passes(const Judged& judged, const JudgeOptions& options, bool any_wrong_fails)
{
    if (judged.judgement.of(Fault::impossible) > 0) return false;
    if (options.min_f1) return judged.f1.value_or(1) >= *options.min_f1;
    return !any_wrong_fails || judged.judgement.wrong() == 0;
}

Json read_manifest(const fs::path& file)
{
    if (!fs::exists(file)) throw_spec_error("{}: no such file; ssrlab export-cases writes it", short_path(file));
    try {
        return Json::parse(read_file(file));
    } catch (const Json::exception& error) {
        throw_spec_error("{}: {}", short_path(file), error.what());
    }
}

/// The options of each case of a folder that export-cases wrote.
std::vector<JudgeOptions> cases_of(const JudgeOptions& options)
{
    const fs::path            file = fs::path(options.frame) / "manifest.json";
    const Json                json = read_manifest(file);
    std::vector<JudgeOptions> cases;
    if (!options.scene.empty() || !options.output.empty() || !options.parameters.empty())
        throw_spec_error("{}: the cases have their own settings and no scene: give no --scene, -p and -o",
                         options.frame);
    try {
        for (const Json& entry : json.at("frames")) {
            JudgeOptions one = options;
            one.frame        = (fs::path(options.frame) / entry.at("frame").get<std::string>()).string();
            one.hits         = (fs::path(options.hits) / (entry.at("name").get<std::string>() + ".exr")).string();
            for (const auto& [name, value] : entry.at("settings").items())
                one.parameters.push_back(name + "=" + value.get<std::string>());
            if (fs::exists(one.hits)) cases.push_back(one);
        }
    } catch (const Json::exception& error) {
        throw_spec_error("{}: {}", short_path(file), error.what());
    }
    if (cases.empty())
        throw_spec_error("{}: no hits: expected NAME.exr for names of {}", options.hits, short_path(file));
    if (const size_t missing = json.at("frames").size() - cases.size(); missing > 0)
        std::fprintf(stderr, "warning: %zu of %zu cases have no hits\n", missing, json.at("frames").size());
    return cases;
}

int judge_folder(const CommonOptions& common, const Catalogue& catalogue, const JudgeOptions& options)
{
    Json   all    = Json::array();
    size_t failed = 0, count = 0;
    for (const JudgeOptions& one : cases_of(options)) {
        const Judged judged = judge_file(common, catalogue, one);
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
    if (options.json)
        std::puts(all.dump(1).c_str());
    else
        std::puts(fmt::format("{} of {} cases pass", count - failed, count).c_str());
    return failed == 0 ? 0 : 1;
}

} // namespace

int judge_hits(const CommonOptions& common, const JudgeOptions& options)
{
    if (!options.output.empty()) require_ending(options.output, {".png"});
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
