// One picture from the command line: scene, view, device, and name=value pairs.
#pragma once

#include "frame/stage.h"

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct CommonOptions {
    GpuOptions                         gpu;
    bool                               quiet = false; // no warnings, no progress
    std::vector<std::filesystem::path> technique_dirs;
};

struct PictureOptions {
    std::string              scene, technique, view = "default", size, output;
    std::vector<std::string> parameters; // name=value: the technique's parameters, or settings of [trace] and [passes]
    SequenceFrame            at;
};

/// The picture that the options name, on the device that they name. Throws SpecError for what they get wrong.
Stage open_stage(const CommonOptions& common, const Catalogue& catalogue, const PictureOptions& options);
/// Prints the validation layer's messages; 1 when there are any.
int report_messages(const Stage& stage);

/// Throws SpecError when the output has another ending: before the work, not after it.
void require_ending(const std::string& output, const std::vector<std::string>& endings);

/// The value of --size; throws SpecError.
glm::ivec2 size_option(const std::string& text);

struct Choice {
    ParameterValues values;
    FrameSettings   settings;
};
/// name=value pairs: settings of [trace] and [passes], or else parameters of the technique. Throws SpecError.
Choice parse_choice(const Catalogue& catalogue, const Technique& technique, const std::vector<std::string>& pairs);
/// The same of several techniques, where each takes the parameters that it has. Throws SpecError for what none has.
std::vector<Choice> parse_choices(const Catalogue& catalogue, const std::vector<const Technique*>& techniques,
                                  const std::vector<std::string>& pairs);
/// One more pair.
void set_choice(const Catalogue& catalogue, const Technique& technique, Choice& choice, const std::string& pair);

} // namespace ssrlab
