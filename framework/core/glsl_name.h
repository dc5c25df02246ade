// Names that shaders can have.
#pragma once

#include <string>

namespace ssrlab {

/// Why shaders cannot have the name: "expected letters, digits and underscores", "it is a word of GLSL". Empty if they
/// can.
std::string glsl_name_fault(const std::string& name);

} // namespace ssrlab
