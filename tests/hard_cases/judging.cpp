// The judge, on rays whose verdict is obvious.
#include "check/judge.h"
#include "core/plane_gradient.h"
#include "test.h"

namespace ssrlab::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Poles at 4 m in columns 20 and 30; a ray at 4.5 m to the right in row 10 from (5.5, 10.5) by 50 px.
ssrlab::Setup two_poles(double thickness_m = 1)
{
    ssrlab::Setup setup{{},
                        picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 20 || p.x == 30 ? 4.0 : 0.0; }),
                        boxes({.thickness_m = thickness_m, .max_distance_m = 100}),
                        {}};
    setup.rays = {level_ray(setup.gbuffer.view, {5.5, 10.5}, {50, 0}, 4.5)};
    return setup;
}

RayOutcome hit(glm::ivec2 pixel, double t) { return {TraceStatus::hit, pixel, t}; }
RayOutcome miss() { return {TraceStatus::left_screen}; }

TEST(Judge, TheExactAnswerIsRight)
{
    const auto  setup = two_poles();
    const Judge judge(setup);
    EXPECT_EQ(judge.exact_answer(setup.rays[0]).hit_pixel, glm::ivec2(20, 10));
    EXPECT_EQ(judge.walk(setup.rays[0]).size(), 50U);
    EXPECT_EQ(judge.judge(setup.rays[0], hit({20, 10}, 14.5 / 50), {}).verdict, Verdict::right);
    EXPECT_NEAR(judge.judge(setup.rays[0], hit({20, 10}, 15.0 / 50), {}).deviation_px, 0.5, 1e-6);
}

TEST(Judge, ASkippedSurfaceIsWrongUnlessTheLimitsAllowIt)
{
    const auto  setup = two_poles();
    const Judge judge(setup);
    EXPECT_THAT(judge.judge(setup.rays[0], miss(), {}).reason,
                HasSubstr("the ray meets the slab in (20, 10), 0.500 px inside"));
    EXPECT_EQ(judge.judge(setup.rays[0], hit({30, 10}, 24.5 / 50), {}).verdict, Verdict::wrong);
    EXPECT_EQ(judge.judge(setup.rays[0], hit({30, 10}, 24.5 / 50), {.may_miss_between_samples = true}).verdict,
              Verdict::allowed);
    // Nothing was passed behind before the first pole.
    EXPECT_EQ(judge.judge(setup.rays[0], miss(), {.may_miss_behind_objects = true}).verdict, Verdict::wrong);
}

TEST(Judge, AHitThatIsNoneIsWrongWhateverTheLimits)
{
    const auto  setup = two_poles(0.1); // the ray passes behind both
    const Judge judge(setup);
    for (const bool sampled : {false, true}) {
        const Claim claim{.may_miss_between_samples = sampled, .may_miss_behind_objects = sampled};
        EXPECT_THAT(judge.judge(setup.rays[0], hit({20, 10}, 14.5 / 50), claim).reason,
                    HasSubstr("does not meet the slab"));
        EXPECT_THAT(judge.judge(setup.rays[0], hit({20, 12}, 14.5 / 50), claim).reason, HasSubstr("does not cross"));
        EXPECT_EQ(judge.judge(setup.rays[0], miss(), claim).verdict, Verdict::right);
    }
    const auto thick = two_poles();
    EXPECT_THAT(Judge(thick).judge(thick.rays[0], hit({20, 10}, 0.9), {}).reason,
                HasSubstr("but the ray is in that pixel from"));
}

// A ray that goes from 4 m to 6 m deep leaves the slab depths of the pole at 4 m 7.8 px before it: a step of 8.2 px bridges that, one of 6.1 px does not.
TEST(Judge, WholeStepsReachNoFartherThanAStep)
{
    auto setup    = two_poles(0.5);
    setup.gbuffer = picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 30 ? 4.0 : 0.0; });
    setup.rays    = {ray_between(setup.gbuffer.view, {5.5, 10.5, 4.0}, {55.5, 10.5, 6.0})};
    const Judge judge(setup);
    // Depth is linear in 1/z: at t = 1/3, 7.8 px before column 30, the ray leaves the slab's depths.
    const Claim whole_steps{.may_hit_within_a_step = true};
    auto        outcome = hit({30, 10}, 24.5 / 50);
    outcome.steps       = 3;
    EXPECT_EQ(judge.judge(setup.rays[0], outcome, whole_steps).verdict, Verdict::allowed);
    EXPECT_EQ(judge.judge(setup.rays[0], outcome, {}).verdict, Verdict::wrong);
    outcome.steps = 4;
    EXPECT_THAT(judge.judge(setup.rays[0], outcome, whole_steps).reason, HasSubstr("does not meet the slab"));
}

// A ray lies on its own plane where it begins; no step reaches back to there.
TEST(Judge, WholeStepsBeginBehindTheStartPixel)
{
    auto       setup   = two_poles();
    const View view    = setup.gbuffer.view;
    const auto floor_m = [&](double y_px) { return std::max(0.0, view.focal_px.y / (y_px - view.centre_px.y)); };
    setup.gbuffer      = picture_of(view, [&](glm::ivec2 p) { return floor_m(p.y + 0.5); });
    for (glm::vec3& normal : setup.gbuffer.normal_vs) normal = {0, 1, 0};
    complete_gradients(setup.gbuffer);
    setup.settings.surface = "plane";
    setup.settings.behind  = Behind::stop;
    const int    y         = view.size_px.y - 4;
    const double start_m   = floor_m(y + 0.5);
    setup.rays             = {ray_between(view, {20.5, y + 0.5, start_m}, {20.5, y - 9.5, 2 * start_m})};
    RayOutcome outcome     = hit({20, y - 1}, 0.1);
    outcome.steps          = 1;
    EXPECT_EQ(Judge(setup).judge(setup.rays[0], outcome, {.may_hit_within_a_step = true}).verdict, Verdict::wrong);
}

TEST(Judge, GrazingAPixelByLessThanASliverDecidesNothing)
{
    auto setup    = two_poles();
    setup.gbuffer = picture_of(bench_view(), [](glm::ivec2 p) { return p == glm::ivec2(20, 11) ? 4.0 : 0.0; });
    // In row 10, falling to 0.03 px below its border with row 11 in column 20.
    setup.rays = {ray_between(setup.gbuffer.view, {10.5, 10.53, 4.5}, {20.97, 11.03, 4.5})};
    const Judge judge(setup);
    EXPECT_EQ(judge.exact_answer(setup.rays[0]).status, TraceStatus::hit);
    EXPECT_EQ(judge.judge(setup.rays[0], miss(), {}).verdict, Verdict::sliver);
}

// From behind, the ray meets the farther of two layers first.
TEST(Judge, AHitOfTheLayerThatIsMetLaterIsWrong)
{
    auto       setup = two_poles();
    const auto pole  = [](double distance_m) {
        return picture_of(bench_view(), [=](glm::ivec2 p) { return p == glm::ivec2(20, 10) ? distance_m : 0.0; });
    };
    setup.gbuffer         = pole(4);
    setup.gbuffer.layers  = {pole(5)};
    setup.settings.layers = 2;
    setup.rays            = {ray_between(setup.gbuffer.view, {19.5, 10.5, 9}, {21.5, 10.5, 3})};
    const Judge judge(setup);
    RayOutcome  outcome = judge.exact_answer(setup.rays[0]);
    ASSERT_EQ(outcome.status, TraceStatus::hit);
    EXPECT_EQ(outcome.hit_layer, 1);
    EXPECT_EQ(judge.judge(setup.rays[0], outcome, {}).verdict, Verdict::right);
    outcome.hit_layer = 0;
    outcome.t += 0.125;
    EXPECT_THAT(judge.judge(setup.rays[0], outcome, {}).reason, HasSubstr("layer 1 of that pixel before"));
}

/// The same with every normal turned toward the ray or away from it.
ssrlab::Setup two_poles_facing(double z)
{
    auto setup            = two_poles();
    setup.settings.behind = Behind::pass;
    setup.rays[0]         = ray_between(setup.gbuffer.view, {5.5, 10.5, 4.2}, {55.5, 10.5, 4.8});
    for (glm::vec3& normal : setup.gbuffer.normal_vs) normal = {0, 0, z};
    return setup;
}

TEST(Judge, AHitOfASurfaceThatFacesAwayIsWrong)
{
    const auto away = two_poles_facing(-1), toward = two_poles_facing(1);
    EXPECT_EQ(Judge(away).exact_answer(away.rays[0]).status, TraceStatus::facing_away);
    for (const bool sampled : {false, true}) {
        const Claim claim{.may_miss_between_samples = sampled};
        EXPECT_THAT(Judge(away).judge(away.rays[0], hit({20, 10}, 14.5 / 50), claim).reason, HasSubstr("faces away"));
        EXPECT_EQ(Judge(toward).judge(toward.rays[0], hit({20, 10}, 14.5 / 50), claim).verdict, Verdict::right);
    }
}

TEST(Judge, FacingAwayIsWrongWhereNothingFacesAway)
{
    auto empty = two_poles_facing(1);
    empty.gbuffer.depth.assign(empty.gbuffer.depth.size(), 0);
    const auto  toward = two_poles_facing(1);
    const Claim sampled{.may_miss_between_samples = true};
    for (const ssrlab::Setup* setup : {&std::as_const(empty), &toward})
        EXPECT_THAT(Judge(*setup).judge(setup->rays[0], {TraceStatus::facing_away}, sampled).reason,
                    HasSubstr("touches no surface that faces away"));
}

TEST(Judge, AMissOfWhatFacesAwayMustSaySo)
{
    const auto away = two_poles_facing(-1);
    EXPECT_EQ(Judge(away).judge(away.rays[0], {TraceStatus::facing_away}, {}).verdict, Verdict::right);
    EXPECT_THAT(Judge(away).judge(away.rays[0], miss(), {}).reason, HasSubstr("in (20, 10), which faces away"));
    EXPECT_EQ(Judge(away).judge(away.rays[0], miss(), {.may_miss_between_samples = true}).verdict, Verdict::allowed);
}

// A ray of slope 1 through corners: rounding may lead it through the pixel beside one, (21, 10), which holds what it meets from behind.
TEST(Judge, PassingThroughACornerDecidesNothing)
{
    auto setup    = two_poles_facing(-1);
    setup.rays[0] = ray_between(setup.gbuffer.view, {10, 0, 4.5}, {40, 30, 4.5});
    const auto at = [&](glm::ivec2 holder) {
        setup.gbuffer.depth =
            picture_of(setup.gbuffer.view, [&](glm::ivec2 p) { return p == holder ? 4.0 : 0.0; }).depth;
        return Judge(setup).judge(setup.rays[0], {TraceStatus::facing_away}, {}).verdict;
    };
    EXPECT_EQ(at({21, 10}), Verdict::sliver);
    EXPECT_EQ(at({20, 10}), Verdict::right);
    EXPECT_EQ(at({22, 10}), Verdict::wrong);
}

// A slab that ends 0.0001 m before the ray is missed by 5e-7 in depth, 20 times what rounding can change; one that ends 1e-9 m before it may be met.
TEST(Judge, RoundingExcusesOnlyWhatRoundingCanDo)
{
    for (const double thickness_m : {0.4, 0.49, 0.4999}) {
        const auto setup = two_poles(thickness_m);
        EXPECT_THAT(Judge(setup).judge(setup.rays[0], hit({20, 10}, 14.5 / 50), {}).reason,
                    HasSubstr("does not meet the slab"))
            << thickness_m;
    }
    const auto close = two_poles(0.5 - 1e-9);
    EXPECT_NE(Judge(close).judge(close.rays[0], hit({20, 10}, 14.5 / 50), {}).verdict, Verdict::wrong);
}

TEST(Judge, AHitLiesInItsPixelAndItsLayer)
{
    const auto  setup = two_poles();
    const Judge judge(setup);
    for (const double t : {14.4 / 50, 15.6 / 50})
        EXPECT_THAT(judge.judge(setup.rays[0], hit({20, 10}, t), {}).reason,
                    HasSubstr("but the ray is in that pixel from"));
    RayOutcome outcome = hit({20, 10}, 14.5 / 50);
    outcome.hit_layer  = 1;
    EXPECT_THAT(judge.judge(setup.rays[0], outcome, {}).reason, HasSubstr("layer 1, which is not there"));
}

// Behind the first pole, 3 m away, the ray goes on to the second, which it meets.
TEST(Judge, WhatIsBehindAnObjectMayBeMissedIfSoClaimed)
{
    auto setup    = two_poles(0.5);
    setup.gbuffer = picture_of(bench_view(), [](glm::ivec2 p) { return p.x == 20 ? 3.0 : p.x == 30 ? 4.2 : 0.0; });
    const Judge judge(setup);
    ASSERT_EQ(judge.exact_answer(setup.rays[0]).hit_pixel, glm::ivec2(30, 10));
    EXPECT_EQ(judge.judge(setup.rays[0], miss(), {.may_miss_behind_objects = true}).verdict, Verdict::allowed);
    EXPECT_EQ(judge.judge(setup.rays[0], miss(), {}).verdict, Verdict::wrong);
}

TEST(Judge, AStopIsOfWhatIsMetFromBehind)
{
    for (const double z : {-1.0, 1.0}) {
        auto setup            = two_poles_facing(z);
        setup.settings.behind = Behind::stop;
        const Judge      judge(setup);
        const RayOutcome stop{TraceStatus::stopped, {20, 10}, 14.5 / 50};
        EXPECT_EQ(judge.exact_answer(setup.rays[0]).status, z < 0 ? TraceStatus::stopped : TraceStatus::hit);
        EXPECT_THAT(judge.broken_invariant(setup.rays[0], stop), IsEmpty());
        EXPECT_THAT(judge.broken_invariant(setup.rays[0], {TraceStatus::facing_away}), HasSubstr("cannot"));
        if (z < 0)
            EXPECT_EQ(judge.judge(setup.rays[0], stop, {}).verdict, Verdict::right);
        else
            EXPECT_THAT(judge.judge(setup.rays[0], stop, {}).reason, HasSubstr("which is met from the front"));
        EXPECT_EQ(judge.judge(setup.rays[0], hit({20, 10}, 14.5 / 50), {}).verdict,
                  z < 0 ? Verdict::wrong : Verdict::right);
    }
    for (const Behind behind : {Behind::hit, Behind::pass}) {
        auto setup            = two_poles();
        setup.settings.behind = behind;
        EXPECT_THAT(Judge(setup).broken_invariant(setup.rays[0], {TraceStatus::stopped, {20, 10}, 14.5 / 50}),
                    HasSubstr("cannot"));
    }
}

TEST(Judge, CountsWhatIsThereAndWhatIsFound)
{
    const auto  setup = two_poles();
    const Judge judge(setup);
    const auto  found = [&](const RayOutcome& outcome) {
        const Judgement judgement = judge.judge(setup.rays[0], outcome, {.may_miss_between_samples = true});
        EXPECT_TRUE(judgement.findable);
        return judgement.found;
    };
    EXPECT_TRUE(found(hit({20, 10}, 14.5 / 50)));
    EXPECT_FALSE(found(hit({30, 10}, 24.5 / 50)));
    EXPECT_FALSE(found(miss()));
    const auto thin = two_poles(0.1);
    EXPECT_FALSE(Judge(thin).judge(thin.rays[0], miss(), {}).findable);
}

// A ray that enters the pole in row 10, and row 11 half a pixel later.
TEST(Judge, AFindIsWithinAPixelOfTheHit)
{
    auto setup = two_poles();
    setup.rays = {ray_between(setup.gbuffer.view, {5.5, 10.5, 4.5}, {55.5, 10.5 + 5 / 3.0, 4.5})};
    const Judge judge(setup);
    ASSERT_EQ(judge.exact_answer(setup.rays[0]).hit_pixel, glm::ivec2(20, 10));
    const Judgement judgement =
        judge.judge(setup.rays[0], hit({20, 11}, 15.01 / 50), {.may_miss_between_samples = true});
    EXPECT_NE(judgement.verdict, Verdict::wrong);
    EXPECT_TRUE(judgement.found);
    EXPECT_NEAR(judgement.deviation_px, 0.51, 0.01);
}

TEST(Judge, AHitOffTheImageIsReadNowhere)
{
    const auto setup = two_poles();
    // The ray ends 0.03 px before the border: the pixel behind it is within a near tie.
    auto ray = level_ray(setup.gbuffer.view, {5.5, 10.5}, {58.47, 0}, 4.5);
    EXPECT_EQ(Judge(setup).judge(ray, hit({64, 10}, 1), {}).verdict, Verdict::wrong);
}

TEST(Judge, InvariantsAreNamed)
{
    const auto   setup = two_poles();
    const Judge  judge(setup);
    const auto&  ray = setup.rays[0];
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(judge.broken_invariant(ray, hit({20, 10}, 0.29)), IsEmpty());
    EXPECT_THAT(judge.broken_invariant(ray, hit({20, 10}, nan)), HasSubstr("not a number"));
    EXPECT_THAT(judge.broken_invariant(ray, {TraceStatus::left_screen, {}, nan}), HasSubstr("nan"));
    EXPECT_THAT(judge.broken_invariant(ray, hit({64, 10}, 0.5)), HasSubstr("off the image"));
    EXPECT_THAT(judge.broken_invariant(ray, hit({20, 10}, 1.5)), HasSubstr("outside [0, 1]"));
    EXPECT_THAT(judge.broken_invariant(ray, hit({5, 10}, 0)), HasSubstr("its start pixel"));
    EXPECT_THAT(judge.broken_invariant(ray, {TraceStatus::not_traced}), HasSubstr("cannot"));
    EXPECT_THAT(judge.broken_invariant(ray, {TraceStatus::impossible, {}, 0, 200}), HasSubstr("status 200"));
    EXPECT_THAT(judge.broken_invariant(ray, {TraceStatus::facing_away}), HasSubstr("cannot"));
}

} // namespace
} // namespace ssrlab::test
