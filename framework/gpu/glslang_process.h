// glslang's own state, which lives as long as the program, and what it compiles for.
#pragma once

#include <glslang/Public/ShaderLang.h>

namespace ssrlab {

/// Call it before anything else of glslang.
inline void start_glslang()
{
    struct Process {
        Process() { glslang::InitializeProcess(); }
        ~Process() { glslang::FinalizeProcess(); }
    };
    static const Process process;
}

/// Vulkan 1.3 and SPIR-V 1.6, for every shader.
inline void target_vulkan(glslang::TShader& shader, glslang::EShSource language, EShLanguage stage)
{
    shader.setEnvInput(language, stage, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
}

} // namespace ssrlab
