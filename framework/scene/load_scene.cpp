#include "scene/load_scene.h"

#include "core/error.h"
#include "core/files.h"
#include "scene/builtin_scenes.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view builtin_prefix = "builtin:";

std::string known_names()
{
    std::string names;
    for (const SceneListing& listing : list_scenes()) names += (names.empty() ? "" : ", ") + listing.name;
    return names;
}

[[noreturn]] void throw_unknown(const std::string& name)
{
    throw_spec_error("unknown scene '{}': give a .glb or .gltf file, a recipe (.toml), a frame (.exr), or one of {}",
                     name, known_names());
}

Model load_gltf_with_views(const fs::path& file)
{
    Model          model = load_gltf(file);
    const fs::path views = file.string() + ".views.toml";
    if (fs::exists(views)) {
        // The views beside the scene come first: they are what somebody chose.
        std::vector<Camera> cameras = load_views(views);
        std::erase_if(model.paths, [&](const CameraPath& path) {
            return std::ranges::find(cameras, path.name, &Camera::name) != cameras.end();
        });
        std::ranges::move(model.cameras, std::back_inserter(cameras));
        model.cameras = std::move(cameras);
    }
    return model;
}

Model load_model(const std::string& name)
{
    if (name.starts_with(builtin_prefix)) {
        for (const BuiltinScene& scene : builtin_scenes())
            if (name.substr(builtin_prefix.size()) == scene.name) return scene.make();
        throw_unknown(name);
    }
    const fs::path file = find_scene_file(name);
    if (file.empty()) throw_unknown(name);
    if (!fs::exists(file)) throw_spec_error("scene '{}': no such file", name);
    return lower_extension(file) == ".toml" ? load_recipe(file) : load_gltf_with_views(file);
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

const Camera& find_camera(const Scene& scene, const std::string& name)
{
    std::string names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == name) return camera;
        names += (names.empty() ? "" : ", ") + camera.name;
    }
    for (const CameraPath& path : scene.paths)
        if (std::ranges::find(scene.cameras, path.name, &Camera::name) == scene.cameras.end())
            names += ", " + path.name;
    if (name == Camera{}.name && !scene.cameras.empty()) return scene.cameras.front();
    throw_spec_error("scene '{}' has no view '{}': its views are {}", scene.name, name, names);
}

} // namespace ssrlab
