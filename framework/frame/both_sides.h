// Layers behind a G-buffer that include surfaces facing away from the camera. For the folders frame/ and sources/.
#pragma once

#include "frame/drawing.h"

namespace ssrlab {

/// Returns the next layer behind one, of either side; a back face shows its lit outer side. `before` must outlive it.
DrawingPtr make_next_side(Gpu& gpu, const Drawing& before);

} // namespace ssrlab
