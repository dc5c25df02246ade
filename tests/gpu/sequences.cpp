// Frames of a sequence on the device.
#include "gpu/device.h"
#include "scene/sequence.h"

namespace ssrlab::test {
namespace {

Image shaded(const GpuScenePtr& scene, const View& view)
{
    const FrameBuffersPtr  buffers = make_frame_buffers(device(), render_gbuffer(device(), scene, view));
    const PreparedFramePtr frame =
        prepare_frame(device(), buffers, technique("hiz"), values_of(technique("hiz")), FrameSettings{});
    run_frame(device(), *frame);
    return read_shaded(device(), *frame);
}

// A frame depends on nothing before it: moved in place there and back, with shadows, it has the bits of a scene loaded there.
TEST(Sequences, AMovedSceneHasTheBitsOfAFreshOne)
{
    const Scene       first    = load_scene("builtin:moving_boxes");
    const GpuScenePtr uploaded = upload_scene(device(), first);
    const auto  view_of  = [&](int frame) { return camera_to_view(camera_at(first, "orbit", {frame, 16}), {97, 61}); };
    const Image at_start = shaded(uploaded, view_of(0));
    for (const int frame : {7, 40, 0}) {
        const Scene scene = scene_at(first, frame);
        move_scene(device(), *uploaded, scene);
        const Image moved = shaded(uploaded, view_of(frame));
        EXPECT_EQ(moved.values, shaded(upload_scene(device(), scene), view_of(frame)).values) << "frame " << frame;
        EXPECT_EQ(moved.values == at_start.values, frame == 0);
    }
}

} // namespace
} // namespace ssrlab::test
