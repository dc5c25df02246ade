// Measures of what changes from frame to frame, against counts by hand.
#include "compare/measures.h"
#include "test.h"

namespace ssrlab {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Four rays side by side that hit at these columns; NaN: no hit.
TraceImage hits_at(const std::vector<double>& columns_px)
{
    TraceImage result = make_trace_image({static_cast<int>(columns_px.size()), 1}, false);
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
    const TraceImage before = hits_at({10, 20, 30, 40});
    TraceImage       now    = hits_at({12.4, nan, 35, 40});
    now.status[3]           = TraceStatus::not_traced;
    const Flips flips       = count_changes(hit_places(before, {0, 0}), hit_places(now, {0.5, 0}));
    EXPECT_EQ(flips.rays, 3U);
    EXPECT_EQ(flips.flips, 2U);
    EXPECT_EQ(count_changes(hit_places(before, {0, 0}), hit_places(now, {0, 0})).flips, 3U)
        << "2.4 px are more than 2 where the jitter is not taken out";
}

// Luma 0 and 1 in turn has a variance of 1/4 around 1/2; a pixel that stays has none: together the root of 1/8.
TEST(SequenceMeasures, TemporalDeviation)
{
    TemporalMoments  moments;
    const TraceImage traced = hits_at({1, 2});
    EXPECT_FALSE(temporal_rms(moments, 0));
    for (const float value : {0.0F, 1.0F, 0.0F, 1.0F})
        add_picture(moments, {{2, 1}, {"R", "G", "B"}, {value, value, value, 0.25F, 0.25F, 0.25F}, {}}, traced);
    ASSERT_TRUE(temporal_rms(moments, 4));
    EXPECT_NEAR(*temporal_rms(moments, 4), std::sqrt(0.125), 1e-6);
    EXPECT_FALSE(temporal_rms(moments, 5)) << "no pixel reflects in all of five frames";
}

TEST(SequenceMeasures, WhatWasOffTheScreenIsDisoccludedToo)
{
    using enum ReprojectionClass;
    const ReprojectionTruth truth{{5, 1}, {hidden, off_screen, seen, unknown, seen}, std::vector<glm::dvec2>(5)};
    EXPECT_EQ(count_disocclusions(truth)["disocclusion_share"], 2.0 / 4);
}

// Six rays: one without an answer, one disoccluded, one whose hit is wrong, one without a vector, and two that count: off by 1 and 3 px.
TEST(SequenceMeasures, DistancesFromWhereReflectionsWere)
{
    using enum ReprojectionClass;
    const ReprojectionTruth      truth{{6, 1}, {unknown, hidden, seen, seen, seen, seen}, std::vector<glm::dvec2>(6)};
    const std::vector<glm::vec2> found  = {{9, 9}, {9, 9}, {9, 9}, {nan, nan}, {1, 0.5F}, {-2, 3}};
    const TraceImage             traced = hits_at({1, 2, 3, 4, 5, 6});
    SceneTruth                   scene;
    scene.size_px = {6, 1};
    scene.cls.assign(6, TruthClass::visible);
    for (double column : {1., 2., 30., 4., 5., 6.}) scene.point_px.emplace_back(column, 0.5);
    MeasureValues values = count_disocclusions(truth);
    EXPECT_EQ(values["reprojection_unknown_share"], 1.0 / 6);
    EXPECT_EQ(values["disocclusion_share"], 1.0 / 5);
    MeasureValues surface = compare_surface_motion(found, truth, traced, scene);
    EXPECT_EQ(surface["surface_motion_error_median_px"], 2.0);
    EXPECT_NEAR(*surface["surface_motion_error_p95_px"], 2.9, 1e-12);
    MeasureValues reprojection = compare_reprojection(found, truth, traced, scene);
    EXPECT_EQ(reprojection["reprojection_error_median_px"], 2.0);
    EXPECT_NEAR(*reprojection["reprojection_error_p95_px"], 2.9, 1e-12);
    EXPECT_EQ(reprojection["reprojection_found_share"], 2.0 / 3);
}

/// Grey pixels side by side whose sRGB-encoded values are these: sRGB is linear / 12.92 up to 0.04045.
Image shown_as(const std::vector<float>& display)
{
    Image image{{static_cast<int>(display.size()), 1}, {"R", "G", "B"}, {}, {}};
    for (const float value : display) image.values.insert(image.values.end(), 3, value / 12.92F);
    return image;
}

// A ghost counts where the true point is visible now and its reflection was hidden earlier: of five pixels the first two. They are off
// by 0.03 and 0.01, so the root of the mean square is the root of 0.0005.
TEST(SequenceMeasures, GhostsAreLookedForBehindMovingEdges)
{
    using enum ReprojectionClass;
    const ReprojectionTruth earlier{{5, 1}, {hidden, hidden, seen, off_screen, hidden}, std::vector<glm::dvec2>(5)};
    SceneTruth              scene;
    scene.size_px = {5, 1};
    scene.cls.assign(5, TruthClass::visible);
    scene.cls[4]           = TruthClass::hidden;
    const Image     tested = shown_as({0.03F, 0.02F, 0.04F, 0.04F, 0.04F});
    const Reference reference(shown_as({0, 0.01F, 0, 0, 0}));
    EXPECT_NEAR(compare_ghosts(tested, reference, earlier, scene).at("ghosting_rmse").value(), std::sqrt(0.0005), 1e-6);
    scene.cls.assign(5, TruthClass::hidden);
    EXPECT_FALSE(compare_ghosts(tested, reference, earlier, scene).at("ghosting_rmse"));
}

// Three of four pixels reflect; they are off by 0.01, 0.02 and 0.02: the root of 0.0003.
TEST(SequenceMeasures, DistanceFromTheConvergedPicture)
{
    SceneTruth scene;
    scene.size_px = {4, 1};
    scene.cls.assign(4, TruthClass::sky);
    scene.cls[3] = TruthClass::not_traced;
    const Reference     converged(shown_as({0.02F, 0.02F, 0, 0}));
    const MeasureValues values = compare_converged(shown_as({0.03F, 0, 0.02F, 0.04F}), converged, scene);
    EXPECT_NEAR(values.at("converged_rmse").value(), std::sqrt(0.0003), 1e-6);
}

} // namespace
} // namespace ssrlab
