// Helpers that several passes share. Folder-internal.
#pragma once

#include "frame/frame_inputs.h"

#include <fmt/format.h>

namespace ssrlab {

// Declarations of parameters.
Parameter boolean_parameter(const char* name, bool fallback, const char* doc);
Parameter integer_parameter(const char* name, double fallback, double min, double max, const char* doc);
Parameter real_parameter(const char* name, double fallback, double min, double max, const char* doc);
Parameter choice_parameter(ChoiceNames names, double fallback, const char* doc);
template <typename Enum> Parameter choice_parameter(Enum fallback, const char* doc)
{
    return choice_parameter(choice_names(fallback), choice_value(fallback), doc);
}

// Decisions.
PassDecision needed_if_anything_reflects(const FrameFacts& facts, const FrameStatistics& statistics,
                                         const ParameterValues& values);
PassDecision needed_if_anything_is_rough(const FrameStatistics& statistics);
PassDecision needed_at_lower_resolution(const FrameFacts& facts, const FrameStatistics& statistics,
                                        const ParameterValues& values);
/// Needed if the frame follows another one and something changed since.
PassDecision needed_after_a_frame(const FrameFacts& facts);
/// Needed if the history of the reflection is on, too, and something reflects.
PassDecision needed_for_history(const FrameFacts& facts, const FrameStatistics& statistics,
                                const ParameterValues& values);
/// Returns whether bounce_mode = history finds the frame before in a history.
bool takes_bounces_from_history(const FrameFacts& facts, const ParameterValues& values);
/// Returns whether each pixel has one ray, as passes that continue rays need.
bool one_ray_per_pixel(const ParameterValues& values);

// Resources. Each function throws std::logic_error for what the pass does not declare.
/// Returns the images and buffers of a resource, by their names in shaders.
Bindings bindings_of(Gpu& gpu, const PassContext& context, Resource resource);
/// Returns an image that the pass fills or copies: reflection, filtered, block_pixel or shaded.
const GpuImage& image_of(const PassContext& context, Resource resource);
/// Returns whether hits may lie in the second layer that the pass hidden_layer draws.
bool hits_hidden_layer(const FrameInputs& frame);
/// Returns the number of layers in which hits may lie.
int layers_of_hits(const FrameInputs& frame);
/// Returns dispatch arguments for the tiles that reflect.
const Buffer& tile_launch(const PassContext& context);
/// Returns dispatch arguments for the frame's rays.
const Buffer& ray_launch(const PassContext& context);

/// Returns the images of the frame's lobe rays, made when first asked for. Throws SpecError if they would be too high.
const LobeRayImages& lobe_ray_images(Gpu& gpu, const PassContext& context);

// Pipelines.
/// Compiles a shader with the parameters of all passes. `more` is bound before the resources that the pass
/// declares.
ComputePass make_pass(Gpu& gpu, const PassContext& context, const std::string& shader, const Defines& defines = {},
                      const Bindings& more = {}, uint32_t push_constant_bytes = 0);
/// Compiles a shader composed of several files likewise, with the parameters of a reprojection strategy.
ComputePass make_composed_pass(Gpu& gpu, const PassContext& context, ShaderSource source, const Bindings& more,
                               std::span<const Parameter> own = {}, uint32_t push_constant_bytes = 0);
/// Compiles likewise, for a record function to keep.
std::shared_ptr<ComputePass> make_shared_pass(Gpu& gpu, const PassContext& context, const std::string& shader,
                                              const Defines& defines = {});
/// Compiles a shader that includes passes/ray_colour.glsl.
ComputePass make_colour_pass(Gpu& gpu, const PassContext& context, const std::string& shader, Defines defines = {},
                             Bindings more = {});

/// Adds what passes/environment_lobe.glsl needs, if the frame falls back on an environment.
void add_environment(Gpu& gpu, const PassContext& context, Defines& defines, Bindings& bindings);

// Commands.
void record_copy(const Commands& commands, const GpuImage& source, const GpuImage& target);
/// Returns a function that writes one value, given as bits, to every pixel of an RGBA16F, RGBA32F or R32UI image, and
/// waits. It is a compute pass, because clear commands may run on graphics units, of which compute devices have few.
RecordFunction make_fill(Gpu& gpu, const GpuImage& image, glm::uvec4 bits);
/// Returns a function that marks every pixel as one without a ray.
RecordFunction make_reflection_fill(Gpu& gpu, const GpuImage& reflection);

/// Returns one of the two lists (0 or 1) that all frames with the same number of rays share.
std::shared_ptr<DerivedRays> derived_rays(Gpu& gpu, const PassContext& context, int which);
/// Returns the list by the names under which shaders fill it.
Bindings derived_bindings(const DerivedRays& derived);

} // namespace ssrlab
