#include "targets.h"

#include "scene/load_scene.h"
#include "scene/model.h"

namespace ssrlab::fuzz {

void feed_views(Bytes bytes) { load_views(file_with("scene.gltf.views.toml", bytes)); }

} // namespace ssrlab::fuzz
