// What one frame of a sequence leaves for the next: depth, planes, normals and reflection, and the view that they were seen from.
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

/// Holds nothing yet. Made once for a sequence of frames with one technique and one set of values.
FrameHistoryPtr make_history(Gpu& gpu, glm::ivec2 size_px);
/// After run_frame(): this frame is what the next one finds in the history that it was made with. Until then the frame may be run
/// again and gives the same bits. `number`: of the frame in its sequence.
void keep_history(Gpu& gpu, const ReadyFrame& frame, int number);
/// A cut: the next frame finds nothing.
void drop_history(FrameHistory& history);

/// By pixel: from the pixel to where its reflection was in the frame before, in pixels, without the jitter of either frame. NaN where
/// nothing was hit or seen. Empty if the plan has no reprojection.
std::vector<glm::vec2> read_reprojection(Gpu& gpu, const ReadyFrame& frame);

/// What became of each reflecting pixel's history; each is one of the first six.
struct HistoryCounts {
    uint32_t accumulated  = 0; // took something of the history
    uint32_t unseen       = 0; // no vector: no hit, or the strategy says that it was not seen
    uint32_t off_image    = 0; // it was outside the image
    uint32_t other_depth  = 0; // the reflector was hidden there, or reflected nothing
    uint32_t other_normal = 0;
    uint32_t other_hit    = 0; // the reflector was there and reflected another object
    uint32_t clamped      = 0; // of the accumulated: the neighbourhood changed what the history held
};
/// Of the last run_frame(); nothing if the plan has no history.
std::optional<HistoryCounts> read_history_counts(Gpu& gpu, const ReadyFrame& frame);

} // namespace ssrlab
