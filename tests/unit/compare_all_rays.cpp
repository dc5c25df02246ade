// Measures over all rays, on a floor whose reflections have closed forms.
#include "compare/all_rays.h"

#include "core/error.h"
#include "test.h"

namespace ssrlab {
namespace {

/// Two pixels that look straight ahead at 2 m, 100 px per unit of slope.
GBufferImage two_pixels(Projection projection = Projection::perspective)
{
    GBufferImage gbuffer;
    gbuffer.view.size_px    = {2, 1};
    gbuffer.view.projection = projection;
    gbuffer.view.focal_px   = {100, 100};
    gbuffer.view.centre_px  = {1, 0.5};
    gbuffer.view.near_m     = 0.1;
    gbuffer.view.far_m      = 10;
    const auto depth        = static_cast<float>(distance_to_depth(gbuffer.view, 2));
    gbuffer.depth           = {depth, depth};
    return gbuffer;
}

SceneTruth truth_of(glm::ivec2 size_px, TruthClass cls, glm::dvec3 point_vs)
{
    SceneTruth truth;
    truth.size_px  = size_px;
    const auto all = static_cast<size_t>(size_px.x) * static_cast<size_t>(size_px.y);
    truth.cls.assign(all, cls);
    truth.point_vs.assign(all, point_vs);
    return truth;
}

RayAnswer point_at(glm::dvec3 point_ws, bool certain = false)
{
    RayAnswer answer;
    answer.kind     = AnswerKind::point;
    answer.certain  = certain;
    answer.point_ws = point_ws;
    return answer;
}

TEST(AllRays, AnswersMayLieAPixelFromTheTruth)
{
    const GBufferImage gbuffer = two_pixels();
    // From about (0, 0, -2) sideways to (3, 0, -4): 5 m from the eye, so that 1 px covers 5 cm.
    const SceneTruth truth     = truth_of({2, 1}, TruthClass::off_screen, {3, 0, -4});
    const double     allowed_m = allowed_distance_m(truth, gbuffer, 0);
    // The depth is a rounded float, so the ray begins at nearly 2 m.
    const glm::dvec3 from = px_to_vs(gbuffer.view, {0.5, 0.5}, double(gbuffer.depth[0]));
    EXPECT_NEAR(from.z, -2, 1e-6);
    EXPECT_NEAR(allowed_m, 0.05 / std::sin(std::atan2(4, 3) - std::atan2(4 + from.z, 3 - from.x)), 1e-12);
    EXPECT_TRUE(is_right(point_at({3, 0.99 * allowed_m, -4}), truth, gbuffer, 0));
    EXPECT_FALSE(is_right(point_at({3, 1.01 * allowed_m, -4}), truth, gbuffer, 0));
}

TEST(AllRays, GrazingFootprintsAreBounded)
{
    const GBufferImage gbuffer = two_pixels();
    // Straight away from the eye: the ray has no extent on screen.
    const SceneTruth away = truth_of({2, 1}, TruthClass::hidden, {-0.01, 0, -4});
    EXPECT_NEAR(allowed_distance_m(away, gbuffer, 0), 0.04 / least_footprint_sine, 1e-4);
    // A point at the eye itself has the footprint of the near plane.
    const SceneTruth eye = truth_of({2, 1}, TruthClass::behind_camera, {0, 0, 0});
    EXPECT_NEAR(allowed_distance_m(eye, gbuffer, 0), 0.001, 1e-12);
    // Without perspective, a pixel covers the same everywhere.
    const SceneTruth aside = truth_of({2, 1}, TruthClass::hidden, {5, 0, -2});
    EXPECT_NEAR(allowed_distance_m(aside, two_pixels(Projection::orthographic), 0), 0.01, 1e-9);
}

TEST(AllRays, CountPointsAgainstWhatMeetsGeometry)
{
    GBufferImage gbuffer = two_pixels();
    gbuffer.view.size_px = {6, 1};
    gbuffer.depth.assign(6, gbuffer.depth[0]);
    SceneTruth truth = truth_of({6, 1}, TruthClass::visible, {3, 0, -4});
    truth.cls[3]     = TruthClass::sky;
    truth.cls[4]     = TruthClass::beyond;
    truth.cls[5]     = TruthClass::not_traced;
    std::vector<RayAnswer> answers(6);
    answers[0]           = point_at({3, 0, -4});
    answers[1]           = point_at({0, 0, -9}); // wrong
    answers[3]           = point_at({3, 0, -4}); // nothing is there
    const AllRays counts = compare_all_rays(answers, truth, gbuffer);
    EXPECT_EQ(counts.rays, 5U);
    EXPECT_EQ(counts.meeting, 3U);
    EXPECT_EQ(counts.points, 3U);
    EXPECT_EQ(counts.right, 1U);
    EXPECT_DOUBLE_EQ(*counts.recall, 1 / 3.0);
    EXPECT_DOUBLE_EQ(*counts.precision, 1 / 3.0);
    EXPECT_DOUBLE_EQ(*counts.f1, 1 / 3.0);
    EXPECT_THROW(compare_all_rays(std::span(answers).first(2), truth, gbuffer), Failure);
    const AllRays none = compare_all_rays(std::vector<RayAnswer>(6), truth_of({6, 1}, TruthClass::sky, {}), gbuffer);
    EXPECT_FALSE(none.recall.has_value() || none.precision.has_value() || none.f1.has_value());
}

TEST(AllRays, SourcesAreCountedByClass)
{
    const GBufferImage gbuffer = two_pixels();
    SceneTruth         truth   = truth_of({2, 1}, TruthClass::hidden, {3, 0, -4});
    truth.cls[1]               = TruthClass::sky;
    SourceTurn turn;
    turn.pixels         = {0, 1};
    turn.answers        = {point_at({3, 0, -4}, true), {.kind = AnswerKind::nothing, .certain = true}};
    SourceCounts counts = count_source(turn, truth, gbuffer);
    EXPECT_EQ(counts.handed, 2U);
    EXPECT_EQ(counts.meeting, 1U);
    EXPECT_EQ(counts.certain_points, 1U);
    EXPECT_EQ(counts.certain_right, 1U);
    EXPECT_EQ(counts.certain_nothing_right, 1U);
    EXPECT_EQ(counts.handed_of_class[size_t(TruthClass::hidden)], 1U);
    EXPECT_EQ(counts.right_of_class[size_t(TruthClass::hidden)], 1U);
    EXPECT_EQ(counts.right_of_class[size_t(TruthClass::sky)], 0U);
    turn.answers = {{.kind = AnswerKind::nothing, .certain = true}, point_at({3, 0, -4}, true)};
    counts       = count_source(turn, truth, gbuffer);
    EXPECT_EQ(counts.certain_points, 1U);
    EXPECT_EQ(counts.certain_right, 0U);
    EXPECT_EQ(counts.certain_nothing, 1U);
    EXPECT_EQ(counts.certain_nothing_right, 0U);
}

TEST(AllRays, CertainAnswersStand)
{
    const RayAnswer open{.kind = AnswerKind::open, .clear_m = 2}, sky{.kind = AnswerKind::nothing},
        guess = point_at({1, 0, 0}), sure = point_at({2, 0, 0}, true);
    EXPECT_EQ(merged(sure, guess), sure);
    EXPECT_EQ(merged(guess, sure), sure);
    EXPECT_EQ(merged(guess, point_at({3, 0, 0})).point_ws.x, 3);
    EXPECT_EQ(merged(open, guess), guess);
    EXPECT_EQ(merged(open, sky).kind, AnswerKind::nothing);
    EXPECT_EQ(merged(open, sky).clear_m, 2);
    EXPECT_EQ(merged(guess, sky).kind, AnswerKind::point); // an uncertain "nothing" proves no point wrong
    EXPECT_EQ(merged(guess, RayAnswer{.kind = AnswerKind::nothing, .certain = true}).kind, AnswerKind::nothing);
}

} // namespace
} // namespace ssrlab
