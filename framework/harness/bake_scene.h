// Bounced light, kept in the user's cache folder.
#pragma once

#include "scene/scene.h"

#include <functional>
#include <string>

namespace ssrlab {

/// Gives the vertices the bounced light that the scene asks for (Scene::bake). Tells `say` before it computes, which
/// can take minutes.
void bake_scene(Scene& scene, const std::function<void(const std::string&)>& say);

} // namespace ssrlab
