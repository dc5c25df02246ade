// The origin of a results folder.
#pragma once

#include "gpu/gpu.h"
#include "harness/experiment.h"
#include "harness/result_folder.h"

namespace ssrlab {

/// Returns current hashes of specification, program, shaders, techniques and scene files, and device and threads.
std::map<std::string, std::string> describe_identity(const Experiment&          experiment,
                                                     std::span<const Technique> techniques, const GpuInfo& device);

/// Returns the identity and everything else that environment.json records.
Environment describe_environment(const Experiment& experiment, std::span<const Technique> techniques,
                                 const GpuInfo& device, const std::string& command_line);

} // namespace ssrlab
