#include "core/error.h"
#include "scene/load_scene.h"
#include "scene/recipe.h"

#include <algorithm>

namespace ssrlab {
namespace {

Camera read_view(TomlTable& table)
{
    Camera camera;
    camera.name         = table.text("name").value_or(camera.name);
    camera.hard_for     = table.text("hard_for").value_or("");
    const auto position = table.vector("position");
    const auto target   = table.vector("target");
    if (!position || !target) table.fail("'position' and 'target' are needed: [x, y, z] in metres");
    camera.position_ws = *position;
    camera.target_ws   = *target;
    camera.up_ws       = table.vector("up").value_or(camera.up_ws);
    camera.projection =
        static_cast<Projection>(table.choice("projection", {"perspective", "orthographic"}).value_or(0));
    camera.fov_y_deg = table.number("fov_y_deg", 0.01, 179).value_or(camera.fov_y_deg);
    camera.height_m  = table.number("height_m", 1e-6, 1e9).value_or(camera.height_m);
    camera.near_m    = table.number("near_m", 1e-6, 1e9).value_or(camera.near_m);
    camera.far_m     = table.number("far_m", 1e-6, 1e12).value_or(camera.far_m);
    camera.size_px   = table.size_px("size").value_or(camera.size_px);
    table.refuse_unknown_keys();
    try {
        camera_to_view(camera, camera.size_px);
    } catch (const SpecError& error) {
        throw_spec_error("{}: {}", table.place(), error.what());
    }
    return camera;
}

} // namespace

std::vector<Camera> read_views(TomlTable& root)
{
    std::vector<Camera> views;
    for (TomlTable& table : root.tables("view")) {
        Camera view = read_view(table);
        if (std::ranges::find(views, view.name, &Camera::name) != views.end())
            table.fail(fmt::format("'name' must differ from the other views', got '{}' again", view.name));
        views.push_back(std::move(view));
    }
    return views;
}

std::vector<Camera> load_views(const std::filesystem::path& file)
{
    const TomlFile      parsed = read_toml(file);
    TomlTable           root(parsed, parsed.root, "views");
    std::vector<Camera> cameras = read_views(root);
    root.refuse_unknown_keys();
    return cameras;
}

} // namespace ssrlab
