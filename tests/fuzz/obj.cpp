#include "targets.h"

#include "scene/scene.h"

namespace ssrlab::fuzz {

void feed_obj(Bytes bytes)
{
    static const auto recipe = file_with("obj.toml", "[[part]]\nfile = \"hostile/model.obj\"\n");
    file_with("hostile/model.obj", bytes);
    file_with("hostile/model.mtl", bytes);
    load_scene(recipe.string());
}

} // namespace ssrlab::fuzz
