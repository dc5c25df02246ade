// glslang's own state, which lives as long as the program.
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

} // namespace ssrlab
