// The reflection accumulated over the frames of a sequence.
#include "core/pixel_index.h"
#include "gpu/passes.h"
#include "gpu/sequence_frames.h"

namespace ssrlab::test {
namespace {

using testing::HasSubstr;

constexpr glm::ivec2 size_px{97, 61};

/// No clamping, no rejection.
const ParameterValues plain{chosen(HistoryClamping::off), {"reject_depth", 0}, {"reject_normal", -1}};

ParameterValues with(ParameterValues values, const ParameterValues& more)
{
    for (const auto& [name, value] : more) values[name] = value;
    return values;
}

const PlannedPass& row_of(const ReadyFrame& frame, const std::string& id)
{
    return *std::ranges::find(plan_of(frame).passes, id, &PlannedPass::id);
}

std::vector<float> shaded(const ReadyFrame& frame) { return read_shaded(device(), frame).values; }

Scene still_scene()
{
    Scene scene = load_scene("builtin:moving_boxes");
    for (Draw& draw : scene.draws) draw.motion = {};
    return scene;
}

// A still camera with jitter: every pixel's reflection was in the same pixel, so as long as the weight allows, the history is the plain
// mean of all frames so far, of colours times their weights.
TEST(History, ConvergesToTheMeanOfTheFrames)
{
    const Scene             scene   = still_scene();
    const FrameHistoryPtr   history = make_history(device(), size_px);
    const ParameterValues   passes  = with(plain, {strategy("surface"), {"history_weight", 0.999}});
    constexpr int           frames  = 16;
    std::vector<glm::dvec4> sum(pixel_count(size_px));
    std::vector<int>        seen(sum.size());
    for (int frame = 0; frame < frames; ++frame) {
        const SequencePicture picture = picture_at(scene, "default", {frame, frames}, size_px);
        const Reflection      own = (run_picture(picture, passes, nullptr), read_colours(picture.buffers->reflection));
        const auto            run = run_picture(picture, passes, history);
        const auto            vectors_px = read_reprojection(device(), *run);
        for (size_t i = 0; i < sum.size(); ++i) {
            sum[i] += glm::dvec4(glm::vec3(own[i]) * own[i].a, own[i].a);
            seen[i] += own[i].a >= 0 && (frame == 0 || !std::isnan(vectors_px[i].x)) ? 1 : 0;
        }
        EXPECT_EQ(read_history_counts(device(), *run).has_value(), frame > 0);
        keep_history(device(), *run, frame);
    }
    const auto kept  = download_as<glm::vec4>(device(), history->reflection),
               facts = download_as<glm::vec4>(device(), history->facts);
    size_t judged    = 0;
    for (size_t i = 0; i < kept.size(); ++i) {
        if (seen[i] != frames) continue;
        ++judged;
        ASSERT_EQ(facts[i].x, frames);
        const glm::dvec4 mean = sum[i] / double(frames);
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(static_cast<double>(kept[i][c]), mean[c], 1e-4) << "pixel " << i;
    }
    EXPECT_GT(judged, 1000U);
}

/// Root mean square of the difference of two pictures.
double rms_between(const std::vector<float>& one, const std::vector<double>& other)
{
    double sum = 0;
    for (size_t i = 0; i < one.size(); ++i) sum += std::pow(static_cast<double>(one[i]) - other[i], 2);
    return std::sqrt(sum / static_cast<double>(one.size()));
}

/// The mean of what one frame of a sequence shows in all phases of the jitter: its supersampled picture.
std::vector<double> supersampled(const Scene& scene, const char* view, int frame, int phases)
{
    std::vector<double> mean;
    const Scene         still = scene_at(scene, frame);
    for (int phase = 0; phase < phases; ++phase) {
        Camera camera = camera_at(still, view, {frame, 0});
        camera.shift_px += jitter_px({phase, phases});
        SequencePicture picture;
        picture.drawing = draw_gbuffer(device(), upload_scene(device(), still), camera_to_view(camera, size_px));
        picture.gbuffer = gbuffer_of(*picture.drawing);
        picture.buffers = make_frame_buffers(device(), picture.drawing);
        const auto own  = shaded(*run_picture(picture, {{"history_weight", 0}}, nullptr));
        mean.resize(own.size());
        for (size_t i = 0; i < own.size(); ++i) mean[i] += static_cast<double>(own[i]) / phases;
    }
    return mean;
}

// 16 jittered frames of a still scene: without clamping the picture is their mean, with it the picture approaches it.
TEST(PictureHistory, ApproachesTheSupersampledPicture)
{
    constexpr int             frames = 16;
    const Scene               scene  = still_scene();
    const std::vector<double> mean   = supersampled(scene, "default", 0, frames);
    for (const bool clamps : {false, true}) {
        ParameterValues passes{{"history_weight", 0}, {"picture_history_weight", 0.999}};
        if (!clamps) passes = with(plain, passes);
        const FrameHistoryPtr history = make_history(device(), size_px);
        double                first = 0, last = 0;
        for (int frame = 0; frame < frames; ++frame) {
            const auto run = run_picture(picture_at(scene, "default", {frame, frames}, size_px), passes, history);
            EXPECT_EQ(row_of(*run, "picture_history").runs, frame > 0);
            last = rms_between(shaded(*run), mean);
            if (frame == 0) first = last;
            keep_history(device(), *run, frame);
        }
        EXPECT_GT(first, 0.01);
        EXPECT_LT(last, clamps ? first / 2 : 1e-3);
    }
}

// A moving camera and moving boxes over a mirror: nearer to the supersampled picture of that frame than one frame is.
TEST(PictureHistory, FollowsWhatMoves)
{
    constexpr int             last = 7, phases = 8;
    const Scene               scene = load_scene("builtin:moving_boxes");
    const std::vector<double> mean  = supersampled(scene, "truck", last, phases);
    double                    rms[2];
    for (const bool accumulates : {false, true}) {
        const ParameterValues passes{{"history_weight", 0}, {"picture_history_weight", accumulates ? 0.9 : 0.0}};
        const FrameHistoryPtr history = make_history(device(), size_px);
        for (int frame = 0; frame <= last; ++frame) {
            const auto run   = run_picture(picture_at(scene, "truck", {frame, phases}, size_px), passes, history);
            rms[accumulates] = rms_between(shaded(*run), mean);
            keep_history(device(), *run, frame);
        }
    }
    EXPECT_LT(rms[1], 0.7 * rms[0]);
}

/// Two frames of a jittered sequence; between them the history is changed by hand.
struct TwoFrames {
    HistoryCounts counts;
    Reflection    own, result;
};

TwoFrames second_after(const std::function<void(FrameHistory&)>& change, const ParameterValues& passes)
{
    const Scene           scene   = still_scene();
    const FrameHistoryPtr history = make_history(device(), size_px);
    keep_history(device(), *run_picture(picture_at(scene, "default", {0, 16}, size_px), passes, history), 0);
    change(*history);
    const SequencePicture picture = picture_at(scene, "default", {1, 16}, size_px);
    TwoFrames             frames;
    run_picture(picture, passes, nullptr);
    frames.own             = read_colours(picture.buffers->reflection);
    const auto run         = run_picture(picture, passes, history);
    frames.result          = read_colours(picture.buffers->reflection);
    frames.counts          = read_history_counts(device(), *run).value();
    const HistoryCounts& c = frames.counts;
    EXPECT_EQ(c.accumulated + c.unseen + c.off_image + c.other_depth + c.other_normal + c.other_hit,
              plan_of(*run).statistics.gbuffer.reflecting_pixels);
    EXPECT_GT(c.accumulated + c.other_depth + c.other_normal + c.other_hit, 1000U);
    return frames;
}

template <typename Texel> void fill(GpuImage& image, Texel value)
{
    const std::vector<Texel> texels(pixel_count(size_px), value);
    upload(device(), image, texels.data(), texels.size() * sizeof(Texel));
}

const auto bright = [](FrameHistory& history) { fill(history.reflection, glm::vec4(100, 100, 100, 1)); };

// A history that is brighter than everything in the frame: clamped between the neighbours' smallest and largest value, it is their
// largest.
TEST(History, IsClampedToItsNeighbours)
{
    const ParameterValues passes = with(plain, {strategy("surface")});
    const TwoFrames       off    = second_after(bright, passes);
    EXPECT_EQ(off.counts.clamped, 0U);
    const TwoFrames minmax = second_after(bright, with(passes, {chosen(HistoryClamping::minmax)}));
    const TwoFrames variance =
        second_after(bright, with(passes, {chosen(HistoryClamping::variance), {"clamping_deviations", 0}}));
    const TwoFrames wider =
        second_after(bright, with(passes, {chosen(HistoryClamping::variance), {"clamping_deviations", 1}}));
    const auto      dark   = [](FrameHistory& history) { fill(history.reflection, glm::vec4(-100, -100, -100, 1)); };
    const TwoFrames darker = second_after(dark, with(passes, {chosen(HistoryClamping::minmax)}));
    const TwoFrames half =
        second_after(bright, with(passes, {chosen(HistoryClamping::variance), {"clamping_deviations", 0.5}}));
    EXPECT_EQ(minmax.counts.clamped, minmax.counts.accumulated);
    EXPECT_EQ(variance.counts.clamped, variance.counts.accumulated);
    size_t changed = 0, bounded = 0;
    for (int y = 1; y < size_px.y - 1; ++y)
        for (int x = 1; x < size_px.x - 1; ++x) {
            const size_t i = pixel_index({x, y}, size_px);
            if (off.result[i] == off.own[i]) continue;
            ++changed;
            ASSERT_GT(off.result[i].r, 10) << "without clamping the history shows";
            float high = 0, low = 1e9F, count = 0, sum = 0, squares = 0;
            for (int k = 0; k < 9; ++k) {
                const glm::vec4 next = minmax.own[pixel_index({x + k % 3 - 1, y + k / 3 - 1}, size_px)];
                if (next.a < 0) continue;
                high = std::max(high, next.r * next.a);
                low  = std::min(low, next.r * next.a);
                count += 1;
                sum += next.r * next.a;
                squares += next.r * next.a * next.r * next.a;
            }
            ASSERT_LE(minmax.result[i].r * minmax.result[i].a, high + 1e-3F);
            ASSERT_LE(variance.result[i].r * variance.result[i].a, high + 1e-3F);
            ASSERT_GE(variance.result[i].r * variance.result[i].a, low - 1e-3F);
            // The share of the history is known from the first, and so is what the last was clamped to.
            const float own = off.own[i].r * off.own[i].a, mean = sum / count,
                        deviation = std::sqrt(std::max(squares / count - mean * mean, 0.0F));
            if (high - own < 0.2F) continue;
            ++bounded;
            const float part         = (minmax.result[i].r * minmax.result[i].a - own) / (high - own);
            const auto  expect_bound = [&](const TwoFrames& frames, float bound) {
                ASSERT_NEAR(frames.result[i].r * frames.result[i].a, own + part * (bound - own), 0.02F)
                    << x << ' ' << y;
            };
            expect_bound(wider, mean + deviation);
            expect_bound(half, mean + 0.5F * deviation);
            expect_bound(darker, low);
        }
    EXPECT_GT(changed, 1000U);
    EXPECT_GT(bounded, 50U);
}

TEST(History, NothingIsLeftOfItAfterACut)
{
    const Scene           scene   = load_scene("builtin:moving_boxes");
    const FrameHistoryPtr history = make_history(device(), size_px);
    const ParameterValues passes{strategy("plane")};
    const auto            alone = [&](SequenceFrame at, const char* view) {
        return shaded(*run_picture(picture_at(scene, view, at, size_px), passes, nullptr));
    };
    const auto after = [&](const char* view, SequenceFrame at) {
        keep_history(device(), *run_picture(picture_at(scene, "truck", {4, 8}, size_px), passes, history), 4);
        fill(history->reflection, glm::vec4(1000));
        return run_picture(picture_at(scene, view, at, size_px), passes, history);
    };
    EXPECT_NE(shaded(*after("truck", {5, 8})), alone({5, 8}, "truck")) << "no cut: the next frame of the same path";
    for (const auto& [view, at, reason] :
         {std::tuple("truck", SequenceFrame{6, 8}, "a cut: frame 6 follows frame 4"),
          {"truck", SequenceFrame{4, 8}, "a cut: frame 4 follows frame 4"},
          {"truck", SequenceFrame{0, 8}, "a cut: nothing came before this frame"},
          {"orbit", SequenceFrame{5, 8}, "a cut: the frame before had another view"}}) {
        const auto frame = after(view, at);
        EXPECT_EQ(shaded(*frame), alone(at, view)) << reason;
        EXPECT_EQ(row_of(*frame, "history").reason, reason);
    }
    keep_history(device(), *run_picture(picture_at(scene, "truck", {4, 8}, size_px), passes, history), 4);
    drop_history(*history);
    const auto dropped = run_picture(picture_at(scene, "truck", {5, 8}, size_px), passes, history);
    EXPECT_EQ(shaded(*dropped), alone({5, 8}, "truck"));
    EXPECT_EQ(row_of(*dropped, "history").reason, "no frame before this one");
}

// The plan's reasons come from what is known of the motion; where nothing changed, running the passes changes no bit.
TEST(History, IsPlannedOnlyWhereSomethingChanges)
{
    const Scene moving = load_scene("builtin:moving_boxes"), still = still_scene();
    struct Case {
        const Scene& scene;
        const char*  view;
        int          phases;
        const char*  reason;
    };
    for (const auto& [scene, view, phases, reason] :
         {Case{still, "default", 0, "still camera, 0 of 4 objects move, no jitter"},
          Case{still, "default", 16, "still camera, 0 of 4 objects move, with jitter"},
          Case{moving, "default", 0, "still camera, 2 of 4 objects move, no jitter"},
          Case{still, "truck", 0, "moving camera, 0 of 4 objects move, no jitter"}}) {
        const FrameHistoryPtr history = make_history(device(), size_px);
        keep_history(device(), *run_picture(picture_at(scene, view, {3, phases}, size_px), {}, history), 3);
        const SequencePicture picture = picture_at(scene, view, {4, phases}, size_px);
        const auto            planned = run_picture(picture, {}, history);
        const bool            changes = std::string_view(reason) != "still camera, 0 of 4 objects move, no jitter";
        for (const char* pass : {"reprojection", "history"}) {
            EXPECT_EQ(row_of(*planned, pass).runs, changes) << reason;
            EXPECT_THAT(row_of(*planned, pass).reason, HasSubstr(reason));
        }
        const auto planned_image = shaded(*planned);
        const auto all = make_frame(device(), planned->inputs.lab, planned->inputs.buffers, unculled(plan_of(*planned)),
                                    planned->inputs.history);
        run_frame(device(), *all);
        EXPECT_TRUE(row_of(*all, "history").runs);
        EXPECT_EQ(shaded(*all), planned_image) << reason;
        const auto alone = run_picture(picture, {}, nullptr);
        EXPECT_EQ(shaded(*alone) != planned_image, changes) << reason;
        EXPECT_FALSE(row_of(*alone, "history").runs);
        EXPECT_EQ(row_of(*alone, "history").reason, "a single frame: no history");
    }
}

// A frame may run again before it is kept, and the whole sequence again: the same bits.
TEST(History, IsTheSameOnRerun)
{
    const Scene scene    = load_scene("builtin:moving_boxes");
    const auto  sequence = [&](int runs) {
        const FrameHistoryPtr           history = make_history(device(), size_px);
        std::vector<std::vector<float>> images;
        for (int frame = 0; frame < 6; ++frame) {
            const auto run = run_picture(picture_at(scene, "orbit", {frame, 4}, size_px), {}, history);
            for (int i = 1; i < runs; ++i) run_frame(device(), *run);
            images.push_back(shaded(*run));
            keep_history(device(), *run, frame);
        }
        return images;
    };
    EXPECT_EQ(sequence(1), sequence(3));
}

// What the history holds at a hit that reflects is what the ray shows; a ray that hits anything else shows nothing of it.
TEST(History, FurtherBouncesComeFromIt)
{
    const Scene           scene   = load_scene("builtin:facing_mirrors");
    const ParameterValues passes  = with(plain, {strategy("plane"),
                                                 chosen(Reflectance::metallic),
                                                 chosen(BounceMode::history),
                                                 {"history_weight", 0},
                                                 chosen(ViewerFade::off),
                                                 chosen(EdgeFade::off)});
    const SequencePicture first   = picture_at(scene, "default", {0, 16}, size_px),
                          picture = picture_at(scene, "default", {1, 16}, size_px);
    const GBufferImage     image  = read_gbuffer(device(), *picture.gbuffer);
    std::vector<glm::vec2> vectors_px;
    TraceImage             hits;
    const auto             reflection_after = [&](float held) {
        const FrameHistoryPtr history = make_history(device(), size_px);
        keep_history(device(), *run_picture(first, passes, history, "dda"), 0);
        fill(history->reflection, glm::vec4(held, held, held, 1));
        const auto frame = run_picture(picture, passes, history, "dda");
        EXPECT_EQ(row_of(*frame, "reprojection").reason, "bounces come from the frame before");
        EXPECT_FALSE(row_of(*frame, "history").runs);
        const Reflection reflection = read_colours(picture.buffers->reflection);
        vectors_px                  = read_reprojection(device(), *frame);
        hits                        = counted(*frame);
        return reflection;
    };
    const Reflection after_dark = reflection_after(0), after_bright = reflection_after(9);
    size_t           brighter = 0, others = 0;
    for (size_t i = 0; i < after_dark.size(); ++i) {
        const size_t    hit      = pixel_index(hits.hit_pixel[i], size_px);
        const bool      mirrors  = hits.status[i] == TraceStatus::hit && image.metallic[hit] > 0;
        const glm::vec2 place_px = glm::vec2(hits.hit_pixel[i]) + 0.5F + (mirrors ? vectors_px[hit] : glm::vec2(NAN));
        const bool      held = place_px.x >= 0 && place_px.y >= 0 && place_px.x < size_px.x && place_px.y < size_px.y;
        if (!held) {
            ++others;
            ASSERT_EQ(after_bright[i], after_dark[i]) << "pixel " << i;
            continue;
        }
        ++brighter;
        // C = C_own + (9 - C_own) beta, with beta = metallic^3.
        ASSERT_NEAR(after_bright[i].r - after_dark[i].r, 9 * std::pow(image.metallic[hit], 3), 0.02) << "pixel " << i;
    }
    EXPECT_GT(brighter, 100U);
    EXPECT_GT(others, 1000U);
}

} // namespace
} // namespace ssrlab::test
