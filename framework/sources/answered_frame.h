// A picture that shows what sources answered: its rays are those of the frame, drawn from the lobe where surfaces are
// rough.
#pragma once

#include "sources/answer_rays.h"

namespace ssrlab {

/// Traces the frame, asks the sources about its rays, and shades it with their answers. Answers of the source `frame`,
/// and those that no source vouches for but "meets nothing", are left to the frame. `frame`: of the context's lab, with
/// Answers::given. Returns the times of the frame's own passes. Throws SpecError if the frame has a hidden layer, and
/// as sources do.
FrameTimes run_answered_frame(SourceContext& context, ReadyFrame& frame, std::span<const ListedSource> sources,
                              HandOn hand_on);

} // namespace ssrlab
