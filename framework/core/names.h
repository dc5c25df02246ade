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

/// Whether GLSL accepts the name: letters, digits, underscores; no keyword, gl_ prefix or "__".
bool is_glsl_name(const std::string& name);

} // namespace ssrlab
