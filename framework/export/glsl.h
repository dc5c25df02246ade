// A composed pass as one readable GLSL file.
#pragma once

#include "gpu/compute.h"

#include <set>
#include <string>

namespace ssrlab {

/// Where the values lie that a pass gets by push constants inside the lab: an export has them in a uniform block.
inline constexpr uint32_t push_binding = 62;

/// Returns "#version 460 …": includes and macros resolved, constants with their values, buffers in std430, and nothing
/// that main() does not use. Throws SpecError as compile_shader().
/// Those named in `kept` stay specialization constants.
std::string export_glsl(const Gpu& gpu, const ShaderSource& source, const Constants& constants,
                        const std::set<std::string>& kept);

} // namespace ssrlab
