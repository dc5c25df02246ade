// Hits of another renderer: what a file may leave out, and every way of being wrong.
#include "check/judge_frame.h"

#include "check/setup.h"
#include "compare/image_io.h"
#include "core/error.h"
#include "core/pixel_index.h"
#include "errors.h"
#include "temp_folder.h"
#include "test.h"
#include "truth/screen_truth.h"

namespace ssrlab::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const TraceSettings settings = boxes({.thickness_m = 0.5, .max_distance_m = 100});

/// A mirror floor before a wall that does not reflect and ends below the image's upper border.
GBufferImage floor_and_wall(glm::ivec2 size_px = {32, 24})
{
    GBufferImage image = picture_of(bench_view(size_px), {plane({0, -1, 0}, {0, 1, 0}), box({-9, -1, -9}, {9, 2, -8})});
    for (size_t i = 0; i < image.depth.size(); ++i)
        if (image.normal_vs[i].z != 0) image.metallic[i] = 0;
    return image;
}

class Hits {
public:
    const TempFolder folder;
    GBufferImage     gbuffer = floor_and_wall();
    Image            image   = hits_image(screen_truth(gbuffer, settings));

    float& at(glm::ivec2 pixel, const std::string& channel)
    {
        const auto c = std::ranges::find(image.channels, channel) - image.channels.begin();
        return image.values[pixel_index(pixel, image.size_px) * image.channels.size() + static_cast<size_t>(c)];
    }

    /// Leaves only these channels, with other names for some.
    void keep(const std::vector<std::string>& channels, const std::vector<std::string>& names)
    {
        Image kept{image.size_px, names, {}, {}};
        for (size_t i = 0; i < pixel_count(image.size_px); ++i)
            for (const std::string& channel : channels) kept.values.push_back(at(pixel_at(i, image.size_px), channel));
        image = kept;
    }

    HitsFile read()
    {
        write_image(folder / "hits.exr", image);
        return read_hits(folder / "hits.exr", gbuffer.view.size_px);
    }

    FrameJudgement judged() { return judge_frame(gbuffer, settings, read()); }

    /// The first pixel of the floor whose ray hits the wall, or misses, more than a few pixels away.
    glm::ivec2 pixel_that(TraceStatus status)
    {
        for (size_t i = 0; i < pixel_count(image.size_px); ++i)
            if (const glm::ivec2 pixel = pixel_at(i, image.size_px);
                at(pixel, "status") == static_cast<float>(status) &&
                at(pixel, "hit.y") < static_cast<float>(pixel.y) - 3)
                return pixel;
        throw_failure("no such pixel");
    }

    void hit(glm::ivec2 pixel, glm::vec2 point)
    {
        at(pixel, "status")  = 1;
        at(pixel, "hit.x")   = point.x;
        at(pixel, "hit.y")   = point.y;
        at(pixel, "pixel.x") = std::floor(point.x);
        at(pixel, "pixel.y") = std::floor(point.y);
    }
};

void expect_one(const FrameJudgement& judgement, glm::ivec2 pixel, Fault fault, const std::string& said)
{
    EXPECT_EQ(judgement.wrong(), 1U);
    ASSERT_EQ(judgement.findings.size(), 1U);
    const Finding& found = judgement.findings[0];
    EXPECT_EQ(found.pixel, pixel);
    EXPECT_EQ(fault_names[static_cast<size_t>(found.fault)], fault_names[static_cast<size_t>(fault)]);
    EXPECT_THAT(found.got + " | " + found.expected + " | " + found.why, HasSubstr(said));
}

TEST(JudgeFrame, TheRightAnswersAreRight)
{
    const FrameJudgement judgement = Hits().judged();
    EXPECT_GT(judgement.rays, 200U);
    EXPECT_EQ(judgement.of(Fault::right), judgement.rays);
    EXPECT_EQ(judgement.ignored, 0U);
}

TEST(JudgeFrame, WhatAFileLeavesOutFollowsFromTheFrame)
{
    const std::vector<std::vector<std::string>> kept = {
        {"status", "hit.x", "hit.y"}, {"status", "pixel.x", "pixel.y"}, {"status", "pixel.x", "pixel.y", "hit.t"}};
    const TraceImage full = Hits().judged().usable;
    for (const auto& channels : kept) {
        Hits hits;
        hits.keep(channels, channels);
        const FrameJudgement judgement = hits.judged();
        EXPECT_EQ(judgement.wrong(), 0U) << fmt::format("{}", fmt::join(channels, " "));
        for (size_t i = 0; i < full.status.size(); ++i) {
            if (full.status[i] != TraceStatus::hit) continue;
            EXPECT_EQ(judgement.usable.hit_pixel[i], full.hit_pixel[i]);
            EXPECT_LE(glm::distance(glm::dvec2(judgement.usable.hit_px_depth[i]), glm::dvec2(full.hit_px_depth[i])), 1);
        }
    }
}

TEST(JudgeFrame, AMaskStandsForStatuses)
{
    Hits hits;
    for (size_t i = 0; i < pixel_count(hits.image.size_px); ++i) {
        float& status = hits.at(pixel_at(i, hits.image.size_px), "status");
        status        = status == 1 ? 1 : 0;
    }
    const glm::ivec2 missed = hits.pixel_that(TraceStatus::hit);
    hits.keep({"status", "hit.x", "hit.y"}, {"ssr.mask", "ssr.hit.x", "ssr.hit.y"});
    EXPECT_EQ(hits.judged().wrong(), 0U);
    hits.at(missed, "ssr.mask") = 0;
    expect_one(hits.judged(), missed, Fault::missed, "past_max_distance | hit in");
}

TEST(JudgeFrame, APointOnABorderIsInThePixelThatTheRayEnters)
{
    Hits hits;
    for (size_t i = 0; i < pixel_count(hits.image.size_px); ++i) {
        const glm::ivec2 pixel = pixel_at(i, hits.image.size_px);
        if (hits.at(pixel, "status") != 1) continue;
        hits.at(pixel, "hit.y") = hits.at(pixel, "pixel.y") + 1; // rays run up the image
        hits.at(pixel, "hit.t") = 0;
    }
    const TraceImage full = Hits().judged().usable;
    hits.keep({"status", "hit.x", "hit.y"}, {"status", "hit.x", "hit.y"});
    const TraceImage read   = hits.judged().usable;
    size_t           tested = 0;
    for (size_t i = 0; i < full.status.size(); ++i) {
        if (full.status[i] != TraceStatus::hit) continue;
        ++tested;
        EXPECT_EQ(read.hit_pixel[i].y, full.hit_pixel[i].y);
    }
    EXPECT_GT(tested, 20U);
}

TEST(JudgeFrame, AnotherConventionIsNamed)
{
    const glm::vec2 size(160, 120);
    const auto      advice = [&](bool rows_up, glm::vec2 scale, glm::vec2 shift) {
        Hits hits;
        hits.gbuffer         = floor_and_wall(size);
        const Image original = hits_image(screen_truth(hits.gbuffer, settings));
        hits.image           = original;
        for (size_t i = 0; i < pixel_count(original.size_px); ++i) {
            const glm::ivec2 to = pixel_at(i, original.size_px);
            const glm::ivec2 from(to.x, rows_up ? original.size_px.y - 1 - to.y : to.y);
            for (size_t c = 0; c < original.channels.size(); ++c)
                hits.at(to, original.channels[c]) =
                    original.values[pixel_index(from, original.size_px) * original.channels.size() + c];
            hits.at(to, "hit.x") = hits.at(to, "hit.x") * scale.x + shift.x;
            hits.at(to, "hit.y") = hits.at(to, "hit.y") * scale.y + shift.y;
        }
        hits.keep({"status", "hit.x", "hit.y"}, {"status", "hit.x", "hit.y"});
        return hits.judged().advice;
    };
    EXPECT_THAT(advice(false, {1, 1}, {0, 0}), testing::IsEmpty());
    EXPECT_THAT(advice(false, {1, -1}, {0, size.y}), ElementsAre(HasSubstr("hit.y seems to count from the bottom")));
    EXPECT_THAT(advice(true, {1, 1}, {0, 0}), testing::Contains(HasSubstr("rows of the file seem to begin")));
    EXPECT_THAT(advice(false, 1.0F / size, {0, 0}), ElementsAre(HasSubstr("shares of the image: expected pixels")));
    EXPECT_THAT(advice(false, {1, 1}, {-0.5F, -0.5F}), ElementsAre(HasSubstr("whole numbers at pixels' centres")));
}

TEST(JudgeFrame, EveryFaultIsNamed)
{
    const glm::ivec2 hitting = Hits().pixel_that(TraceStatus::hit), size = floor_and_wall().view.size_px;
    const auto       judged = [&](const auto& change) {
        Hits hits;
        change(hits);
        return hits.judged();
    };
    const auto point_of = [&](Hits& hits) { return glm::vec2(hits.at(hitting, "hit.x"), hits.at(hitting, "hit.y")); };
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "status") = 9; }), hitting, Fault::impossible,
               "status 9 is none");
    expect_one(judged([&](Hits& hits) {
                   hits.hit(hitting, {5, static_cast<float>(size.y)});
               }),
               hitting, Fault::impossible, "off the image of 32x24");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "hit.x") = std::numeric_limits<float>::quiet_NaN(); }),
               hitting, Fault::impossible, "no numbers");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "hit.t") = 1.5F; }), hitting, Fault::impossible,
               "outside [0, 1]");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "layer") = 1; }), hitting, Fault::impossible, "layer 1");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "pixel.y") += 2; }), hitting, Fault::impossible,
               "not in its pixel");
    expect_one(judged([&](Hits& hits) { hits.hit(hitting, glm::vec2(hitting) + 0.5F); }), hitting, Fault::impossible,
               "its start pixel");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "status") = 0; }), hitting, Fault::unanswered, "not_traced");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "status") = 4; }), hitting, Fault::out_of_steps,
               "out_of_steps | hit in");
    expect_one(judged([&](Hits& hits) { hits.at(hitting, "status") = 2; }), hitting, Fault::missed,
               "but the ray meets the slab");
    const auto moved_by = [&](float way_px) {
        return judged([&](Hits& hits) {
            const glm::vec2 from = glm::vec2(hitting) + 0.5F, to = point_of(hits),
                            point = to + way_px * glm::normalize(to - from);
            hits.at(hitting, "hit.t") *= glm::distance(from, point) / glm::distance(from, to);
            hits.hit(hitting, point);
        });
    };
    expect_one(moved_by(-2), hitting, Fault::too_early, "does not meet the slab");
    expect_one(moved_by(2), hitting, Fault::too_late, "does not meet the slab");
}

TEST(JudgeFrame, RaysThatHitNothingHaveOneEnd)
{
    Hits             hits;
    const glm::ivec2 missing{16, 23};
    ASSERT_EQ(hits.at(missing, "status"), float(TraceStatus::past_max_distance));
    hits.at(missing, "status") = float(TraceStatus::left_screen);
    expect_one(hits.judged(), missing, Fault::other_end, "left_screen | past_max_distance");
    hits.hit(missing, {16.5F, 15.5F});
    hits.at(missing, "hit.t") = 0.4F;
    expect_one(hits.judged(), missing, Fault::false_hit, "hit in (16, 15) at t 0.4 | past_max_distance");
}

TEST(JudgeFrame, AnswersOfOtherPixelsAreIgnored)
{
    Hits hits;
    hits.hit({16, 8}, {3.5F, 3.5F}); // the wall
    const FrameJudgement judgement = hits.judged();
    EXPECT_EQ(judgement.wrong(), 0U);
    EXPECT_EQ(judgement.ignored, 1U);
    EXPECT_EQ(judgement.usable.status[pixel_index({16, 8}, hits.image.size_px)], TraceStatus::not_traced);
}

TEST(JudgeFrame, ImpossibleAnswersCountAsMissesInMeasures)
{
    Hits             hits;
    const glm::ivec2 pixel   = hits.pixel_that(TraceStatus::hit);
    hits.at(pixel, "status") = 9;
    EXPECT_EQ(hits.judged().usable.status[pixel_index(pixel, hits.image.size_px)], TraceStatus::past_max_distance);
}

TEST(JudgeFrame, WhatCannotBeReadIsSaid)
{
    const auto said = [](const std::vector<std::string>& channels, glm::ivec2 size_px) {
        Hits hits;
        hits.keep(channels, channels);
        write_image(hits.folder / "hits.exr", hits.image);
        return message_of<SpecError>([&] { read_hits(hits.folder / "hits.exr", size_px); });
    };
    EXPECT_THAT(said({"hit.x", "hit.y"}, {32, 24}), HasSubstr("expected a channel 'status' or 'mask'"));
    EXPECT_THAT(said({"status"}, {32, 24}), HasSubstr("'hit.x' and 'hit.y' or 'pixel.x' and 'pixel.y'"));
    EXPECT_THAT(said({"status", "hit.x"}, {32, 24}), HasSubstr("both channels 'hit.x' and 'hit.y', got one"));
    EXPECT_THAT(said({"status", "hit.x", "hit.y"}, {32, 32}), HasSubstr("32x24 pixels, expected 32x32"));
    EXPECT_THAT(message_of<SpecError>([] {
                    read_hits("nowhere.exr", {1, 1});
                }),
                HasSubstr("nowhere.exr: no such file"));
    TraceSettings layered = settings;
    layered.layers        = 2;
    Hits hits;
    EXPECT_THAT(message_of<SpecError>([&] { judge_frame(hits.gbuffer, layered, hits.read()); }),
                HasSubstr("layers = 2"));
    layered         = settings;
    layered.surface = "own";
    EXPECT_THAT(message_of<SpecError>([&] { judge_frame(hits.gbuffer, layered, hits.read()); }),
                HasSubstr("surface = own"));
}

} // namespace
} // namespace ssrlab::test
