// A scene on the device, and the G-buffers drawn from it.
#pragma once

#include "scene/sequence.h"
#include "trace/lab.h"

#include <optional>

namespace ssrlab {

struct GpuScene; // a scene's buffers, textures and shadow maps
struct Drawing;  // draws one view of it into a G-buffer

using GpuScenePtr = std::shared_ptr<GpuScene>;
using DrawingPtr  = std::shared_ptr<Drawing>;

/// Uploads the scene and renders its shadow maps.
GpuScenePtr upload_scene(Gpu& gpu, const Scene& scene);
/// Updates vertices and shadow maps for the same scene with its draws elsewhere, in the existing buffers.
void move_scene(Gpu& gpu, GpuScene& uploaded, const Scene& moved);

/// Draws a view. Throws SpecError if the size exceeds the device's limit.
/// `motion`: since the frame before; if anything moved, the G-buffer has motion vectors.
DrawingPtr        draw_gbuffer(Gpu& gpu, const GpuScenePtr& scene, const View& view,
                               const std::optional<FrameMotion>& motion = {});
const GBufferPtr& gbuffer_of(const Drawing& drawing);
/// Draws into the same images again; returns the GPU time in milliseconds.
double redraw_gbuffer(Gpu& gpu, Drawing& drawing);
/// Draws the layers up to `layers` that the G-buffer lacks, with their solids.
void draw_layers(Gpu& gpu, Drawing& drawing, int layers);

} // namespace ssrlab
