// A frame from the command line: scene, view, device, and name=value pairs.
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
    std::vector<std::string> parameters; // name=value: parameters of the technique, or settings
    SequenceFrame            at;
};

/// Prints a line on stderr, unless it is empty or --quiet.
void say(const CommonOptions& common, const std::string& text);
/// Prints the warnings of loading a scene likewise.
void say_warnings(const CommonOptions& common, const Scene& scene);

/// Returns what follows where a frame file lacks a channel that the surface model reads; else "".
std::string lacked_channel_text(const Scene& scene, const Catalogue& catalogue, const TraceSettings& settings);

/// Opens the stage for the frame and device that the options name. Throws SpecError for wrong options.
Stage open_stage(const CommonOptions& common, const Catalogue& catalogue, const PictureOptions& options);
/// Prints the validation layer's messages; returns 1 if there are any, else 0.
int report_messages(const Stage& stage);

/// Throws SpecError if the output has another ending, Failure if its folder cannot be written. Call it before the work.
void require_output(const std::string& output, const std::vector<std::string>& endings);

/// Returns the value of --size in pixels; throws SpecError.
glm::ivec2 size_option(const std::string& text);

struct Choice {
    ParameterValues values;
    FrameSettings   settings;
};
/// Reads name=value pairs: settings of [trace] and [passes], or parameters of the technique. Throws SpecError.
Choice parse_choice(const Catalogue& catalogue, const Technique& technique, const std::vector<std::string>& pairs);
/// The same for several techniques: each takes the parameters that it has. Throws SpecError for a name that none has.
std::vector<Choice> parse_choices(const Catalogue& catalogue, const std::vector<const Technique*>& techniques,
                                  const std::vector<std::string>& pairs);
/// Returns whether a pair names a setting, or a parameter of the technique.
bool takes(const Catalogue& catalogue, const Technique& technique, const std::string& pair);
/// Adds one pair. Throws SpecError.
void set_choice(const Catalogue& catalogue, const Technique& technique, Choice& choice, const std::string& pair);

} // namespace ssrlab
