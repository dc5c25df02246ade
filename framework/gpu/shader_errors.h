// Errors of the GLSL compiler in terms of the files that a user wrote.
#pragma once

#include "gpu/shader.h"

namespace ssrlab {

/// One line for each error of a compiler's log: "path:12: 'x' : undeclared identifier". The log itself if it names none.
std::string shader_errors_in(const std::string& log, const ShaderSource& source);

} // namespace ssrlab
