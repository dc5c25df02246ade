// What the compiler of a driver made of a compute pipeline, on a device opened in compile-only mode.
#pragma once

#include "gpu/gpu.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

struct CompiledPipeline {
    std::string                     shader;     // its file
    uint32_t                        group = 0;  // invocations of a workgroup
    uint32_t                        lanes = 0;  // that run in lockstep
    std::map<std::string, uint64_t> statistics; // by the driver's names, such as "VGPRs"
    std::string                     assembly;   // empty: the driver does not show it
};

/// Returns the AMD GPUs that Mesa's compiler knows.
std::vector<std::string> known_chips();
/// Makes the Vulkan loader find only Mesa's driver for this chip, without hardware. Call it before opening a device.
/// Throws SpecError for an unknown chip, Failure if the driver is not installed.
void pretend_chip(const std::string& chip);

/// Equal pipelines have equal pointers.
using CompiledPtr = std::shared_ptr<const CompiledPipeline>;
/// Returns every pipeline that passes asked for since the last call, in that order, once each.
std::vector<CompiledPtr> take_compiled(Gpu& gpu);

/// A loop of a program, from its first to its last line.
struct LoopCode {
    int instructions = 0;
    int loads        = 0; // of buffers and images
};
/// Returns the longest loop that contains no other loop; all 0 without loops. Reads the assembly of AMD GPUs: "BB3:"
/// begins a block, and a branch back to it ends a loop.
LoopCode innermost_loop(std::string_view assembly);

} // namespace ssrlab
