// Ray measures and pictures on hand-made results of a few pixels, with exact shares.
#include "compare/causes.h"
#include "compare/measures.h"
#include "compare/pictures.h"
#include "core/error.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using namespace test;

TraceImage row_of(int count)
{
    TraceImage result;
    result.size_px = {count, 1};
    result.status.assign(size_t(count), TraceStatus::left_screen);
    result.hit_pixel.resize(size_t(count));
    result.hit_layer.resize(size_t(count));
    result.hit_px_depth.resize(size_t(count));
    result.hit_t.resize(size_t(count));
    result.steps.assign(size_t(count), 3);
    return result;
}

void set_hit(TraceImage& result, size_t i, double x_px, double depth = 0.05)
{
    result.status[i]       = TraceStatus::hit;
    result.hit_pixel[i]    = {int(x_px), 0};
    result.hit_px_depth[i] = {x_px, 0.5, depth};
}

template <typename... Expected> void expect_values(const MeasureValues& values, const Expected&... expected)
{
    expect_each([&](const char* name) { return values.at(name); }, expected...);
}

TEST(RayMeasures, AgainstScreenTruth)
{
    TraceImage truth = row_of(10), tested = row_of(10);
    truth.status[0] = tested.status[0] = TraceStatus::not_traced;
    for (const size_t i : {1, 2, 3, 4, 5}) set_hit(truth, i, 2.25);
    set_hit(tested, 1, 2.75);                     // same pixel, 0.5 px
    set_hit(tested, 2, 3.25);                     // neighbour, exactly 1 px: within
    set_hit(tested, 3, 6.25);                     // displaced by 4 px
    tested.status[4] = TraceStatus::out_of_steps; // missed
    set_hit(tested, 6, 5.5);                      // false
    const MeasureValues values = compare_to_screen_truth(tested, truth);
    // screen_same_pixel: 1, and the common misses 7, 8, 9
    // screen_missed: 4 and 5
    expect_values(values, "traced_rays", 9, "screen_same_pixel", 4 / 9.0, "screen_within_1px", 5 / 9.0,
                  "screen_displaced", 1 / 9.0, "screen_missed", 2 / 9.0, "screen_false", 1 / 9.0, "screen_out_of_steps",
                  1 / 9.0, "screen_recall_1px", 2 / 5.0, "screen_precision_1px", 2 / 4.0, "screen_f1_1px", 4 / 9.0,
                  "screen_displacement_median_px", 1);
    EXPECT_DOUBLE_EQ(values.at("screen_displacement_p95_px").value(), 3.7); // nine tenths of the way from 1 to 4
    EXPECT_DOUBLE_EQ(values.at("screen_displacement_p99_px").value(), 3.94);
}

// Hits on a lattice are often exactly 1 px from the truth: rounding must not decide what counts.
TEST(RayMeasures, ATieWithinRoundingIsFound)
{
    for (const double off_px : {-1e-4, 0.0, 1e-4, 1e-2}) {
        TraceImage truth = row_of(2), tested = row_of(2);
        set_hit(truth, 1, 0.25);
        set_hit(tested, 1, 1.25 + off_px);
        EXPECT_EQ(compare_to_screen_truth(tested, truth).at("screen_recall_1px"), off_px < 1e-3 ? 1 : 0) << off_px;
    }
}

TEST(RayMeasures, DistanceIsTheLargerOfTwo)
{
    EXPECT_EQ(screen_distance_px({1, 2}, {1.75, 1.25}), 0.75);
    EXPECT_EQ(screen_distance_px({0, 0}, {-3, 2}), 3);
    EXPECT_EQ(screen_distance_px({0, 0}, {1, -4}), 4);
}

TEST(RayMeasures, WhatTheSecondLayerAdds)
{
    TraceImage first = row_of(10), second = row_of(10);
    second.status.assign(10, TraceStatus::not_traced);
    SceneTruth truth;
    truth.size_px = {10, 1};
    truth.cls     = {TruthClass::not_traced, TruthClass::hidden,    TruthClass::hidden,  TruthClass::hidden,
                     TruthClass::hidden,     TruthClass::hidden,    TruthClass::visible, TruthClass::visible,
                     TruthClass::sky,        TruthClass::off_screen};
    truth.point_px.assign(10, {20.25, 0.5});
    first.status[0] = TraceStatus::not_traced;
    set_hit(second, 1, 21.25); // exactly 1 px: recovered
    set_hit(second, 2, 20.5);  // recovered
    set_hit(second, 3, 25);    // filled with the wrong thing; 4 stays a ghost
    set_hit(first, 5, 3);      // a hit in the first layer, wrong or not, is no ghost
    set_hit(second, 6, 20.25); // visible, missed in the first layer: right, but not hidden
    set_hit(first, 7, 20.25);
    set_hit(second, 8, 20.25); // there is nothing to be seen
    const MeasureValues values = compare_hidden_layer(first, second, truth);
    // ghost_share: 1, 2, 3, 4 and 6
    expect_values(values, "hidden_recovered_share", 2 / 5.0, "ghost_share", 5 / 9.0, "ghost_removed_share", 4 / 5.0,
                  "hidden_layer_hits", 5 / 9.0, "hidden_layer_wrong", 2 / 5.0);
    TraceImage other = row_of(9);
    EXPECT_THROW(compare_hidden_layer(first, other, truth), Failure);
}

TEST(RayMeasures, NothingTracedHasNoValues)
{
    TraceImage none = row_of(4);
    none.status.assign(4, TraceStatus::not_traced);
    SceneTruth scene;
    scene.size_px = {4, 1};
    scene.cls.resize(4);
    scene.point_px.resize(4);
    scene.radiance.resize(4);
    MeasureValues all = no_measures();
    merge(all, compare_to_screen_truth(none, none));
    merge(all, compare_to_scene_truth(none, scene, &none, empty_gbuffer(bench_view({4, 1}))));
    merge(all, count_causes(none, scene, empty_gbuffer(bench_view({4, 1}))));
    merge(all, compare_hidden_layer(none, none, scene));
    merge(all, split_error(none, &none, &none, &scene));
    merge(all, count_work(none));
    merge(all, compare_images(reference_image(scene), Reference(reference_image(scene)), scene));
    for (const auto& [name, value] : all) {
        if (name == "traced_rays") {
            EXPECT_EQ(value, 0);
        } else {
            EXPECT_FALSE(value) << name;
        }
    }
}

/// Sixteen rays that start from a plane facing the camera at Z = 2, objects 1 (pixels 0..7) and 2 (8..15), except pixel 9 at Z = 1.
struct SceneCase {
    GBufferImage gbuffer = empty_gbuffer(bench_view({16, 1}));
    SceneTruth   truth;
    TraceImage   tested = row_of(16), screen = row_of(16);

    SceneCase()
    {
        for (int x = 0; x < 16; ++x) {
            set_pixel(gbuffer, x, 0, x == 9 ? 1 : 2, {0, 0, 1}, 1);
            gbuffer.object_id[size_t(x)] = x < 8 ? 1 : 2;
        }
        truth.size_px = {16, 1};
        truth.cls.assign(16, TruthClass::not_traced);
        truth.point_px.assign(16, {12.25, 0.5});
    }
};

TEST(RayMeasures, AgainstSceneTruth)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    for (const size_t i : {0, 1, 2, 3, 4, 5}) truth.cls[i] = TruthClass::visible;
    truth.cls[6] = TruthClass::hidden;
    truth.cls[7] = TruthClass::sky;
    set_hit(tested, 0, 12.5);        // found
    set_hit(tested, 1, 15.25, 0.05); // displaced by 3 px; Z = 2 = the surface: a wrong front
    set_hit(screen, 2, 12.25);       // stepped over
    tested.status[3] = TraceStatus::out_of_steps;
    tested.status[4] = TraceStatus::facing_away;
    set_hit(tested, 6, 9.5, 0.1 / 1.5); // ray at Z = 1.5 behind the surface at Z = 1: slab too thick
    set_hit(tested, 7, 3.5, 0.05);      // object 1, in its own plane: a self-hit
    const MeasureValues values = compare_to_scene_truth(tested, truth, &screen, gbuffer);
    expect_values(values, "traced_rays", 8, "recall_1px", 1 / 6.0, "recall_4px", 2 / 6.0, "visible_displaced", 1 / 6.0,
                  "missed_stepped_over", 1 / 6.0, "missed_out_of_steps", 1 / 6.0, "missed_facing_rule", 1 / 6.0,
                  "missed_not_in_depth", 1 / 6.0, "missed_stopped", 0, "stopped_right_share", std::nullopt,
                  "precision_1px", 1 / 4.0, "f1_1px", 2 / 10.0, "false_hits", 3 / 8.0, "false_self", 1 / 8.0,
                  "false_too_thick", 1 / 8.0, "false_wrong_surface", 1 / 8.0, "truth_visible", 6 / 8.0, "truth_hidden",
                  1 / 8.0, "truth_sky", 1 / 8.0, "truth_off_screen", 0);
    // Without a screen truth the two causes that it tells apart are not known, and nothing else changes.
    for (const auto& [name, value] : compare_to_scene_truth(tested, truth, nullptr, gbuffer)) {
        const bool unknown = name == "missed_stepped_over" || name == "missed_not_in_depth";
        EXPECT_EQ(value, unknown ? std::nullopt : values.at(name)) << name;
    }
}

// A stop is no miss. A hidden point counts as found in a layer behind the first alone: in the first the pixel shows what hides it.
TEST(RayMeasures, StopsAndHiddenPoints)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    gbuffer.layers.push_back(gbuffer);
    for (const size_t i : {0, 1}) truth.cls[i] = TruthClass::visible;
    for (const size_t i : {2, 3}) truth.cls[i] = TruthClass::hidden;
    set_hit(tested, 0, 12.5);
    tested.status[1] = TraceStatus::stopped;
    for (const size_t i : {2, 3}) set_hit(tested, i, 12.5);
    tested.hit_layer[3] = 1;
    expect_values(compare_to_scene_truth(tested, truth, &screen, gbuffer), "recall_1px", 1 / 2.0, "missed_stopped",
                  1 / 2.0, "missed_not_in_depth", 0, "stopped_right_share", 0, "hidden_too_recall_1px", 2 / 4.0,
                  "hidden_too_precision_1px", 2 / 3.0, "hidden_too_f1_1px", 4 / 7.0);
}

TEST(RayMeasures, ASelfHitIsOfTheSameObject)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    for (const size_t i : {0, 1, 2}) truth.cls[i] = TruthClass::sky;
    set_hit(tested, 0, 3.5);
    for (const size_t i : {1, 2}) set_hit(tested, i, 14.5); // in the same plane
    expect_values(compare_to_scene_truth(tested, truth, &screen, gbuffer), "false_self", 1 / 3.0, "false_wrong_surface",
                  2 / 3.0);
}

// Across 12 m the sine of the angle to the plane is 0.005 for a hit 6 cm before it, and 0.025 for one 30 cm before it.
TEST(RayMeasures, ASelfHitLiesNearlyInThePlane)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    set_pixel(gbuffer, 3, 0, 1.94, {0, 0, 1}, 1);
    set_pixel(gbuffer, 4, 0, 1.7, {0, 0, 1}, 1);
    for (const size_t i : {0, 1}) {
        truth.cls[i] = TruthClass::sky;
        set_hit(tested, i, 3.5 + double(i));
    }
    expect_values(compare_to_scene_truth(tested, truth, &screen, gbuffer), "false_hits", 1, "false_self", 1 / 2.0);
}

// What is found is counted of what the better of the two finds.
TEST(RayMeasures, ErrorsAreSharesOfTheBetterResult)
{
    TraceImage found = row_of(8), twin = found, screen = found;
    set_hit(found, 0, 12.5);
    for (size_t i = 0; i < 2; ++i) set_hit(twin, i, 12.5);
    for (size_t i = 0; i < 8; ++i) set_hit(screen, i, 12.5);
    const MeasureValues values = split_error(found, &twin, &screen, nullptr);
    expect_values(values, "error_double_to_float", 1 / 2.0, "error_screen_to_double", 6 / 8.0);
    found.status[7] = TraceStatus::not_traced; // traced in one alone: it counts, and has flipped
    EXPECT_EQ(count_flips(found, twin), 2e6 / 8);
}

// The second layer lies at Z = 4: a ray at Z = 3 is behind the first and in front of the second.
TEST(RayMeasures, AFalseHitIsJudgedByItsOwnLayer)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    gbuffer.layers.push_back(gbuffer);
    for (int x = 0; x < 16; ++x) set_pixel(gbuffer.layers[0], x, 0, 4, {0, 0, 1}, 1);
    for (const size_t i : {0, 1}) {
        truth.cls[i] = TruthClass::sky;
        set_hit(tested, i, 12.5, 0.1 / 3);
    }
    tested.hit_layer[1] = 1;
    expect_values(compare_to_scene_truth(tested, truth, &screen, gbuffer), "false_too_thick", 1 / 2.0,
                  "false_wrong_surface", 1 / 2.0, "false_self", 0);
}

// Seen from its back, an object reflects on that side: pixel 9 at Z = 1 is before its plane, pixel 10 at Z = 4 behind it.
TEST(RayMeasures, TheSideOfAReflectorIsTheOneThatIsSeen)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    set_pixel(gbuffer, 10, 0, 4, {0, 0, 1}, 1);
    for (const size_t i : {8, 11, 12}) {
        truth.cls[i]         = TruthClass::sky;
        gbuffer.normal_vs[i] = {0, 0, -1};
    }
    set_hit(tested, 8, 9.5, 0.1);
    set_hit(tested, 12, 9.5, 0.1);
    set_hit(tested, 11, 10.5, 0.1 / 4);
    expect_values(compare_to_scene_truth(tested, truth, &screen, gbuffer), "false_self", 1 / 3.0, "false_wrong_surface",
                  2 / 3.0);
}

TEST(RayMeasures, SplitAndFlips)
{
    SceneCase test;
    auto& [gbuffer, truth, tested, screen] = test;
    for (size_t i = 0; i < 4; ++i) truth.cls[i] = TruthClass::visible;
    TraceImage twin = row_of(16);
    for (size_t i = 0; i < 3; ++i) set_hit(screen, i, 12.25); // 3 of 4 visible
    for (size_t i = 0; i < 2; ++i) set_hit(twin, i, 12.75);   // 2 of 3
    set_hit(tested, 0, 14.5);                                 // 0 of 2: displaced, missed
    const MeasureValues values = split_error(tested, &twin, &screen, &truth);
    EXPECT_DOUBLE_EQ(values.at("error_scene_to_screen").value(), 1 / 4.0);
    EXPECT_DOUBLE_EQ(values.at("error_screen_to_double").value(), 1 / 3.0);
    EXPECT_DOUBLE_EQ(values.at("error_double_to_float").value(), 1);
    EXPECT_DOUBLE_EQ(values.at("flips_per_million").value(), 2e6 / 16);
    EXPECT_EQ(count_flips(twin, twin), 0);
    EXPECT_TRUE(split_error(tested, nullptr, &screen, nullptr).empty());
    const MeasureValues alone = split_error(tested, &twin, nullptr, &truth);
    EXPECT_EQ(alone.size(), 2U);
    EXPECT_EQ(alone.at("error_double_to_float"), values.at("error_double_to_float"));
    EXPECT_EQ(alone.at("flips_per_million"), values.at("flips_per_million"));
}

TEST(RayMeasures, WorkIsCountedPerTracedRay)
{
    TraceImage result    = row_of(4);
    result.status[0]     = TraceStatus::not_traced;
    result.steps         = {0, 1, 2, 6};
    MeasureValues values = count_work(result);
    expect_values(values, "steps_mean", 3, "steps_max", 6);
    EXPECT_FALSE(values.at("depth_fetches_mean"));
    result.depth_fetches = {0, 0, 3, 3};
    EXPECT_EQ(count_work(result).at("depth_fetches_mean"), 2);
}

TEST(RayMeasures, AGroupWaitsForItsLongestRay)
{
    // Pixels 0 to 99, traced backwards: pixel 99 - i is ray i.
    TraceImage result = row_of(100);
    result.steps.assign(100, 1);
    for (size_t i = 0; i < 100; ++i) result.traced_order.push_back(99 - i);
    result.steps[99] = 10; // ray 0
    result.steps[67] = 7;  // ray 32
    result.steps[35] = 20; // ray 64
    result.steps[3]  = 31; // ray 96, of four in the last group
    EXPECT_EQ(count_work(result).at("warp32_iterations_mean"), (10 + 7 + 20 + 31) / 4.0);
    EXPECT_EQ(count_work(result).at("wave64_iterations_mean"), (10 + 31) / 2.0);
    EXPECT_EQ(count_work(result).at("wave128_iterations_mean"), 31);
    std::ranges::reverse(result.traced_order); // ray i is pixel i: 3 | 35 | 67 | 99
    EXPECT_EQ(count_work(result).at("warp32_iterations_mean"), (31 + 20 + 7 + 10) / 4.0);
    EXPECT_EQ(count_work(result).at("wave64_iterations_mean"), (31 + 10) / 2.0);
    std::swap(result.traced_order[3], result.traced_order[40]); // the longest goes to the second group of 32
    EXPECT_EQ(count_work(result).at("warp32_iterations_mean"), (1 + 31 + 7 + 10) / 4.0);
    EXPECT_EQ(count_work(result).at("wave64_iterations_mean"), (31 + 10) / 2.0);
    result.traced_order.clear();
    EXPECT_FALSE(count_work(result).at("wave64_iterations_mean"));
}

TEST(RayMeasures, DifferentSizesAreRefused)
{
    EXPECT_THROW(compare_to_screen_truth(row_of(3), row_of(4)), Failure);
    EXPECT_THROW(count_flips(row_of(3), row_of(4)), Failure);
}

TEST(Measures, TableIsCompleteAndUnique)
{
    std::set<std::string_view> names;
    for (const Measure& measure : measures()) {
        EXPECT_TRUE(names.insert(measure.name).second) << measure.name;
        EXPECT_FALSE(measure.unit.empty() || measure.formula.empty() || measure.source.empty()) << measure.name;
        EXPECT_EQ(measure.formula.find('|'), std::string_view::npos) << measure.name;
    }
    // Every value that a function returns has its row, and every row a function.
    SceneCase     test;
    MeasureValues all = compare_to_screen_truth(test.tested, test.screen);
    all.merge(compare_to_scene_truth(test.tested, test.truth, &test.screen, test.gbuffer));
    all.merge(count_causes(test.tested, test.truth, test.gbuffer));
    all.merge(compare_hidden_layer(test.tested, test.screen, test.truth));
    all.merge(split_error(test.tested, &test.tested, &test.screen, &test.truth));
    all.merge(count_work(test.tested));
    all.merge(compare_depth_to_scene(test.truth));
    test.truth.radiance.resize(16);
    const Reference reference(reference_image(test.truth));
    all.merge(compare_images(reference_image(test.truth), reference, test.truth));
    all.merge(compare_pictures(reference_image(test.truth), reference, test.truth, test.gbuffer));
    all.merge(count_not_finite(reference_image(test.truth), nullptr));
    set_hit(test.tested, 0, 12.5); // found, so that its vector counts
    test.truth.cls[0]                 = TruthClass::visible;
    const size_t                 rays = test.tested.status.size();
    const ReprojectionTruth      unmoved{test.tested.size_px, std::vector(rays, ReprojectionClass::seen),
                                    std::vector<glm::dvec2>(rays)};
    const std::vector<glm::vec2> unmoved_px(rays);
    all.merge(count_disocclusions(unmoved));
    all.merge(compare_surface_motion(unmoved_px, unmoved, test.tested, test.truth));
    all.merge(compare_reprojection(unmoved_px, unmoved, test.tested, test.truth));
    all.merge(compare_ghosts(reference_image(test.truth), reference, unmoved, test.truth));
    all.merge(compare_converged(reference_image(test.truth), reference, test.truth));
    std::set<std::string_view> filled;
    for (const auto& [name, value] : all) filled.insert(name);
    filled.insert({"steps_max"});                             // only with rays
    filled.insert({"all_recall", "all_precision", "all_f1"}); // of sources: the tests of the program compare them
    filled.insert({"flip_share"});                            // of two frames
    filled.insert({"history_share", "clamped_share"});        // counted by the pass
    std::vector<std::string_view> on_one_side;
    std::ranges::set_symmetric_difference(filled, names, std::back_inserter(on_one_side));
    EXPECT_THAT(on_one_side, testing::IsEmpty());
    EXPECT_NE(measures_markdown().find("| `recall_1px` | share |"), std::string::npos);
}

TEST(Pictures, AgreementColours)
{
    TraceImage truth = row_of(6), tested = row_of(6);
    truth.status[0] = TraceStatus::not_traced;
    for (const size_t i : {1, 2, 3}) set_hit(truth, i, 20.25);
    set_hit(tested, 1, 20.5);
    set_hit(tested, 2, 30.5);
    set_hit(tested, 4, 1.5);
    const Image image  = agreement_picture(tested, truth);
    const auto  colour = [&](size_t i) {
        return glm::vec3(image.values[3 * i], image.values[3 * i + 1], image.values[3 * i + 2]);
    };
    EXPECT_EQ(colour(0), glm::vec3(0));
    EXPECT_TRUE(colour(1).g > colour(1).r && colour(1).g > colour(1).b);         // green
    EXPECT_TRUE(colour(2).r > 0.5F && colour(2).g > 0.5F);                       // yellow
    EXPECT_TRUE(colour(3).r > 0.5F && colour(3).g < 0.2F && colour(3).b < 0.1F); // orange
    EXPECT_TRUE(colour(4).r > 0.5F && colour(4).b > 1.5F * colour(4).g);         // pink
    EXPECT_TRUE(colour(5).r < 0.2F && colour(5).r > 0);                          // grey
    SceneTruth scene;
    scene.size_px = {6, 1};
    scene.cls     = {TruthClass::not_traced, TruthClass::visible, TruthClass::visible,
                     TruthClass::visible,    TruthClass::hidden,  TruthClass::sky};
    scene.point_px.assign(6, {20.25, 0.5});
    EXPECT_EQ(agreement_picture(tested, scene).values, image.values);
}

TEST(Pictures, HeatMapGrowsWithFetches)
{
    TraceImage result        = row_of(4);
    result.depth_fetches     = {0, 1, 4096, 100000};
    result.structure_fetches = {{"depth_pyramid", {0, 0, 0, 0}}};
    const Image image        = fetch_heat_map(result);
    EXPECT_EQ(image.values[0] + image.values[1] + image.values[2], 0);
    const auto brightness = [&](size_t i) {
        return image.values[3 * i] + image.values[3 * i + 1] + image.values[3 * i + 2];
    };
    EXPECT_GT(brightness(1), 0);
    EXPECT_GT(brightness(2), 5 * brightness(1));
    EXPECT_EQ(brightness(3), brightness(2));
}

TEST(Pictures, FlipIsBlackOutsideAndGrowsInside)
{
    const Image image = flip_picture({3, 1}, {0.5F, 0.1F, 0.9F}, {0, 1, 1});
    EXPECT_EQ(image.values[0] + image.values[1] + image.values[2], 0);
    EXPECT_GT(image.values[3], 0);
    EXPECT_GT(image.values[6], image.values[3]);
}

} // namespace
} // namespace ssrlab
