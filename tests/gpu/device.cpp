#include "gpu/device.h"

#include <map>

namespace ssrlab::test {

Gpu& device()
{
    static Gpu gpu = open_gpu({.device = {}, .validation = true});
    return gpu;
}

const Technique& technique(const std::string& id)
{
    static const std::vector<Technique> techniques = list_techniques({});
    return find_technique(techniques, id);
}

ParameterValues values_of(const Technique& technique, const ParameterValues& changed)
{
    ParameterValues values = default_values(technique);
    for (const auto& [name, value] : changed) values.at(name) = value;
    return values;
}

namespace {

struct LoadedScene {
    Scene       scene;
    GpuScenePtr gpu;
};

/// Scenes are loaded once per program; the last one used stays.
const LoadedScene& load(const std::string& name)
{
    static std::map<std::string, LoadedScene> scenes;
    if (!scenes.contains(name)) {
        scenes.clear();
        LoadedScene loaded{load_scene(name), nullptr};
        loaded.gpu = upload_scene(device(), loaded.scene);
        scenes.emplace(name, std::move(loaded));
    }
    return scenes.at(name);
}

} // namespace

Picture make_picture(const std::string& scene, const std::string& view, glm::ivec2 size_px)
{
    const LoadedScene& loaded = load(scene);
    Picture            picture;
    picture.view    = camera_to_view(find_camera(loaded.scene, view), size_px);
    picture.gbuffer = render_gbuffer(device(), loaded.gpu, picture.view);
    picture.image   = read_gbuffer(device(), *picture.gbuffer);
    picture.buffers = make_frame_buffers(device(), picture.gbuffer);
    return picture;
}

TraceResult trace(const Picture& picture, const Technique& technique, const ParameterValues& values, const TraceSettings& settings,
                  Precision precision)
{
    const auto frame = prepare_frame(device(), picture.buffers, technique, values, {settings, {}});
    return count_frame(device(), *frame, precision);
}

} // namespace ssrlab::test
