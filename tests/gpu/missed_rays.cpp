// The history of pixels whose rays miss.
#include "core/pixel_index.h"
#include "frame/history_images.h"
#include "frame/passes/choices.h"
#include "gpu/sequence_frames.h"

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{160, 90};

bool hits_beside(const TraceImage& hits, glm::ivec2 pixel)
{
    for (int i = 0; i < 9; ++i) {
        const glm::ivec2 next = glm::clamp(pixel + glm::ivec2(i % 3 - 1, i / 3 - 1), glm::ivec2(0), size_px - 1);
        if (hits.status[pixel_index(next, size_px)] == TraceStatus::hit) return true;
    }
    return false;
}

// Boxes slide and turn over a mirror floor, before nothing. Where a box was seen in the mirror one frame ago and its ray misses now, there must
// be no rest of the box, whether the camera stands or steps: the weight of the reflection is that of the misses, which is 0.
TEST(MissedRays, KeepNothingOfWhatHasMovedOn)
{
    Scene scene = load_scene("builtin:moving_boxes");
    std::erase_if(scene.draws, [](const Draw& draw) { return draw.name == "wall"; });
    for (Draw& draw : scene.draws) draw.motion.move_m *= 6.0; // more than a pixel a frame
    const ParameterValues passes{
        strategy("carried_plane"), chosen(HistoryClamping::off), chosen(Gloss::off), {"environment_fallback", 0}};
    for (const std::string view : {"default", "truck"}) {
        const FrameHistoryPtr history   = make_history(device(), size_px);
        size_t                uncovered = 0;
        std::vector<bool>     hit_before(pixel_count(size_px));
        for (int frame = 0; frame < 6; ++frame) {
            const SequencePicture picture = picture_at(scene, view, {frame, 8}, size_px);
            const auto            run     = run_picture(picture, passes, history, "dda");
            const TraceImage      hits    = counted(*run);
            run_frame(device(), *run);
            keep_history(device(), *run, frame);
            const auto result = download_as<glm::vec4>(device(), history->reflection);
            for (size_t i = 0; i < result.size(); ++i) {
                const bool hit = hits.status[i] == TraceStatus::hit;
                if (!hit && result[i].a >= 0 && !hits_beside(hits, pixel_at(i, size_px))) {
                    ASSERT_LT(result[i].a, 1e-3F) << view << " frame " << frame << " pixel " << i;
                    uncovered += hit_before[i] ? 1 : 0;
                }
                hit_before[i] = hit;
            }
        }
        EXPECT_GT(uncovered, 20U) << view;
    }
}

} // namespace
} // namespace ssrlab::test
