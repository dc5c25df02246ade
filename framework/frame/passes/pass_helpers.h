// What several passes share. Folder-internal.
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
/// Where the frame follows another one and something changed since.
PassDecision needed_for_history(const FrameFacts& facts, const FrameStatistics& statistics,
                                const ParameterValues& values);
/// Whether bounce_mode = history finds the frame before in a history.
bool takes_bounces_from_history(const FrameFacts& facts, const ParameterValues& values);
/// Passes that continue the rays one by one need this.
bool one_ray_per_pixel(const ParameterValues& values);

// Resources. Each throws std::logic_error for what the pass does not declare.
/// By the names that shaders give them.
Bindings bindings_of(Gpu& gpu, const PassContext& context, Resource resource);
/// An image that the pass clears or copies: reflection, filtered, block_pixel.
const GpuImage& image_of(const PassContext& context, Resource resource);
/// Whether hits may lie in the second layer that the pass hidden_layer draws.
bool hits_hidden_layer(const FrameInputs& frame);
/// In how many layers hits may lie.
int layers_of_hits(const FrameInputs& frame);
/// For a dispatch over the tiles that reflect.
const Buffer& tile_launch(const PassContext& context);
/// For a dispatch over the frame's rays.
const Buffer& ray_launch(const PassContext& context);

// Pipelines.
/// A shader with the parameters of all passes. `more` is bound before what the pass
/// declares.
ComputePass make_pass(Gpu& gpu, const PassContext& context, const std::string& shader, const Defines& defines = {},
                      const Bindings& more = {}, uint32_t push_constant_bytes = 0);
/// The same of a shader that is composed of several files, with the parameters of a reprojection strategy.
ComputePass make_composed_pass(Gpu& gpu, const PassContext& context, ShaderSource source, const Bindings& more,
                               std::span<const Parameter> own = {}, uint32_t push_constant_bytes = 0);
/// The same, to be kept by a record function.
std::shared_ptr<ComputePass> make_shared_pass(Gpu& gpu, const PassContext& context, const std::string& shader,
                                              const Defines& defines = {});
/// A shader that includes passes/ray_colour.glsl.
ComputePass make_colour_pass(Gpu& gpu, const PassContext& context, const std::string& shader, Defines defines = {},
                             Bindings more = {});

/// For a shader that looks up the environment (passes/environment_lobe.glsl), if the frame has one and falls back on it.
void add_environment(Gpu& gpu, const PassContext& context, Defines& defines, Bindings& bindings);

// Commands.
void record_copy(const vk::raii::CommandBuffer& commands, const GpuImage& source, const GpuImage& target);
void record_clear(const vk::raii::CommandBuffer& commands, const GpuImage& image, vk::ClearColorValue value);
/// Every pixel: no ray started here.
void record_clear_reflection(const vk::raii::CommandBuffer& commands, const GpuImage& reflection);

/// One of two ray lists that all frames with the same number of rays share.
std::shared_ptr<DerivedRays> derived_rays(Gpu& gpu, const PassContext& context, int which);
/// The list under the names by which shaders fill it.
Bindings derived_bindings(const DerivedRays& derived);

} // namespace ssrlab
