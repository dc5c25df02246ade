#include "app/stage.h"

#include "core/error.h"
#include "core/printable.h"
#include "core/size.h"
#include "harness/experiment.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

namespace ssrlab {

void require_ending(const std::string& output, const std::vector<std::string>& endings)
{
    const std::string ending = std::filesystem::path(output).extension().string();
    if (std::ranges::find(endings, ending) == endings.end())
        throw_spec_error("-o {}: expected a file that ends in {}", output, fmt::join(endings, " or "));
}

glm::ivec2 size_option(const std::string& text)
{
    const std::optional<glm::ivec2> size_px = parse_size(text);
    if (!size_px || size_px->x < 1 || size_px->y < 1)
        throw_spec_error("--size: expected WIDTHxHEIGHT, both at least 1, got '{}'", text);
    return *size_px;
}

Stage prepare_stage(const CommonOptions& common, const PictureOptions& options)
{
    Stage stage;
    stage.first           = load_scene(options.scene);
    stage.scene           = scene_at(stage.first, options.at.frame);
    const glm::ivec2 size = options.size.empty() ? glm::ivec2(0) : size_option(options.size);
    stage.view            = view_at(stage.scene, options.view, size, options.at);
    if (!common.quiet)
        for (const std::string& warning : stage.scene.warnings)
            std::fprintf(stderr, "warning: %s\n", printable(warning).c_str());
    stage.gpu = open_gpu(common.gpu);
    if (!stage.scene.frame) stage.uploaded = upload_scene(stage.gpu, stage.scene);
    stage.gbuffer = stage.scene.frame
                        ? upload_gbuffer(stage.gpu, stage.scene.frame->gbuffer)
                        : render_gbuffer(stage.gpu, stage.uploaded, stage.view,
                                         motion_at(stage.scene, options.view, stage.view.size_px, options.at.frame));
    return stage;
}

void show_frame(Stage& stage, const std::string& view, SequenceFrame at, glm::dvec2 offset_px)
{
    if (anything_moves(stage.first)) {
        stage.scene = scene_at(stage.first, at.frame);
        move_scene(stage.gpu, *stage.uploaded, stage.scene);
    }
    stage.view = view_at(stage.scene, view, stage.view.size_px, at);
    stage.view.centre_px += offset_px;
    stage.gbuffer = render_gbuffer(stage.gpu, stage.uploaded, stage.view,
                                   motion_at(stage.scene, view, stage.view.size_px, at.frame));
}

void set_choice(const Technique& technique, Choice& choice, const std::string& pair)
{
    const auto equals = pair.find('=');
    if (equals == std::string::npos) throw_spec_error("-p {}: expected name=value", pair);
    const std::string name = pair.substr(0, equals), text = pair.substr(equals + 1), place = "-p " + pair;
    const auto        setting = std::ranges::find(all_settings(), name, &Setting::name);
    if (setting == all_settings().end())
        choice.values[name] = parse_parameter(find_parameter(technique, name, place), text, place);
    else
        setting->set(choice.settings, parse_parameter(*setting, text, place));
}

Choice parse_choice(const Technique& technique, const std::vector<std::string>& pairs)
{
    Choice choice{default_values(technique), {}};
    for (const std::string& pair : pairs) set_choice(technique, choice, pair);
    return choice;
}

namespace {

bool belongs_to(const Technique& technique, const std::string& pair)
{
    const std::string name = pair.substr(0, pair.find('='));
    return std::ranges::find(all_settings(), name, &Setting::name) != all_settings().end() ||
           std::ranges::find(technique.parameters, name, &Parameter::name) != technique.parameters.end();
}

} // namespace

std::vector<Choice> parse_choices(const std::vector<const Technique*>& techniques,
                                  const std::vector<std::string>&      pairs)
{
    std::vector<Choice> choices;
    for (const Technique* technique : techniques) {
        std::vector<std::string> own;
        for (const std::string& pair : pairs) {
            const bool of_any =
                std::ranges::any_of(techniques, [&](const Technique* other) { return belongs_to(*other, pair); });
            if (!of_any || belongs_to(*technique, pair)) own.push_back(pair);
        }
        choices.push_back(parse_choice(*technique, own));
    }
    return choices;
}

int report_messages(const Stage& stage)
{
    const auto messages = validation_messages(stage.gpu);
    for (const std::string& message : messages) std::fprintf(stderr, "validation: %s\n", message.c_str());
    return messages.empty() ? 0 : 1;
}

} // namespace ssrlab
