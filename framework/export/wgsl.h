// Exported GLSL and WGSL without what WGSL or its translator lacks. Folder-internal.
#pragma once

#include "gpu/shader.h"

#include <filesystem>
#include <functional>
#include <string>

namespace ssrlab {

/// Returns the GLSL of an exported pass with one block for each resource, because WebGPU binds no buffer twice in a
/// dispatch that writes it, and without isinf(), isnan() and bit searches in unsigned numbers, which the translator
/// lacks. `resource_of` returns the resource behind a block's name.
std::string glsl_for_wgsl(const std::string& glsl, const std::function<std::string(const std::string&)>& resource_of);

/// Returns the WGSL with the buffers that the GLSL only reads declared `read`: the translator declares all of them
/// `read_write`.
std::string with_read_access(std::string wgsl, const std::string& glsl, const Shader& shader);

/// Returns the folder of the scripts for WGSL, where npm also puts the packages that they need.
std::filesystem::path web_folder();

} // namespace ssrlab
