// A scene's picture of one view on a device, ready to trace.
#pragma once

#include "frame/frame.h"

namespace ssrlab {

struct Stage {
    Gpu                        gpu;
    Catalogue                  catalogue;
    Scene                      first;    // in frame 0
    Scene                      scene;    // in the frame that is shown
    GpuScenePtr                uploaded; // null: a frame of another renderer, which has no triangles
    View                       view;
    std::optional<FrameMotion> motion;  // since the frame before
    DrawingPtr                 drawing; // null likewise
    GBufferPtr                 gbuffer;
    int                        frame = 0; // of the sequence
};

/// Uploads the scene; nothing is shown yet.
Stage open_stage(const Gpu& gpu, Catalogue catalogue, Scene scene);

/// Moves the scene to another frame of its sequence, if it moves.
void move_stage(Stage& stage, int frame);
/// Draws a view of the scene in a frame of its sequence, moved by an offset of at most a pixel; a frame of another renderer
/// is uploaded as it is. size_px: 0: the view's own. Throws SpecError for a view that the scene lacks and for sizes that
/// the device cannot draw.
void show(Stage& stage, const std::string& view, glm::ivec2 size_px, SequenceFrame at = {}, glm::dvec2 offset_px = {});
/// Draws the scene as any camera sees it, without a frame before it.
void show(Stage& stage, const View& view);

/// The technique on the shown G-buffer and as many layers behind it as the settings ask for. Throws as make_lab() does.
LabPtr make_lab(Stage& stage, const Technique& technique, const ParameterValues& values, const TraceSettings& settings);
FrameBuffersPtr make_frame_buffers(Stage& stage);

/// The plan of a frame, and the frame: plan_frame() and make_frame() with what the stage knows.
FramePlan plan_frame(Stage& stage, const LabPtr& lab, const FrameBuffersPtr& buffers, const FrameSettings& settings,
                     const FrameHistoryPtr& history = nullptr);

} // namespace ssrlab
