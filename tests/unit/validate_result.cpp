// What cannot be an answer is found before anything is measured by it.
#include "compare/validate_result.h"
#include "compare/measures.h"
#include "harness/measured_run.h"
#include "harness/quality.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using testing::HasSubstr;
using testing::Optional;

constexpr glm::ivec2 size_px{8, 4};

/// Of 32 pixels all but the first are traced; all hit pixel (3, 2).
TraceImage sound()
{
    TraceImage result = make_trace_image(size_px, true);
    result.status.assign(32, TraceStatus::hit);
    result.status[0] = TraceStatus::not_traced;
    result.hit_pixel.assign(32, {3, 2});
    result.hit_px_depth.assign(32, {3.5, 2.5, 0.1});
    result.hit_t.assign(32, 0.5);
    result.steps.assign(32, 7);
    return result;
}

TEST(ValidateResult, ASoundResultHasNothingImpossible)
{
    EXPECT_EQ(find_impossible(sound(), 7), std::nullopt);
    TraceImage ends = sound();
    ends.hit_t[3]   = 0;
    ends.hit_t[4]   = 1;
    // Of a miss nothing but status and steps means anything.
    ends.status[5]    = TraceStatus::left_screen;
    ends.hit_pixel[5] = {-5, 99999};
    ends.hit_t[5]     = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(find_impossible(ends, 7), std::nullopt);
}

TEST(ValidateResult, SaysHowManyWhichAndWhat)
{
    const auto found = [](const auto& spoil) {
        TraceImage result = sound();
        spoil(result, 13);
        spoil(result, 20);
        return find_impossible(result, 7);
    };
    EXPECT_EQ(found([](TraceImage& r, size_t i) {
                  r.hit_pixel[i] = {8, 2};
              }),
              "2 of 31 rays have an answer that cannot be; the first is the ray of pixel (5, 1): hit pixel (8, 2) is "
              "off the image of 8x4");
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.hit_pixel[i] = {-1, 2}; }), Optional(HasSubstr("(-1, 2)")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.hit_pixel[i] = {2, 4}; }), Optional(HasSubstr("(2, 4)")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.hit_t[i] = std::numeric_limits<double>::quiet_NaN(); }),
                Optional(HasSubstr("t of a hit is not a number")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.hit_t[i] = 7; }), Optional(HasSubstr("t = 7")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.hit_t[i] = -0.1; }), Optional(HasSubstr("t = -0.1")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.steps[i] = static_cast<uint32_t>(-1); }),
                Optional(HasSubstr("4294967295 steps, but the technique declares at most 7")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.steps[i] = 8; }), Optional(HasSubstr("8 steps, but")));
    EXPECT_THAT(found([](TraceImage& r, size_t i) { r.status[i] = static_cast<TraceStatus>(200), r.steps[i] = 200; }),
                Optional(HasSubstr("status 200")));
    // As the device stores it: status and pixel in the place of the work.
    const auto stored = [](TraceStatus status, glm::ivec2 pixel) {
        return [=](TraceImage& r, size_t i) {
            r.status[i]    = TraceStatus::impossible;
            r.steps[i]     = static_cast<uint32_t>(status);
            r.hit_pixel[i] = pixel;
        };
    };
    EXPECT_THAT(found(stored(TraceStatus::hit, {-5, 99999})), Optional(HasSubstr("hit pixel (-5, 99999) is off")));
    EXPECT_THAT(found(stored(TraceStatus::not_traced, {0, 0})), Optional(HasSubstr("status 0 is none of 1 … 6")));
}

// None of these may read beyond the picture: the address sanitizer would say so.
TEST(ValidateResult, NothingIsMeasuredByAnImpossibleResult)
{
    const GBufferImage gbuffer = test::empty_gbuffer(test::bench_view(size_px));
    SceneTruth         scene;
    scene.size_px = size_px;
    scene.cls.assign(32, TruthClass::sky);
    scene.point_px.resize(32);
    scene.radiance.resize(32);
    TraceImage off = sound(), unknown = sound();
    off.hit_pixel[9]  = {-5, 99999};
    unknown.status[9] = static_cast<TraceStatus>(200);
    for (const TraceImage& result : {off, unknown}) {
        Record row;
        EXPECT_THROW(compare_to_screen_truth(result, sound()), InvalidResult);
        EXPECT_THROW(compare_to_scene_truth(result, scene, nullptr, gbuffer), InvalidResult);
        EXPECT_THROW(reflected_image(result, gbuffer, {}), InvalidResult);
        EXPECT_THROW(add_counts(row, result), InvalidResult);
    }
}

TEST(ValidateResult, MakesARowInvalid)
{
    EXPECT_EQ(failed_row({}, InvalidResult("a")), (Record{{"outcome", "invalid"}, {"message", "a"}}));
    EXPECT_EQ(failed_row({}, Failure("b")), (Record{{"outcome", "failed"}, {"message", "b"}}));
}

} // namespace
} // namespace ssrlab
