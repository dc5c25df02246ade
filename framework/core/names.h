// Error messages for unknown names suggest the nearest known one.
#pragma once

#include <span>
#include <string>

namespace ssrlab {

/// ": did you mean 'linear'?"; empty if no known name is near.
std::string suggestion(const std::string& name, std::span<const std::string> known);

/// "unknown technique 'lineer': did you mean 'linear'? (known: dda, hiz, linear)". `also`: further names that fit.
std::string unknown_name(const std::string& kind, const std::string& name, std::span<const std::string> known,
                         std::span<const std::string> also = {});

/// Why shaders cannot have the name: "expected letters, digits and underscores", "it is a word of GLSL". Empty if they
/// can.
std::string glsl_name_fault(const std::string& name);

} // namespace ssrlab
