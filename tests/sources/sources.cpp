// Sources of answers beyond the frame: what each gets, what it says, and that the frame stays as it is.
#include "compare/all_rays.h"
#include "gpu/device.h"
#include "sources/answer_rays.h"
#include "sources/cube_rays.h"
#include "truth/scene_truth.h"
#include "unit/truth_scenes.h"
#include "world/occupancy.h"

namespace ssrlab::test {
namespace {

const TraceSettings in_sight{.behind = Behind::stop, .surface = "plane_infinite"};

/// A frame and its truth.
struct Traced {
    std::unique_ptr<Stage> stage;
    SourceContext          context;
    SceneTruth             truth;
};

Traced trace_frame(const std::string& name, glm::ivec2 size_px)
{
    auto stage = std::make_unique<Stage>(open_stage(device(), catalogue(), load_scene(name)));
    show(*stage, "default", size_px);
    const Technique& hiz = technique("hiz");
    FrameSettings    settings;
    settings.trace        = in_sight;
    SourceContext context = make_source_context(*stage, hiz, values_of(hiz), settings);
    SceneTruth    truth   = scene_truth(SceneBvh(stage->scene), stage->scene, context.image, in_sight);
    return {std::move(stage), std::move(context), std::move(truth)};
}

AnsweredRays ask(Traced& traced, const std::string& list, HandOn hand_on = HandOn::uncertain)
{
    return answer_rays(traced.context, parse_sources(list, "test"), hand_on);
}

AllRays judge(const Traced& traced, const AnsweredRays& answered)
{
    return compare_all_rays(answered.answers, traced.truth, traced.context.image);
}

TEST(Sources, TheFrameAloneSaysWhatItTraced)
{
    Traced             traced   = trace_frame("builtin:corridor", {160, 90});
    const AnsweredRays answered = ask(traced, "frame");
    ASSERT_EQ(answered.turns.size(), 1U);
    const glm::dmat4 view_to_world = glm::inverse(traced.context.image.view.world_to_view);
    size_t           hits          = 0;
    for (size_t i = 0; i < answered.answers.size(); ++i) {
        const TraceStatus status = traced.context.traced.status[i];
        EXPECT_EQ(answered.answers[i].kind == AnswerKind::not_traced, status == TraceStatus::not_traced);
        EXPECT_EQ(answered.answers[i].kind == AnswerKind::point, status == TraceStatus::hit);
        if (status != TraceStatus::hit) continue;
        const glm::dvec3 at = traced.context.traced.hit_px_depth[i];
        EXPECT_EQ(answered.answers[i].point_ws,
                  glm::dvec3(view_to_world * glm::dvec4(px_to_vs(traced.context.image.view, glm::dvec2(at), at.z), 1)));
        ++hits;
    }
    EXPECT_GT(hits, 1000U);
}

TEST(Sources, ThePictureStaysAsItWas)
{
    Traced           traced = trace_frame("builtin:corridor", {160, 90});
    const Technique& hiz    = technique("hiz");
    const FramePtr   frame  = prepared_frame(make_frame_buffers(*traced.stage), hiz, values_of(hiz), FrameSettings{});
    run_frame(device(), *frame);
    const Image before = read_shaded(device(), *frame);
    ask(traced, "frame,layers,wider,cube,planar,views,world");
    run_frame(device(), *frame);
    EXPECT_EQ(read_shaded(device(), *frame).values, before.values);
}

TEST(Sources, TheWorldAnswersEveryRay)
{
    for (const char* scene : {"builtin:corridor", "builtin:everything"}) {
        SCOPED_TRACE(scene);
        Traced        traced = trace_frame(scene, {160, 90});
        const AllRays all    = judge(traced, ask(traced, "world"));
        EXPECT_GT(all.meeting, 500U);
        EXPECT_GE(*all.f1, 0.9995);
    }
}

TEST(Sources, TheWorldGetsWhatTheFrameIsNotSureOf)
{
    for (const char* scene : {"builtin:corridor", "builtin:everything"}) {
        SCOPED_TRACE(scene);
        Traced             traced   = trace_frame(scene, {320, 180});
        const AnsweredRays answered = ask(traced, "frame,world");
        const SourceCounts frame    = count_source(answered.turns[0], traced.truth, traced.context.image);
        const SourceCounts world    = count_source(answered.turns[1], traced.truth, traced.context.image);
        EXPECT_GE(*judge(traced, answered).f1, 0.99);
        EXPECT_GE(double(frame.certain_right), 0.99 * double(frame.certain_points));
        EXPECT_GE(double(frame.certain_nothing_right), 0.99 * double(frame.certain_nothing));
        EXPECT_LT(world.handed, frame.handed * 3 / 4);
        EXPECT_EQ(world.handed, frame.handed - frame.certain_points - frame.certain_nothing);
        EXPECT_GE(*judge(traced, answered).f1, *judge(traced, ask(traced, "frame")).f1);
        // Rays with an uncertain answer are not lost.
        const AnsweredRays lost = ask(traced, "frame,world", HandOn::lost);
        EXPECT_LT(lost.turns[1].pixels.size(), world.handed);
    }
}

// Behind what it passed, a ray is followed again from where the grid lets it meet anything.
TEST(Sources, TheFrameIsResumedWhereAStoppedRayComesOutAgain)
{
    Traced             traced = trace_frame("builtin:everything", {320, 180});
    const AnsweredRays direct = ask(traced, "frame,world"), resumed = ask(traced, "frame,resume,world");
    const SourceCounts counts = count_source(resumed.turns[1], traced.truth, traced.context.image);
    EXPECT_GT(counts.certain_right, 100U);
    // Most of these rays pass thin things, and the frame may have passed one unseen before it stopped.
    EXPECT_GE(double(counts.certain_right), 0.97 * double(counts.certain_points));
    EXPECT_EQ(resumed.turns[2].pixels.size(),
              direct.turns[1].pixels.size() - counts.certain_points - counts.certain_nothing);
    EXPECT_GE(*judge(traced, resumed).f1, *judge(traced, direct).f1 - 0.002);
    for (size_t k = 0; k < resumed.turns[1].pixels.size(); ++k) {
        const size_t pixel = resumed.turns[1].pixels[k];
        if (traced.context.traced.status[pixel] == TraceStatus::stopped) continue;
        EXPECT_EQ(resumed.turns[1].answers[k].kind, AnswerKind::open); // nothing else is asked again
    }
}

// A cube of frames around the camera has other pixels. A thin thing that the frame shows may fall between them: what
// the frame lost sight of, the cube cannot vouch for.
TEST(Sources, ACubeVouchesForNothingThatTheFrameLostSightOf)
{
    for (const char* source : {"cube", "wider"}) {
        SCOPED_TRACE(source);
        Traced             traced   = trace_frame("builtin:everything", {160, 90});
        const AnsweredRays before   = ask(traced, "frame");
        const AnsweredRays answered = ask(traced, std::string("frame,") + source);
        const SourceTurn&  turn     = answered.turns[1];
        size_t             certain = 0, behind = 0;
        for (size_t k = 0; k < turn.pixels.size(); ++k) {
            const size_t      i      = turn.pixels[k];
            const TraceStatus status = traced.context.traced.status[i];
            certain += turn.answers[k].certain;
            if (!has_place(status)) continue;
            ++behind;
            EXPECT_FALSE(turn.answers[k].certain);
            EXPECT_EQ(turn.answers[k].clear_m, before.answers[i].clear_m);
        }
        EXPECT_GT(certain, 0U); // it vouches for others
        EXPECT_GT(behind, 50U);
    }
}

// Whatever is asked before the triangles may leave them fewer rays, and may make no answer wrong.
TEST(Sources, AskingACubeFirstKeepsTheTrianglesAnswersRight)
{
    Traced             traced = trace_frame("builtin:everything", {160, 90});
    const AnsweredRays direct = ask(traced, "frame,world"), cubed = ask(traced, "frame,cube,world");
    const SourceCounts cube = count_source(cubed.turns[1], traced.truth, traced.context.image);
    EXPECT_GE(*judge(traced, cubed).f1, *judge(traced, direct).f1 - 0.002);
    EXPECT_LT(cubed.turns[2].pixels.size(), direct.turns[1].pixels.size());
    EXPECT_GE(double(cube.certain_right), 0.99 * double(cube.certain_points));
}

// Under the board lies what only another layer or place shows, and at its sides what a wider picture does.
TEST(Sources, FurtherFramesFindWhatTheFrameLacks)
{
    Traced             traced = trace_frame("builtin:hidden_shelf", {160, 90});
    const SourceCounts frame  = count_source(ask(traced, "frame").turns[0], traced.truth, traced.context.image);
    ASSERT_LT(frame.right, frame.meeting * 9 / 10);
    for (const char* id : {"wider", "cube", "layers", "planar", "views"}) {
        SCOPED_TRACE(id);
        const AnsweredRays answered = ask(traced, std::string("frame,") + id, HandOn::lost);
        const SourceCounts counts   = count_source(answered.turns[1], traced.truth, traced.context.image);
        EXPECT_GT(counts.right, counts.meeting / 20);
        EXPECT_GE(double(counts.right), 0.9 * double(counts.points));
        EXPECT_GT(answered.turns[1].draw_ms, 0);
        EXPECT_GT(answered.turns[1].megabytes, 0);
    }
}

// What a flat mirror shows is what its mirrored camera sees, pixel by pixel. At another scale, rays meet places between
// samples, which may belong to another surface.
TEST(Sources, APlanarReflectionIsRightWhereverItAnswers)
{
    struct Row {
        const char* list;
        double      right, certain_right; // at least, as shares
    };
    for (const Row& row :
         {Row{"planar", 1, 1}, Row{"planar:scale=0.5", 0.97, 0.99}, Row{"planar:scale=2", 0.97, 0.99}}) {
        SCOPED_TRACE(row.list);
        Traced             traced = trace_frame("builtin:corridor", {160, 90});
        const SourceCounts counts = count_source(ask(traced, row.list).turns[0], traced.truth, traced.context.image);
        EXPECT_GT(counts.points, counts.handed * 9 / 10); // its floor is the only mirror
        EXPECT_GE(double(counts.right), row.right * double(counts.points));
        EXPECT_GE(double(counts.certain_right), row.certain_right * double(counts.certain_points));
    }
}

Camera camera_at(glm::dvec3 position_ws, glm::dvec3 target_ws)
{
    Camera camera;
    camera.position_ws = position_ws;
    camera.target_ws   = target_ws;
    camera.fov_y_deg   = 90;
    camera.near_m      = 0.5;
    return camera;
}

TEST(Sources, FacesOfACubeMeetAtTheirEdges)
{
    const View centre = camera_to_view(camera_at({1, 2, 3}, {4, 1, -2}), {64, 64});
    size_t     faces  = 0;
    for (int face = 0; face < 6; ++face) {
        const View       view   = face_view(centre, face, 64);
        const glm::dmat4 to_own = view.world_to_view * glm::inverse(centre.world_to_view);
        EXPECT_NEAR(glm::determinant(glm::dmat3(to_own)), 1, 1e-12); // turned, not mirrored
        EXPECT_NEAR(glm::length(glm::dvec3(to_own[3])), 0, 1e-12);   // in the same place
        glm::dvec3 forward(0);
        forward[face / 2] = face % 2 == 0 ? 1 : -1;
        EXPECT_NEAR(glm::dvec3(to_own * glm::dvec4(forward, 0)).z, -1, 1e-12);
        ++faces;
    }
    EXPECT_EQ(faces, 6U);
}

TEST(Sources, ARayIsSeenWhereItIsInsideThePicture)
{
    const View       view     = camera_to_view(camera_at({0, 0, 0}, {0, 0, -1}), {100, 100});
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // From 2 m ahead to the right: it leaves where x = 2.
    OpenRay ray{0, {0, 0, -2}, {1, 0, 0}, 2, 0, infinity};
    auto    part = seen_part(view, ray);
    ASSERT_TRUE(part.has_value());
    EXPECT_NEAR(part->t_in_m, 0, 1e-12);
    EXPECT_NEAR(part->t_out_m, 2, 1e-12);
    EXPECT_TRUE(part->leaves);
    EXPECT_NEAR(to_input(view, ray, *part).delta_px_depth.x, 50, 1e-9);
    // Straight ahead, it ends at infinity in the middle.
    ray  = {0, {1, 0, -2}, {0, 0, -1}, 2, 0, infinity};
    part = seen_part(view, ray);
    ASSERT_TRUE(part.has_value());
    EXPECT_FALSE(part->leaves);
    EXPECT_EQ(to_input(view, ray, *part).end_status, TraceStatus::past_max_distance);
    EXPECT_NEAR(to_input(view, ray, *part).delta_px_depth.x, -25, 1e-9);
    // Toward the camera, the near plane ends it; from behind, it begins there.
    ray  = {0, {0, 0, -2}, {0, 0, 1}, 2, 0, infinity};
    part = seen_part(view, ray);
    EXPECT_NEAR(part.value().t_out_m, 1.5, 1e-12);
    ray  = {0, {0, 0, 4}, {0, 0, -1}, 4, 0, infinity};
    part = seen_part(view, ray);
    EXPECT_NEAR(part.value().t_in_m, 4.5, 1e-12);
    // Away behind the camera, and what is clear already.
    EXPECT_FALSE(seen_part(view, {0, {0, 0, 4}, {0, 0, 1}, 4, 0, infinity}).has_value());
    EXPECT_FALSE(seen_part(view, {0, {0, 0, -2}, {1, 0, 0}, 2, 2.5, infinity}).has_value());
}

// A wall at 4 m is all that the layer shows. A board stands behind it, at 6 m.
TEST(Sources, WhatNoLayerShowsIsInDoubtWhereTheGridIsNotEmpty)
{
    const View   view = camera_to_view(camera_at({0, 0, 0}, {0, 0, -1}), {64, 64});
    GBufferImage layer;
    layer.view = view;
    layer.depth.assign(pixel_count(view.size_px), float(distance_to_depth(view, 4)));
    layer.gradient.assign(layer.depth.size(), glm::vec2(0));
    Scene scene;
    add_quad(scene, add_material(scene, {1, 1, 1}, 0), {-1, -1, -6}, {2, 0, 0}, {0, 2, 0});
    add_quad(scene, add_material(scene, {1, 1, 1}, 0), {-3, -1, -9}, {1, 0, 0}, {0, 2, 0});
    const Occupancy grid = make_occupancy(scene);
    const OpenRay   into{0, {0.5, 0, -3}, glm::normalize(glm::dvec3(-0.1, 0.01, -1)), 3, 0, 1e9};
    EXPECT_TRUE(may_meet_behind(layer, grid, into, 5));
    EXPECT_FALSE(may_meet_behind(layer, grid, into, 2.5)); // it ends before the board
    const OpenRay past{0, {-2, 0, -3}, glm::normalize(glm::dvec3(0.01, 0.01, -1)), 3, 0, 1e9};
    EXPECT_FALSE(may_meet_behind(layer, grid, past, 5)); // behind the wall, through empty cells
    layer.depth.assign(layer.depth.size(), float(distance_to_depth(view, 8)));
    EXPECT_FALSE(may_meet_behind(layer, grid, into, 4)); // before the wall: the layers show the board
    layer.depth.assign(layer.depth.size(), 0);
    EXPECT_FALSE(may_meet_behind(layer, grid, into, 5)); // nothing follows the layer before
}

TEST(Sources, ListsAreChecked)
{
    const auto list = parse_sources("frame,layers:count=3:sides=front,world", "here");
    ASSERT_EQ(list.size(), 3U);
    EXPECT_EQ(list[1].source->id, "layers");
    EXPECT_EQ(list[1].values, (ParameterValues{{"count", 3}, {"sides", 0}}));
    for (const char* wrong : {"", ",", "frame,wurld", "layers:count=9", "layers:count", "world:count=2",
                              "layers:sides=left", "frame,auto", "auto:share=0.5"})
        EXPECT_THROW(parse_sources(wrong, "here"), SpecError) << wrong;
}

} // namespace
} // namespace ssrlab::test
