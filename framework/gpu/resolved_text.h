// A shader as one text: its includes in their place, and of each #if the branch that is taken.
#pragma once

#include "gpu/shader.h"

namespace ssrlab {

/// Returns the text that compile_shader() would compile: first its defines as lines of #define, then its files with
/// their comments and macros. glslang decides which branches are taken. Throws SpecError as compile_shader() for what
/// the preprocessor refuses.
std::string resolved_text(const Gpu& gpu, ShaderSource source);

} // namespace ssrlab
