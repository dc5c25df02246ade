// The history's images. Folder-internal.
#pragma once

#include "frame/frame_history.h"
#include "frame/motion_vectors.h"
#include "gpu/compute.h"

namespace ssrlab {

struct FrameHistory {
    glm::ivec2          size_px{0, 0};
    std::optional<View> view;      // as drawn, of the frame that it holds; empty: it holds none
    int                 frame = 0; // its number

    // Of the frame that it holds.
    GpuImage depth;      // R32F
    GpuImage gradient;   // R32UI, core/plane_gradient.h
    GpuImage normal;     // RGBA32F: view space
    GpuImage reflection; // RGBA32F: colour times weight, weight; < 0: does not reflect
    GpuImage facts;      // RGBA32F: accumulated frames, ray length, hit object (-1: unknown, -2: missed)
    GpuImage picture;    // RGBA32F: colour, accumulated frames; empty with picture_history_weight = 0

    // Of the frame that runs.
    GpuImage reprojected;     // RGBA32F: vector in px to where the reflection was, or NaN; ray length; hit object
    GpuImage kept_reflection; // becomes `reflection`
    GpuImage kept_facts;
    GpuImage kept_picture;
    Buffer   counts; // HistoryCounts
};

/// Returns why the history is not that of the frame before; empty if it is. `motion`: since the frame before; empty if
/// there was none.
std::string history_mismatch(const FrameHistory& history, glm::ivec2 size_px, const std::optional<FrameMotion>& motion);
} // namespace ssrlab
