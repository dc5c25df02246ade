// What the recordings of the effects share. Folder-internal.
#pragma once

#include "render/frame_passes.h"

namespace ssrlab {

/// The shader with every parameter of the effects; `more` comes before what the frame binds to the same names.
ComputePass make_effect_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader,
                             const Defines& defines = {}, const Bindings& more = {}, uint32_t push_constant_bytes = 0);
/// One that includes effects/ray_colour.glsl. Throws SpecError when the light that is asked for needs a scene and there is none.
ComputePass make_colour_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, Defines defines = {},
                             Bindings more = {});
void        record_copy(const vk::raii::CommandBuffer& commands, const GpuImage& source, const GpuImage& target);

/// One of two lists that all frames with as many rays share.
std::shared_ptr<DerivedRays> derived_rays(Gpu& gpu, const PreparedFrame& frame, int which);
/// The list as shaders that fill it name it.
Bindings derived_bindings(const DerivedRays& derived);

Recording hidden_layer(Gpu& gpu, PreparedFrame& frame);
Recording bounces(Gpu& gpu, PreparedFrame& frame);
Recording cone_pyramid(Gpu& gpu, PreparedFrame& frame);

} // namespace ssrlab
