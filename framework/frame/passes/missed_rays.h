// The pass `missed_rays`, for the plan that counts what it would find.
#pragma once

#include "frame/frame_inputs.h"

namespace ssrlab {

/// Returns whether the settings ask for the pass. Then the scene's triangles are needed on the device.
bool asks_triangles(const ParameterValues& values);

/// Follows the missed rays of a traced frame as the pass does, and returns how many it followed and how many of them
/// met a triangle. Needs the scene's triangles on the device. Makes FrameInputs::answers.
MissCounts count_followed_rays(Gpu& gpu, FrameInputs& frame);

} // namespace ssrlab
