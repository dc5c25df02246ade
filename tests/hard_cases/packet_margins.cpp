// hiz_packets skips what a packet finds empty. Its bounds are wider than its rays by what rounding may move these: on rays whose position or depth
// rounds to the other side of what they meet, it still finds what the pixel walk finds.
#include "check/setup.h"
#include "core/pixel_index.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

const TraceSettings settings = boxes({.thickness_m = 1, .max_distance_m = 1e9});

/// Each ray alone, through a picture of one object: the same answer to the last bit. How many rays meet it.
int same_answers(glm::ivec2 object, float depth, std::span<const RayInput> rays)
{
    const View         view = bench_view({128, 128});
    std::vector<float> depths(pixel_count(view.size_px));
    depths[pixel_index(object, view.size_px)] = depth;
    const auto gbuffer                        = upload_depth(device(), view, depths);
    const auto make                           = [&](const char* id) {
        return tracer_on(gbuffer, technique(id), values_of(technique(id)), settings, 1);
    };
    const auto walk = make("dda"), packets = make("hiz_packets");
    int        hits = 0;
    for (const RayInput& ray : rays) {
        const RayOutcome found = trace_rays(device(), *packets, {&ray, 1})[0],
                         exact = trace_rays(device(), *walk, {&ray, 1})[0];
        hits += exact.status == TraceStatus::hit;
        EXPECT_EQ(found.status, exact.status) << "from y = " << ray.origin_px_depth.y << " by " << ray.delta_px_depth.y;
        EXPECT_EQ(found.t, exact.t);
    }
    return hits;
}

RayInput ray_of(glm::vec3 origin, glm::vec3 delta)
{
    return {origin, delta, 1, TraceStatus::left_screen, glm::ivec2(origin)};
}

// Up the picture, and past row 64's border, which cells of every size share, by a last place of dy. The sum with y rounds that away; the walk, which
// divides, ends in row 63 on nearly all of them.
TEST(PacketMargins, HoldRaysThatEndAtABorder)
{
    std::vector<RayInput> rays;
    for (float y = 72.5F; y < 96; ++y) {
        const float dy = std::nextafter(64 - y, -100.0F);
        EXPECT_EQ(y + dy, 64);
        rays.push_back(ray_of({4.5F, y, 0.0225F}, {50, dy, 0}));
    }
    EXPECT_GT(same_answers({54, 63}, 0.025F, rays), 0);
}

// The rays end nearer than the object by a half of the last place of their origin's depth, with which theirs is a sum: the walk meets the object. That is
// as far apart as two fronts of the depth pyramid's cells at that depth.
TEST(PacketMargins, HoldRaysThatEndAtAFront)
{
    const float           place = 1.0F / (1 << 24), end = 209715 * place, front = end - place / 2; // near 0.0125
    std::vector<RayInput> rays;
    for (float origin = 0.53125F; origin < 1; origin += 0.03125F) {
        EXPECT_EQ(origin + (end - origin), end);
        rays.push_back(ray_of({4.5F, 20.5F, origin}, {50, 0, end - origin}));
    }
    EXPECT_EQ(same_answers({54, 20}, front, rays), static_cast<int>(rays.size()));
}

} // namespace
} // namespace ssrlab::test
