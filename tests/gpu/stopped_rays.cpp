// What a ray shows that stopped at the unseen side of a surface.
#include "frame/frame_inputs.h"
#include "frame/passes/choices.h"
#include "gpu/device.h"
#include "gpu/passes.h"

namespace ssrlab::test {
namespace {

Reflection reflection_where_rays(Behind behind, bool stopped_shows_front, Gloss gloss, TraceImage& rays)
{
    const Picture picture = make_picture("animal_on_metal", "default", {160, 90});
    FrameSettings settings{.trace = {.thickness_m = 0.1, .max_distance_m = 30, .behind = behind, .surface = "plane"}};
    settings.passes.at("stopped_shows_front") = stopped_shows_front ? 1 : 0;
    settings.passes.insert_or_assign(chosen(gloss).first, chosen(gloss).second);
    const Technique& hiz   = technique("hiz");
    const auto       frame = prepared_frame(picture.buffers, hiz, values_of(hiz), settings);
    rays                   = counted(*frame);
    run_frame(device(), *frame);
    return read_colours(picture.buffers->reflection);
}

// A ray that stops would have been a hit with behind = hit: the same pixel, the same t. So with the front shown the two settings make the same
// reflection, bit for bit, though one says which of its hits nobody has seen. Without it they show
// the environment, as do mirrors in which such a reflection is seen.
TEST(StoppedRays, ShowTheFrontOfWhatTheyMet)
{
    for (const Gloss gloss : {Gloss::off, Gloss::stochastic}) {
        TraceImage       stopped, shown, met;
        const Reflection missing = reflection_where_rays(Behind::stop, false, gloss, stopped),
                         front   = reflection_where_rays(Behind::stop, true, gloss, shown),
                         hit     = reflection_where_rays(Behind::hit, false, gloss, met);
        size_t of_stopped = 0, changed = 0;
        for (size_t i = 0; i < front.size(); ++i) {
            ASSERT_EQ(front[i], hit[i]) << "pixel " << i;
            of_stopped += stopped.status[i] == TraceStatus::stopped ? 1 : 0;
            ASSERT_EQ(shown.status[i], stopped.status[i]) << "pixel " << i;
            changed += missing[i] != front[i] ? 1 : 0;
        }
        EXPECT_GT(of_stopped, 50U);
        EXPECT_GT(changed, of_stopped / 2);
    }
}

} // namespace
} // namespace ssrlab::test
