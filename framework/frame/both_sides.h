// Layers behind a G-buffer of surfaces that face away from the camera, too. Folder-internal, and for sources/.
#pragma once

#include "frame/drawing.h"

namespace ssrlab {

/// The next layer behind one, of either side: a back face shows its outer side, lit there. `before` must outlive it.
DrawingPtr make_next_side(Gpu& gpu, const Drawing& before);

} // namespace ssrlab
