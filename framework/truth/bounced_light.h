// Light that diffuse surfaces send each other, and that area lights and the sky send them, at every vertex of a scene.
//
// The direct light of Scene::lights is left out: shaders add it, with their shadow maps. Each bounce is one gathering:
// what a vertex receives from all around, where surfaces send what they emit and
//   base_colour * (direct light / pi + ambient + what their vertices received in the bounce before).
// Metals count by their base colour, too, as if they were diffuse: their light would be lost otherwise. Emitters are
// found in two ways, by points on them and by rays from the vertex, weighted by the balance heuristic (E. Veach,
// L. Guibas 1995, "Optimally Combining Sampling Techniques for Monte Carlo Rendering"). All vertices share one set of
// directions and one of points, so the error has no grain.
#pragma once

#include "scene/scene.h"

#include <vector>

namespace ssrlab {

/// Returns Vertex::bounced for every vertex, by the numbers of Scene::bake, which must be there. On a double-sided
/// material it is the light of the side that is more open. threads = 0: all cores.
std::vector<glm::vec3> bounced_light(const Scene& scene, unsigned threads = 0);

} // namespace ssrlab
