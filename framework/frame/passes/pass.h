// A pass: one step of a frame, run only if the frame needs it. Each has a file of its own in this folder.
#pragma once

#include "frame/passes/choices.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vk::raii {
class CommandBuffer;
}

namespace ssrlab {

struct FrameFacts;
struct FrameStatistics;
struct Gpu;
struct PreparedFrame;

/// Whether a frame needs a pass, and the reason with the number that decided.
struct PassDecision {
    enum Verdict : uint8_t { off, not_needed, needed };
    Verdict     verdict = needed;
    std::string reason;
};

/// Writes a pass's commands.
using RecordFunction = std::function<void(const vk::raii::CommandBuffer&)>;

/// Skipping a pass that is not needed leaves every bit of the image as it is.
struct Pass {
    std::string              id, summary;
    std::vector<std::string> cite       = {};
    std::vector<Parameter>   parameters = {};
    PassDecision (*decide)(const FrameFacts&, const FrameStatistics&, const ParameterValues&);
    /// Makes the pass's pipelines. The record function refers to the frame, which must outlive it.
    RecordFunction (*prepare)(Gpu&, PreparedFrame&) = nullptr;
    bool beyond_shading                             = false; // off with pass_set = shading
    /// In the place of prepare: runs once for each structure of the technique, under that structure's id.
    RecordFunction (*prepare_structure)(PreparedFrame&, const std::string& structure) = nullptr;
};

Pass layers_pass();
Pass solid_backs_pass();
Pass classification_pass();
Pass rays_pass();
Pass structures_pass();
Pass trace_pass();
Pass hidden_layer_pass();
Pass reprojection_pass();
Pass colour_downsampling_pass();
Pass cone_pyramid_pass();
Pass hit_colour_pass();
Pass bounces_pass();
Pass ray_blur_pass();
Pass upsampling_pass();
Pass ray_reuse_pass();
Pass filter_3x3_pass();
Pass blur_pass();
Pass environment_pass();
Pass history_pass();
Pass composite_pass();

/// In the order of a frame.
std::span<const Pass> all_passes();
/// The parameters of all passes, after those of the plan itself. Names are unique.
std::span<const Parameter> pass_parameters();
/// Those and the parameters of reprojection strategies, named "strategy.parameter".
std::vector<Parameter> all_pass_settings();
ParameterValues        default_pass_values();

} // namespace ssrlab
