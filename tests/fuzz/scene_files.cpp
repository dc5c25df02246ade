// Targets of scenes and of what belongs to them.
#include "targets.h"

#include "core/toml_reading.h"
#include "scene/environment.h"
#include "scene/frame_convention.h"
#include "scene/image_file.h"
#include "scene/load_scene.h"
#include "scene/model.h"
#include "scene/recipe.h"
#include "scene/scene.h"

namespace ssrlab::fuzz {

void feed_toml(Bytes bytes) { parse_toml("file.toml", std::string(bytes.begin(), bytes.end())); }

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

void feed_views(Bytes bytes) { load_views(file_with("scene.gltf.views.toml", bytes)); }

void feed_frame_convention(Bytes bytes)
{
    static const ExrFile exr{file_with("convention.exr", Bytes()), "convention.exr", {64, 36}, {}, {}, {}};
    file_with("convention.exr.toml", bytes);
    read_convention(exr);
}

void feed_frame(Bytes bytes)
{
    static const auto convention =
        file_with("frame.exr.toml", "camera = { fov_y_deg = 60, near_m = 0.1 }\ndepth = { kind = \"distance\" }\n"
                                    "normals = { space = \"view\" }\nvalues = { roughness = 0.2, metallic = 1 }\n");
    load_scene(file_with("frame.exr", bytes).string());
}

static void feed_environment(const std::string& name, Bytes bytes)
{
    std::vector<std::string> warnings;
    load_environment(file_with(name, bytes), 1, warnings);
}
void feed_environment_exr(Bytes bytes) { feed_environment("sky.exr", bytes); }
void feed_environment_hdr(Bytes bytes) { feed_environment("sky.hdr", bytes); }

void feed_gltf(Bytes bytes) { load_scene(file_with("scene.gltf", bytes).string()); }

void feed_obj(Bytes bytes)
{
    static const auto recipe = file_with("obj.toml", "[[part]]\nfile = \"hostile/model.obj\"\n");
    file_with("hostile/model.obj", bytes);
    file_with("hostile/model.mtl", bytes);
    load_scene(recipe.string());
}

void feed_image(Bytes bytes) { decode_image(bytes, "image.tga"); }

} // namespace ssrlab::fuzz
