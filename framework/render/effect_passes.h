// What the recordings of the effects share. Folder-internal.
#pragma once

#include "render/frame_passes.h"

namespace ssrlab {

/// The shader with every parameter of the effects; `more` comes before what the frame binds to the same names.
ComputePass make_effect_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, const Bindings& more = {},
                             const std::map<std::string, std::string>& defines = {});

/// One of two lists that all frames with as many rays share.
std::shared_ptr<DerivedRays> derived_rays(Gpu& gpu, const PreparedFrame& frame, int which);
/// The list as shaders that fill it name it.
Bindings derived_bindings(const DerivedRays& derived);

Recording hidden_layer(Gpu& gpu, PreparedFrame& frame);
Recording bounces(Gpu& gpu, PreparedFrame& frame);

} // namespace ssrlab
