// From SPIR-V to other shading languages, by spirv-opt and spirv-cross and, for WGSL, naga. Folder-internal.
#pragma once

#include "export/export.h"
#include "gpu/shader.h"

#include <map>

namespace ssrlab {

/// The shader in that language, behind a comment, with its names and binding numbers. Throws Failure where the
/// translator is missing or cannot translate the shader.
std::string translated(const Shader& shader, ExportLanguage language, const std::string& comment,
                       Translations& translations);

/// The registers that HLSL declares, each by its number: "t10" of 10.
std::map<uint32_t, std::string> hlsl_registers(const std::string& hlsl);

} // namespace ssrlab
