// The origin of a results folder.
#pragma once

#include "gpu/gpu.h"
#include "harness/experiment.h"
#include "harness/result_folder.h"

namespace ssrlab {

/// Returns what times depend on: device, driver, how passes and storage are laid out; of a software device also the
/// processor and its threads.
std::map<std::string, std::string> describe_device(const GpuInfo& device);
/// Returns hashes of a technique's folder and of those of its structures.
std::map<std::string, std::string> describe_technique(const Technique& technique);

/// Returns current hashes of specification, program, shaders, techniques and scene files, and device and threads.
std::map<std::string, std::string> describe_identity(const Experiment&          experiment,
                                                     std::span<const Technique> techniques, const GpuInfo& device);

/// Returns the identity and everything else that environment.json records.
Environment describe_environment(const Experiment& experiment, std::span<const Technique> techniques,
                                 const GpuInfo& device, const std::string& command_line);

} // namespace ssrlab
