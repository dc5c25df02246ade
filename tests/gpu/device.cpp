#include "gpu/device.h"

#include "compare/differing_rays.h"
#include "core/error.h"
#include "core/pixel_index.h"
#include "frame/frame_inputs.h"
#include "gpu/vulkan.h"

namespace ssrlab::test {

Gpu& device()
{
    static Gpu gpu = open_gpu({.device = {}, .validation = true});
    return gpu;
}

int most_layers() { return device().impl->limits.maxPerStageDescriptorStorageImages < 32 ? 2 : MAX_LAYERS; }

bool draws_exactly() { return device().info.name.find("SwiftShader") == std::string::npos; }

const Catalogue& catalogue()
{
    static const Catalogue found = load_catalogue();
    return found;
}

const Technique& technique(const std::string& id) { return find_technique(catalogue().techniques, id); }

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
    device(); // opened first, so that it outlives the scenes
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

namespace {

Picture make_picture(GBufferPtr gbuffer, const DrawingPtr& drawing)
{
    Picture picture;
    picture.view    = gbuffer->view;
    picture.drawing = drawing;
    picture.gbuffer = std::move(gbuffer);
    picture.image   = read_gbuffer(device(), *picture.gbuffer);
    picture.buffers = make_frame_buffers(device(), picture.gbuffer, drawing);
    return picture;
}

Picture make_picture(const DrawingPtr& drawing) { return make_picture(drawing->gbuffer, drawing); }

} // namespace

std::vector<std::string> made_scenes_and(std::vector<std::string> names)
{
    for (const SceneListing& listing : list_scenes())
        if (listing.name.starts_with("builtin:")) names.push_back(listing.name);
    return names;
}

Picture make_picture(const std::string& scene, const std::string& view, glm::ivec2 size_px)
{
    const LoadedScene& loaded = load(scene);
    return make_picture(draw_gbuffer(device(), loaded.gpu, camera_to_view(find_camera(loaded.scene, view), size_px)));
}

Picture make_picture(const Scene& scene, const Camera& camera, glm::ivec2 size_px)
{
    return make_picture(draw_gbuffer(device(), upload_scene(device(), scene), camera_to_view(camera, size_px)));
}

Picture make_picture(const GBufferImage& gbuffer) { return make_picture(upload_gbuffer(device(), gbuffer), nullptr); }

FramePtr prepared_frame(const FrameBuffersPtr& buffers, const Technique& technique, const ParameterValues& values,
                        const FrameSettings& settings, const FrameHistoryPtr& history)
{
    if (buffers->drawing) draw_layers(device(), *buffers->drawing, settings.trace.layers);
    const LabPtr lab  = make_lab(device(), catalogue(), buffers->gbuffer, technique, values, settings.trace);
    const auto   plan = plan_frame(device(), catalogue(), lab, buffers, settings, history);
    return make_frame(device(), lab, buffers, plan, history);
}

const FramePlan& plan_of(const ReadyFrame& frame) { return frame.inputs.plan; }

TraceImage counted(const ReadyFrame& frame, NumberFormat number_format)
{
    return trace_gbuffer(device(), *make_tracer(device(), frame.inputs.lab, number_format));
}

LabPtr lab_on_picture(const Picture& picture, const Technique& technique, const ParameterValues& values,
                      const TraceSettings& settings)
{
    if (picture.drawing) draw_layers(device(), *picture.drawing, settings.layers);
    return make_lab(device(), catalogue(), picture.gbuffer, technique, values, settings);
}

TracerPtr tracer_on(const GBufferPtr& gbuffer, const Technique& technique, const ParameterValues& values,
                    const TraceSettings& settings, size_t capacity, NumberFormat number_format)
{
    return make_tracer(device(), make_lab(device(), catalogue(), gbuffer, technique, values, settings), capacity,
                       number_format);
}

TraceImage trace(const Picture& picture, const Technique& technique, const ParameterValues& values,
                 const TraceSettings& settings, NumberFormat number_format)
{
    const LabPtr lab = lab_on_picture(picture, technique, values, settings);
    return trace_gbuffer(device(), *make_tracer(device(), lab, number_format));
}

std::string missing_for_exact()
{
    const Technique& walk = technique("dda");
    return missing_feature(device(), walk, values_of(walk, {{"arithmetic", 1}}));
}

std::string repeat_command(const std::string& scene, const std::string& view, glm::ivec2 size_px,
                           const Technique& technique, const ParameterValues& values, const TraceSettings& settings)
{
    std::string text = fmt::format("repeat: ssrlab trace {} --view {} --size {}x{} -t {}", scene, view, size_px.x,
                                   size_px.y, technique.id);
    for (const Parameter& p : technique.parameters)
        text += fmt::format(" -p {}={}", p.name, format_parameter(p, values.at(p.name)));
    return text +
           fmt::format(" -p thickness_m={} -p max_distance_m={} -p dielectric_min_f0={} -p surface={} -p behind={} "
                       "-p layers={} -o hits.exr",
                       settings.thickness_m, settings.max_distance_m, settings.dielectric_min_f0, settings.surface,
                       behind_names[static_cast<size_t>(settings.behind)], settings.layers);
}

size_t count_differences(const TraceImage& a, const TraceImage& b, double t_tolerance, std::string& first)
{
    size_t differences = 0;
    for (size_t i = 0; i < a.status.size(); ++i) {
        if (!differs_at(a, b, i, t_tolerance) || differences++ > 0) continue;
        first = fmt::format(
            "ray of pixel ({}, {}): status {} against {}, pixel ({}, {}) against ({}, {}), t {} against {}",
            pixel_at(i, a.size_px).x, pixel_at(i, a.size_px).y, trace_status_names[static_cast<size_t>(a.status[i])],
            trace_status_names[static_cast<size_t>(b.status[i])], a.hit_pixel[i].x, a.hit_pixel[i].y, b.hit_pixel[i].x,
            b.hit_pixel[i].y, a.hit_t[i], b.hit_t[i]);
    }
    return differences;
}

} // namespace ssrlab::test
