// Exported GLSL and WGSL without what WGSL or its translator lacks. Folder-internal.
#pragma once

#include "gpu/shader.h"

#include <filesystem>
#include <string>

namespace ssrlab {

/// Returns the GLSL of an exported pass without isinf(), isnan() and bit searches in unsigned numbers, which the
/// translator lacks.
std::string glsl_for_wgsl(const std::string& glsl);

/// Returns the WGSL with the buffers that the GLSL only reads declared `read`: the translator declares all of them
/// `read_write`.
std::string with_read_access(std::string wgsl, const std::string& glsl, const Shader& shader);

/// Returns the folder of the scripts for WGSL, where npm also puts the packages that they need.
std::filesystem::path web_folder();

} // namespace ssrlab
