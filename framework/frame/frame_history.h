// What one frame of a sequence leaves for the next: depth, planes, normals, reflection, and the view of the frame.
#pragma once

#include "gpu/gpu.h"

#include <glm/glm.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace ssrlab {

struct FrameHistory;
struct ReadyFrame;
using FrameHistoryPtr = std::shared_ptr<FrameHistory>;

/// Returns an empty history, for a sequence of frames with one technique and one set of values.
FrameHistoryPtr make_history(Gpu& gpu, glm::ivec2 size_px);
/// Keeps the frame that run_frame() rendered last in its history, for the next frame. Before this call the frame may be
/// run again and gives the same bits. `number`: the frame's number in its sequence.
void keep_history(Gpu& gpu, const ReadyFrame& frame, int number);
/// Empties the history, for a cut.
void drop_history(FrameHistory& history);

/// Returns, per pixel, the vector to where its reflection was in the frame before, in pixels and without the jitter of
/// either frame; NaN if nothing was hit or seen. Empty if the plan has no reprojection.
std::vector<glm::vec2> read_reprojection(Gpu& gpu, const ReadyFrame& frame);

/// Reflecting pixels by what became of their history; each pixel counts in one of the first six.
struct HistoryCounts {
    uint32_t accumulated  = 0; // used the history
    uint32_t unseen       = 0; // no vector: no hit, or the strategy says that it was not seen
    uint32_t off_image    = 0; // it was outside the image
    uint32_t other_depth  = 0; // the reflector was hidden there, or reflected nothing
    uint32_t other_normal = 0;
    uint32_t other_hit    = 0; // the reflector was there and reflected another object
    uint32_t clamped      = 0; // of the accumulated: clamped to the neighbourhood
};
/// Returns the counts of the last run_frame(); nullopt if the plan has no history.
std::optional<HistoryCounts> read_history_counts(Gpu& gpu, const ReadyFrame& frame);

} // namespace ssrlab
