// The time of commands that run by themselves.
#pragma once

#include "gpu/vulkan.h"

#include <functional>

namespace ssrlab {

/// Runs what `record` records twice, since a driver may compile a pipeline when it first runs. Returns the milliseconds
/// of the second run. Throws Failure if the device has no timestamps.
double time_second_run_ms(Gpu& gpu, const std::function<void(const Commands&)>& record);

} // namespace ssrlab
