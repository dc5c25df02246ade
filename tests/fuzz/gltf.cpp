#include "targets.h"

#include "scene/scene.h"

namespace ssrlab::fuzz {

void feed_gltf(Bytes bytes) { load_scene(file_with("scene.gltf", bytes).string()); }

} // namespace ssrlab::fuzz
