#include "frame/stage.h"

#include "core/error.h"
#include "frame/frame_inputs.h"
#include "frame/passes/missed_rays.h"
#include "world/grid_walk.h"

namespace ssrlab {
namespace {

/// Whether the pass `missed_rays` may run, which traces the scene's triangles.
bool asks_for_world(Stage& stage, const Lab& lab, const ParameterValues& passes)
{
    return stage.uploaded && choice<PassSet>(passes) == PassSet::all && asks_triangles(passes) &&
           count_gbuffer(stage.gpu, *lab.gbuffer, lab.settings).reflecting_pixels > 0;
}

/// Null where the scene is more than the device holds: its frames do without.
WorldPtr world_if_held(Stage& stage)
{
    try {
        return world_of(stage);
    } catch (const Failure&) {
        return nullptr;
    }
}

void refuse_what_frame_lacks(const Scene& scene, const FrameSettings& settings)
{
    if (!scene.frame) return;
    if (const std::string lacks = frame_lacks(scene.name, settings); !lacks.empty()) throw SpecError(lacks);
}

} // namespace

const std::shared_ptr<World>& world_of(Stage& stage)
{
    if (!stage.world) {
        stage.world = upload_world(stage.gpu, stage.first);
        if (stage.frame != 0 && anything_moves(stage.first)) move_world(stage.gpu, *stage.world, stage.scene);
    }
    return stage.world;
}

const DeviceGrid& grid_of(Stage& stage)
{
    if (!stage.grid)
        stage.grid = std::make_shared<const DeviceGrid>(upload_grid(stage.gpu, make_occupancy(stage.scene)));
    return *stage.grid;
}

Stage open_stage(const Gpu& gpu, Catalogue catalogue, Scene scene)
{
    Stage stage;
    stage.gpu       = gpu;
    stage.catalogue = std::move(catalogue);
    stage.first     = std::move(scene);
    stage.scene     = stage.first;
    if (!stage.scene.frame) stage.uploaded = upload_scene(stage.gpu, stage.scene);
    return stage;
}

void move_stage(Stage& stage, int frame)
{
    if (frame != stage.frame && anything_moves(stage.first)) {
        stage.scene = scene_at(stage.first, frame);
        move_scene(stage.gpu, *stage.uploaded, stage.scene);
        if (stage.world) move_world(stage.gpu, *stage.world, stage.scene);
        stage.grid.reset();
    }
    stage.frame = frame;
}

void show(Stage& stage, const std::string& view, glm::ivec2 size_px, SequenceFrame at, glm::dvec2 offset_px)
{
    move_stage(stage, at.frame);
    stage.view   = view_at(stage.scene, view, size_px, at);
    stage.motion = motion_at(stage.scene, view, stage.view.size_px, at.frame);
    stage.view.centre_px += offset_px;
    if (stage.scene.frame) {
        stage.gbuffer = upload_gbuffer(stage.gpu, stage.scene.frame->gbuffer);
        return;
    }
    stage.drawing = draw_gbuffer(stage.gpu, stage.uploaded, stage.view, stage.motion);
    stage.gbuffer = gbuffer_of(*stage.drawing);
}

void show(Stage& stage, const View& view)
{
    stage.view = view;
    stage.motion.reset();
    stage.drawing = draw_gbuffer(stage.gpu, stage.uploaded, view);
    stage.gbuffer = gbuffer_of(*stage.drawing);
}

std::string lacked_channel(const Scene& scene, const Surface& surface)
{
    return scene.frame && scene.frame->gbuffer.solid_back.empty() && surface.needs_solid ? "solid_back" : "";
}

std::string frame_lacks(const std::string& file, const FrameSettings& settings)
{
    const auto lacks = [&](const std::string& asked, const char* expected) {
        return fmt::format(
            "{}: '{}' is a frame of another renderer, which holds nothing behind its surfaces: expected {}", asked,
            file, expected);
    };
    if (settings.trace.layers > 1) return lacks(fmt::format("layers = {}", settings.trace.layers), "1");
    return settings.passes.at("hidden_layer") != 0 ? lacks("hidden_layer = true", "false") : "";
}

LabPtr make_lab(Stage& stage, const Technique& technique, const ParameterValues& values, const TraceSettings& settings)
{
    refuse_what_frame_lacks(stage.scene, {.trace = settings});
    if (stage.drawing) draw_layers(stage.gpu, *stage.drawing, settings.layers);
    return make_lab(stage.gpu, stage.catalogue, stage.gbuffer, technique, values, settings);
}

FrameBuffersPtr make_frame_buffers(Stage& stage) { return make_frame_buffers(stage.gpu, stage.gbuffer, stage.drawing); }

FramePlan plan_frame(Stage& stage, const LabPtr& lab, const FrameBuffersPtr& buffers, const FrameSettings& settings,
                     const FrameHistoryPtr& history)
{
    refuse_what_frame_lacks(stage.scene, settings);
    buffers->world = asks_for_world(stage, *lab, settings.passes) ? world_if_held(stage) : nullptr;
    return plan_frame(stage.gpu, stage.catalogue, lab, buffers, settings, history);
}

} // namespace ssrlab
