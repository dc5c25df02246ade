// What WGSL lacks, as GLSL without it. Folder-internal.
#pragma once

#include "gpu/shader.h"

#include <filesystem>
#include <functional>
#include <string>

namespace ssrlab {

/// The GLSL of an exported pass with one block for each resource, because WebGPU binds no buffer twice in a dispatch that
/// writes it, and without isinf(), isnan() and bit searches in unsigned numbers, which the translator lacks.
/// resource_of: the resource behind a block's name.
std::string glsl_for_wgsl(const std::string& glsl, const std::function<std::string(const std::string&)>& resource_of);

/// WGSL in which the buffers that the GLSL only reads are `read`: the translator declares all of them `read_write`.
std::string with_read_access(std::string wgsl, const std::string& glsl, const Shader& shader);

/// The scripts for WGSL, and where npm puts the packages that they need.
std::filesystem::path web_folder();

} // namespace ssrlab
