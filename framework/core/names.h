// Error messages for unknown names suggest the nearest known one.
#pragma once

#include <span>
#include <string>

namespace ssrlab {

/// "unknown technique 'lineer': did you mean 'linear'? (known: dda, hiz, linear)"
std::string unknown_name(const std::string& kind, const std::string& name, std::span<const std::string> known);

/// Whether GLSL accepts the name: letters, digits, underscores; no keyword, gl_ prefix or "__".
bool is_glsl_name(const std::string& name);

} // namespace ssrlab
