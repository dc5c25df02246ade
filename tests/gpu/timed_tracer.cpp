// A tracer that counts no work, as techniques are timed with.
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

TEST(TimedTracer, FindsWhatACountingOneFindsAndTakesTime)
{
    const Picture       picture = make_picture("builtin:stairs", "default", {64, 36});
    const TraceSettings settings{.behind = Behind::stop, .surface = "plane"};
    for (const char* name : {"dda", "hiz_packets"}) {
        const Technique& tracing = technique(name);
        const LabPtr     lab     = lab_on_picture(picture, tracing, values_of(tracing), settings);
        const TracerPtr  timed   = make_timed_tracer(device(), lab);
        const TraceImage counted = trace_gbuffer(device(), *make_tracer(device(), lab));
        trace_gbuffer(device(), *timed);
        for (const int times : {1, 3}) {
            EXPECT_GT(time_trace(device(), *timed, times), 0) << name;
            const TraceImage found = trace_gbuffer(device(), *timed);
            EXPECT_TRUE(found.depth_fetches.empty());
            EXPECT_EQ(found.status, counted.status) << name;
            EXPECT_EQ(found.hit_pixel, counted.hit_pixel) << name;
            EXPECT_EQ(found.hit_t, counted.hit_t) << name;
            EXPECT_GT(std::ranges::count(found.status, TraceStatus::hit), 50) << name;
        }
    }
}

} // namespace
} // namespace ssrlab::test
