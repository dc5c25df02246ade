// What a results folder came from.
#pragma once

#include "gpu/gpu.h"
#include "harness/experiment.h"
#include "harness/result_folder.h"

namespace ssrlab {

/// Hashes of specification, program, shaders, techniques and scene files, as they are now, and the device with its threads.
std::map<std::string, std::string> describe_identity(const Experiment&          experiment,
                                                     std::span<const Technique> techniques, const GpuInfo& device);

/// The identity and all else that a reader may ask.
Environment describe_environment(const Experiment& experiment, std::span<const Technique> techniques,
                                 const GpuInfo& device, const std::string& command_line);

} // namespace ssrlab
