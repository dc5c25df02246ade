#include "targets.h"

#include "scene/scene.h"

namespace ssrlab::fuzz {

void feed_frame(Bytes bytes)
{
    static const auto convention =
        file_with("frame.exr.toml", "camera = { fov_y_deg = 60, near_m = 0.1 }\ndepth = { kind = \"distance\" }\n"
                                    "normals = { space = \"view\" }\nvalues = { roughness = 0.2, metallic = 1 }\n");
    load_scene(file_with("frame.exr", bytes).string());
}

} // namespace ssrlab::fuzz
