#include "scene/load_scene.h"

#include "core/error.h"
#include "core/files.h"
#include "core/names.h"
#include "scene/builtin_scenes.h"
#include "scene/recipe.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view builtin_prefix = "builtin:";

ViewNames names_of(const std::vector<Camera>& cameras, const std::vector<CameraPath>& paths)
{
    ViewNames names;
    std::ranges::transform(cameras, std::back_inserter(names.cameras), &Camera::name);
    for (const CameraPath& path : paths)
        if (!names.has(path.name)) names.paths.push_back(path.name);
    return names;
}

/// Those beside the glTF file come first: they are what somebody chose.
Model with_views_beside(Model model, const fs::path& file)
{
    const fs::path views = file.string() + ".views.toml";
    if (!fs::exists(views)) return model;
    std::vector<Camera> cameras = load_views(views);
    std::erase_if(model.paths, [&](const CameraPath& path) {
        return std::ranges::find(cameras, path.name, &Camera::name) != cameras.end();
    });
    std::ranges::move(model.cameras, std::back_inserter(cameras));
    model.cameras = std::move(cameras);
    return model;
}

Model load_model(const std::string& name)
{
    if (name.starts_with(builtin_prefix)) {
        for (const BuiltinScene& scene : builtin_scenes())
            if (name.substr(builtin_prefix.size()) == scene.name) return scene.make();
        throw SpecError(unknown_scene(name));
    }
    const fs::path file = find_scene_file(name);
    if (file.empty()) throw SpecError(unknown_scene(name));
    if (!fs::exists(file)) throw_spec_error("scene '{}': no such file", name);
    return lower_extension(file) == ".toml" ? load_recipe(file) : with_views_beside(load_gltf(file), file);
}

Scene frame_scene(const std::string& name)
{
    Scene scene;
    scene.name     = name;
    scene.frame    = load_frame(name);
    scene.warnings = scene.frame->warnings;
    Camera camera;
    camera.name    = scene.frame->gbuffer.view.name;
    camera.size_px = scene.frame->gbuffer.view.size_px;
    scene.cameras.push_back(camera);
    return scene;
}

} // namespace

bool is_frame(const std::string& name) { return lower_extension(name) == ".exr"; }

std::string lower_extension(const fs::path& file)
{
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    return extension;
}

fs::path find_scene_file(const std::string& name)
{
    if (name.starts_with(builtin_prefix)) return {};
    const std::string extension = lower_extension(name);
    if (extension == ".glb" || extension == ".gltf" || extension == ".toml" || extension == ".exr") return name;
    if (name.find('/') == std::string::npos)
        for (const fs::path& folder : recipe_folders())
            if (fs::exists(folder / (name + ".toml"))) return folder / (name + ".toml");
    return {};
}

std::vector<fs::path> recipe_folders()
{
    std::vector<fs::path> folders;
    if (const char* list = std::getenv("SSRLAB_SCENES")) {
        std::istringstream stream(list);
        for (std::string folder; std::getline(stream, folder, ':');)
            if (!folder.empty()) folders.emplace_back(folder);
    }
    folders.emplace_back(data_root() / "experiments/scenes");
    return folders;
}

std::vector<SceneListing> list_scenes()
{
    std::vector<SceneListing> listings;
    std::set<std::string>     seen;
    for (const fs::path& folder : recipe_folders()) {
        std::vector<fs::path> files;
        std::error_code       error;
        for (const auto& entry : fs::directory_iterator(folder, error))
            if (entry.path().extension() == ".toml" && !entry.path().stem().string().ends_with(".views"))
                files.push_back(entry.path());
        std::ranges::sort(files);
        for (const fs::path& file : files)
            if (seen.insert(file.stem().string()).second)
                listings.push_back({file.stem().string(), recipe_summary(file)});
    }
    for (const BuiltinScene& scene : builtin_scenes())
        listings.push_back({std::string(builtin_prefix) + scene.name, scene.summary});
    return listings;
}

Scene load_scene(const std::string& name)
{
    try {
        if (is_frame(name)) return frame_scene(name);
        return model_to_scene(load_model(name), name);
    } catch (const std::bad_alloc&) {
        throw_failure("scene '{}': out of memory", name);
    } catch (const std::filesystem::filesystem_error& error) {
        throw_failure("scene '{}': {}", name, error.what());
    }
}

std::string unknown_scene(const std::string& name)
{
    if (std::error_code error; fs::is_regular_file(name, error))
        return fmt::format("scene '{}': expected a .glb, .gltf, recipe (.toml) or frame (.exr). A recipe with [[part]] "
                           "and file = \"{}\" shows a model of another format (experiments/scenes/README.md)",
                           name, name);
    std::vector<std::string> known;
    std::ranges::transform(list_scenes(), std::back_inserter(known), &SceneListing::name);
    return unknown_name("scene", name, known) +
           " A scene may also be the path of a .glb, .gltf, recipe (.toml) or frame (.exr)";
}

bool ViewNames::has(const std::string& view) const
{
    const auto lists = [&](const std::vector<std::string>& names) {
        return std::ranges::find(names, view) != names.end();
    };
    return view == Camera{}.name || lists(cameras) || lists(paths);
}

ViewNames view_names(const std::string& scene)
{
    const fs::path    file      = find_scene_file(scene);
    const std::string extension = lower_extension(file);
    const bool in_file = fs::exists(file) && (extension == ".toml" || extension == ".glb" || extension == ".gltf");
    if (!in_file) {
        const Scene loaded = load_scene(scene);
        return names_of(loaded.cameras, loaded.paths);
    }
    Model model;
    if (extension == ".toml") {
        Recipe recipe = read_recipe(file);
        model.cameras = std::move(recipe.views);
        model.paths   = std::move(recipe.paths);
    } else {
        model = with_views_beside(load_gltf_views(file), file);
    }
    if (model.cameras.empty()) model.cameras.emplace_back(); // the fitted one
    make_camera_names_unique(model.cameras);
    return names_of(model.cameras, model.paths);
}

std::string unknown_view(const std::string& scene, const std::string& view, const ViewNames& known)
{
    std::vector<std::string> names = known.cameras;
    names.insert(names.end(), known.paths.begin(), known.paths.end());
    const std::string near = suggestion(view, names);
    return fmt::format("scene '{}' has no view '{}'{} its views are {}", scene, view, near.empty() ? ":" : near,
                       fmt::join(names, ", "));
}

const Camera& find_camera(const Scene& scene, const std::string& name)
{
    if (const auto found = std::ranges::find(scene.cameras, name, &Camera::name); found != scene.cameras.end())
        return *found;
    if (name == Camera{}.name && !scene.cameras.empty()) return scene.cameras.front();
    throw SpecError(unknown_view(scene.name, name, names_of(scene.cameras, scene.paths)));
}

} // namespace ssrlab
