// Errors of the GLSL compiler in terms of the user's files.
#pragma once

#include "gpu/shader_files.h"

namespace ssrlab {

/// Returns the text with comments turned into blanks; lines stay lines.
std::string without_comments(std::string text);

/// Returns one line per error, "path:12: 'x' : undeclared identifier", or the log itself if it names none.
/// read: the files that the compiler had read; of others, the error says which one to include.
std::string shader_errors_in(const std::string& log, const ShaderSource& source, const std::vector<ShaderFile>& read);

} // namespace ssrlab
