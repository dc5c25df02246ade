// G-buffers that include surfaces facing away from the camera. For the folders frame/ and sources/.
#pragma once

#include "frame/drawing.h"

namespace ssrlab {

/// Returns the next layer behind one, of either side; a back face shows its lit outer side. `before` must outlive it.
DrawingPtr make_next_side(Gpu& gpu, const Drawing& before);

struct DrawnSides {
    GBufferPtr gbuffer;
    double     ms = 0;
};

/// Draws the nearest surfaces of either side that lie behind a depth in each pixel; where that is 0 there are none.
/// `pipeline`: empty, or from an earlier call with the same scene.
DrawnSides draw_sides_behind(Gpu& gpu, const GpuScenePtr& scene, const View& view, std::span<const float> depth,
                             std::shared_ptr<const DrawPipeline>& pipeline);

} // namespace ssrlab
