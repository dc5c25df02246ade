// What a results folder came from.
#pragma once

#include "gpu/gpu.h"
#include "harness/experiment.h"
#include "harness/record.h"

namespace ssrlab {

/// Identity: hashes of specification, shaders, techniques and scene files, and the device. Notes: all that a reader may ask.
Environment describe_environment(const Experiment& experiment, std::span<const Technique> techniques,
                                 const GpuInfo& device, const std::string& command_line);

} // namespace ssrlab
