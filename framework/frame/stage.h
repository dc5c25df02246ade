// A stage: scene, view, G-buffer and catalogue on a device, ready to trace.
#pragma once

#include "frame/frame.h"

namespace ssrlab {

struct DeviceGrid;
struct World;

struct Stage {
    Gpu                               gpu;
    Catalogue                         catalogue;
    Scene                             first;    // in frame 0
    Scene                             scene;    // in the frame that is shown
    GpuScenePtr                       uploaded; // null for a frame file, which has no triangles
    View                              view;
    std::optional<FrameMotion>        motion;  // since the frame before
    DrawingPtr                        drawing; // null for a frame file
    GBufferPtr                        gbuffer;
    std::shared_ptr<World>            world;     // of `scene`; null until world_of() is asked
    std::shared_ptr<const DeviceGrid> grid;      // likewise, grid_of()
    int                               frame = 0; // of the sequence
};

/// Uploads the scene. No view is shown yet.
Stage open_stage(const Gpu& gpu, Catalogue catalogue, Scene scene);

/// Moves the scene to another frame of its sequence, if it moves.
void move_stage(Stage& stage, int frame);
/// Draws a view of the scene in a frame of its sequence, shifted by an offset of at most a pixel; a frame file is
/// uploaded as it is. `size_px`: 0 for the view's own size. Throws SpecError for an unknown view and for sizes that the
/// device cannot draw.
void show(Stage& stage, const std::string& view, glm::ivec2 size_px, SequenceFrame at = {}, glm::dvec2 offset_px = {});
/// Draws the scene from any camera, without a frame before it.
void show(Stage& stage, const View& view);

/// Returns the scene's triangles on the device. Throws Failure where they are more than it holds.
const std::shared_ptr<World>& world_of(Stage& stage);
/// Returns which cells of the scene's bounds hold geometry.
const DeviceGrid& grid_of(Stage& stage);

/// Returns the channel that the surface model reads and the scene, a frame file, does not have; or "".
std::string lacked_channel(const Scene& scene, const Surface& surface);
/// Returns what settings ask for that a frame file does not have, as nothing lies behind its surfaces; or "".
std::string frame_lacks(const std::string& file, const FrameSettings& settings);

/// Returns the technique on the shown G-buffer, with as many layers as the settings ask for. Throws as make_lab() does,
/// and SpecError for what a frame file lacks.
LabPtr make_lab(Stage& stage, const Technique& technique, const ParameterValues& values, const TraceSettings& settings);
FrameBuffersPtr make_frame_buffers(Stage& stage);

/// Returns the plan of a frame: plan_frame() with what the stage knows. Throws SpecError for what a frame file lacks.
FramePlan plan_frame(Stage& stage, const LabPtr& lab, const FrameBuffersPtr& buffers, const FrameSettings& settings,
                     const FrameHistoryPtr& history = nullptr);

} // namespace ssrlab
