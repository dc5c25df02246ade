// What one has to read to understand a technique.
#pragma once

#include "gpu/shader_files.h"
#include "trace/lab.h"

namespace ssrlab {

/// As the compiler reads it for this device, timed, not counted.
struct TechniqueFiles {
    std::vector<ShaderFile> technique; // its trace, and all structures that it reads
    std::vector<ShaderFile> ray_setup; // what the ray set-up adds, which is the same for all techniques
};
TechniqueFiles technique_files(Gpu& gpu, const LabPtr& lab);

} // namespace ssrlab
