#include "harness/choice.h"

#include "core/error.h"
#include "core/printable.h"
#include "core/size.h"
#include "harness/bake_scene.h"
#include "harness/experiment.h"

#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <set>

namespace ssrlab {

void require_output(const std::string& output, const std::vector<std::string>& endings)
{
    const std::string ending = std::filesystem::path(output).extension().string();
    if (std::ranges::find(endings, ending) == endings.end())
        throw_spec_error("-o {}: expected a file that ends in {}", output, fmt::join(endings, " or "));
    const std::filesystem::path folder = std::filesystem::path(output).parent_path();
    if (::access((folder / ".").c_str(), W_OK) != 0)
        throw_failure("-o {}: its folder cannot be written: {}", output, std::strerror(errno));
}

glm::ivec2 size_option(const std::string& text)
{
    const std::optional<glm::ivec2> size_px = parse_size(text);
    if (!size_px || size_px->x < 1 || size_px->y < 1)
        throw_spec_error("--size: expected WIDTHxHEIGHT, both at least 1, got '{}'", text);
    return *size_px;
}

void say(const CommonOptions& common, const std::string& text)
{
    if (!common.quiet && !text.empty()) std::fprintf(stderr, "%s\n", printable(text).c_str());
}

void say_warnings(const CommonOptions& common, const Scene& scene)
{
    for (const std::string& warning : scene.warnings) say(common, "warning: " + warning);
}

std::string lacked_channel_text(const Scene& scene, const Catalogue& catalogue, const TraceSettings& settings)
{
    const Surface&    surface = find_surface(catalogue.surfaces, settings.surface);
    const std::string channel = lacked_channel(scene, surface);
    if (channel.empty()) return "";
    return fmt::format("warning: {}: no channel {}: surface = {} takes every surface of this frame as thin", scene.name,
                       channel, surface.id);
}

Stage open_stage(const CommonOptions& common, const Catalogue& catalogue, const PictureOptions& options)
{
    Scene            scene   = load_scene(options.scene);
    const glm::ivec2 size_px = options.size.empty() ? glm::ivec2(0) : size_option(options.size);
    view_at(scene, options.view, size_px, options.at); // wrong options are refused before the device is opened
    say_warnings(common, scene);
    const Gpu gpu = open_gpu(common.gpu);
    bake_scene(scene, [&](const std::string& text) { say(common, text); });
    Stage stage = open_stage(gpu, catalogue, std::move(scene));
    show(stage, options.view, size_px, options.at);
    return stage;
}

void set_choice(const Catalogue& catalogue, const Technique& technique, Choice& choice, const std::string& pair)
{
    const auto equals = pair.find('=');
    if (equals == std::string::npos) throw_spec_error("-p {}: expected name=value", pair);
    const std::string          name = pair.substr(0, equals), text = pair.substr(equals + 1), place = "-p " + pair;
    const std::vector<Setting> settings = all_settings(catalogue);
    const auto                 setting  = std::ranges::find(settings, name, &Setting::name);
    if (setting == settings.end())
        choice.values[name] = parse_parameter(find_parameter(technique, name, place, names_of(settings)), text, place);
    else
        setting->set(choice.settings, parse_parameter(*setting, text, place));
}

Choice parse_choice(const Catalogue& catalogue, const Technique& technique, const std::vector<std::string>& pairs)
{
    Choice                choice{default_values(technique), {}};
    std::set<std::string> given;
    for (const std::string& pair : pairs) {
        set_choice(catalogue, technique, choice, pair);
        if (const std::string name = pair.substr(0, pair.find('=')); !given.insert(name).second)
            throw_spec_error("-p {}: '{}' is given twice", pair, name);
    }
    return choice;
}

bool takes(const Catalogue& catalogue, const Technique& technique, const std::string& pair)
{
    const std::string          name     = pair.substr(0, pair.find('='));
    const std::vector<Setting> settings = all_settings(catalogue);
    return std::ranges::find(settings, name, &Setting::name) != settings.end() ||
           std::ranges::find(technique.parameters, name, &Parameter::name) != technique.parameters.end();
}

std::vector<Choice> parse_choices(const Catalogue& catalogue, const std::vector<const Technique*>& techniques,
                                  const std::vector<std::string>& pairs)
{
    std::vector<Choice> choices;
    for (const Technique* technique : techniques) {
        std::vector<std::string> own;
        for (const std::string& pair : pairs) {
            const bool of_any =
                std::ranges::any_of(techniques, [&](const Technique* other) { return takes(catalogue, *other, pair); });
            if (!of_any || takes(catalogue, *technique, pair)) own.push_back(pair);
        }
        choices.push_back(parse_choice(catalogue, *technique, own));
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
