// Measures of what changes from frame to frame, against counts by hand.
#include "compare/measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Four rays side by side that hit at these columns; NaN: no hit.
TraceResult hits_at(const std::vector<double>& columns_px)
{
    TraceResult result = make_trace_result({static_cast<int>(columns_px.size()), 1}, false);
    for (size_t i = 0; i < columns_px.size(); ++i) {
        const bool hit         = columns_px[i] == columns_px[i];
        result.status[i]       = hit ? TraceStatus::hit : TraceStatus::left_screen;
        result.hit_px_depth[i] = {hit ? columns_px[i] : 0, 0.5, 0.1};
    }
    return result;
}

// Of four rays one is not traced in the second frame. Of the other three the first moves with the jitter alone, the second loses its
// hit, and the third jumps by 5 px.
TEST(SequenceMeasures, FlipsAreCountedWithoutTheJitter)
{
    const TraceResult before = hits_at({10, 20, 30, 40});
    TraceResult       now    = hits_at({12.4, nan, 35, 40});
    now.status[3]            = TraceStatus::not_traced;
    const Flips flips        = count_changes(hit_places(before, {0, 0}), hit_places(now, {0.5, 0}));
    EXPECT_EQ(flips.rays, 3U);
    EXPECT_EQ(flips.flips, 2U);
    EXPECT_EQ(count_changes(hit_places(before, {0, 0}), hit_places(now, {0, 0})).flips, 3U)
        << "2.4 px are more than 2 where the jitter is not taken out";
}

// Luma 0 and 1 in turn has a variance of 1/4 around 1/2; a pixel that stays has none: together the root of 1/8.
TEST(SequenceMeasures, TemporalDeviation)
{
    TemporalMoments   moments;
    const TraceResult traced = hits_at({1, 2});
    EXPECT_FALSE(temporal_rms(moments, 0));
    for (const float value : {0.0F, 1.0F, 0.0F, 1.0F})
        add_picture(moments, {{2, 1}, {"R", "G", "B"}, {value, value, value, 0.25F, 0.25F, 0.25F}, {}}, traced);
    ASSERT_TRUE(temporal_rms(moments, 4));
    EXPECT_NEAR(*temporal_rms(moments, 4), std::sqrt(0.125), 1e-6);
    EXPECT_FALSE(temporal_rms(moments, 5)) << "no pixel reflects in all of five frames";
}

// Six rays: one without an answer, one disoccluded, one whose hit is wrong, one without a vector, and two that count: off by 1 and 3 px.
TEST(SequenceMeasures, DistancesFromWhereReflectionsWere)
{
    using enum ReprojectionClass;
    const ReprojectionTruth      truth{{6, 1}, {unknown, hidden, seen, seen, seen, seen}, std::vector<glm::dvec2>(6)};
    const std::vector<glm::vec2> found  = {{9, 9}, {9, 9}, {9, 9}, {nan, nan}, {1, 0.5F}, {-2, 3}};
    const TraceResult            traced = hits_at({1, 2, 3, 4, 5, 6});
    SceneTruth                   scene;
    scene.size_px = {6, 1};
    scene.cls.assign(6, TruthClass::visible);
    for (double column : {1., 2., 30., 4., 5., 6.}) scene.point_px.emplace_back(column, 0.5);
    MeasureValues values = compare_reprojection(found, truth, traced, scene);
    EXPECT_EQ(values["reprojection_unknown_share"], 1.0 / 6);
    EXPECT_EQ(values["disocclusion_share"], 1.0 / 5);
    EXPECT_EQ(values["surface_motion_error_median_px"], 2.0);
    EXPECT_NEAR(*values["surface_motion_error_p95_px"], 2.9, 1e-12);
}

} // namespace
} // namespace ssrlab
