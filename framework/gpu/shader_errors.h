// Errors of the GLSL compiler in terms of the user's files.
#pragma once

#include "gpu/shader.h"

namespace ssrlab {

/// Returns one line per error, "path:12: 'x' : undeclared identifier", or the log itself if it names none.
std::string shader_errors_in(const std::string& log, const ShaderSource& source);

} // namespace ssrlab
