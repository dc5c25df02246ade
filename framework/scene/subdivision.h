// Smaller triangles, for light that vertices keep.
#pragma once

#include "scene/model.h"

namespace ssrlab {

/// Halves every edge that is longer than Bake::edge_m until none is. Only its ends decide how an edge is divided, so
/// triangles that share it have no crack between them, of different meshes, too. Meshes that joints bend stay as they
/// are. Throws SpecError for more than 4 million triangles.
void subdivide(Model& model, const Bake& bake);

} // namespace ssrlab
