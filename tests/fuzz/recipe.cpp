#include "targets.h"

#include "scene/recipe.h"
#include "scene/scene.h"

namespace ssrlab::fuzz {

void feed_recipe(Bytes bytes)
{
    constexpr size_t  most_copies = 4; // the program makes more, in more time
    static const auto model       = file_with("model.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    static const auto sky         = file_with("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\nabcdabcd");
    const auto        file        = file_with("recipe.toml", bytes);
    size_t            copies      = 0;
    for (const Part& part : read_recipe(file).parts) copies += part.positions_ws.size();
    if (copies <= most_copies) load_scene(file.string());
}

} // namespace ssrlab::fuzz
