// One picture from the command line: scene, view, device, and name=value pairs.
#pragma once

#include "app/commands.h"
#include "scene/scene.h"

namespace ssrlab {

/// The scene's picture of one view on the device.
struct Stage {
    Scene       first; // the scene in frame 0
    Scene       scene;
    View        view;
    Gpu         gpu;
    GpuScenePtr uploaded;
    GBufferPtr  gbuffer;
};
Stage prepare_stage(const CommonOptions& common, const PictureOptions& options);
/// The same view in another frame of the sequence, moved by an offset of at most a pixel.
void show_frame(Stage& stage, const std::string& view, SequenceFrame at, glm::dvec2 offset_px = {0, 0});
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
Choice parse_choice(const Technique& technique, const std::vector<std::string>& pairs);
/// The same of several techniques, where each takes the parameters that it has. Throws SpecError for what none has.
std::vector<Choice> parse_choices(const std::vector<const Technique*>& techniques,
                                  const std::vector<std::string>&      pairs);
/// One more pair.
void set_choice(const Technique& technique, Choice& choice, const std::string& pair);

} // namespace ssrlab
