// Unknown names are answered with the known one that was probably meant.
#pragma once

#include <span>
#include <string>

namespace ssrlab {

/// "unknown technique 'lineer': did you mean 'linear'? (known: dda, hiz, linear)"
std::string unknown_name(const std::string& kind, const std::string& name, std::span<const std::string> known);

/// A name that GLSL accepts for a constant: letters, digits, underscores; no keyword, no gl_ prefix, no double underscore.
bool is_glsl_name(const std::string& name);

} // namespace ssrlab
