// What a driver's compiler made of a compute pipeline, on a device that is opened to compile only.
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

/// AMD GPUs that Mesa's compiler can be asked for.
std::vector<std::string> known_chips();
/// Lets the Vulkan loader find Mesa's driver for this chip alone, without hardware. Before a device is opened.
/// Throws SpecError for an unknown chip, Failure where the driver is not installed.
void pretend_chip(const std::string& chip);

/// The same pointer for the same pipeline.
using CompiledPtr = std::shared_ptr<const CompiledPipeline>;
/// Every pipeline that passes asked for since the last call, in that order, once each.
std::vector<CompiledPtr> take_compiled(Gpu& gpu);

/// A loop of a program: all from its first to its last line.
struct LoopCode {
    int instructions = 0;
    int loads        = 0; // of buffers and images
};
/// The longest loop that has no loop within; without loops, nothing. Reads the assembly of AMD GPUs: "BB3:" begins a block, and a
/// branch back to it ends a loop.
LoopCode innermost_loop(std::string_view assembly);

} // namespace ssrlab
