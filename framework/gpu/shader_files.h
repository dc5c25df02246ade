// What the compiler reads of a shader.
#pragma once

#include "gpu/shader.h"

namespace ssrlab {

/// A file or a generated text that the compiler read.
struct ShaderFile {
    std::string name;
    int         code_lines = 0; // without comments and empty lines
};

/// Returns what the compiler reads of a shader for this device: its file, then all that it includes, each once. Throws
/// as compile_shader() does.
std::vector<ShaderFile> shader_files(const Gpu& gpu, ShaderSource source);

} // namespace ssrlab
