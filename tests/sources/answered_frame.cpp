// Pictures with the answers of sources: what the frame does not show reaches them, and what it shows stays.
#include "sources/answered_frame.h"
#include "gpu/device.h"
#include "scene/model.h"
#include "scene/shapes.h"
#include "unit/truth_scenes.h"

namespace ssrlab::test {
namespace {

const glm::vec3 glow{2, 0.5F, 0.25F}; // numbers of half precision

/// A mirror that faces the camera, and behind the camera a wall without end that glows. Nothing else gives light.
Scene mirror_before_glowing_wall(float mirror_roughness, float wall_metallic, glm::vec3 mirror_emissive = {0, 0, 0})
{
    Material mirror = make_material("mirror", {1, 1, 1}, 1, mirror_roughness);
    Material wall   = make_material("wall", glm::vec3(wall_metallic), wall_metallic, wall_metallic > 0 ? 0 : 1);
    wall.emissive   = glow;
    mirror.emissive = mirror_emissive;
    Model          model;
    constexpr auto half_m = 4000.0;
    model.materials       = {mirror, wall};
    model.meshes.push_back(make_quad({-half_m, -half_m, -4}, {2 * half_m, 0, 0}, {0, 2 * half_m, 0}));
    model.meshes.push_back(make_quad({half_m, -half_m, 6}, {-2 * half_m, 0, 0}, {0, 2 * half_m, 0}));
    model.meshes[1].material = 1;
    model.ambient            = glm::vec3(0);
    return model_to_scene(std::move(model), "mirror");
}

struct Shown {
    Image picture, expected; // with the sources' answers; with the same light from everywhere
};

Shown shown_by(const Scene& scene, const std::string& list, glm::vec3 light, const FrameSettings& settings,
               glm::ivec2 size_px = {64, 36})
{
    Stage  stage = open_stage(device(), catalogue(), scene);
    Camera camera;
    camera.position_ws = {0, 0, 0};
    camera.target_ws   = {0, 0, -1};
    show(stage, camera_to_view(camera, size_px));
    const Technique&      hiz     = technique("hiz");
    const LabPtr          lab     = make_lab(stage, hiz, values_of(hiz), settings.trace);
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    const FramePtr        frame =
        make_frame(stage.gpu, lab, buffers, plan_frame(stage, lab, buffers, settings), nullptr, Answers::given);
    SourceContext context = make_source_context(stage, lab);
    run_answered_frame(context, *frame, parse_sources(list, "test"), HandOn::uncertain);
    Shown                        shown{read_shaded(stage.gpu, *frame), {}};
    const std::vector<glm::vec4> everywhere(context.image.depth.size(), glm::vec4(light, 1));
    shown.expected = composite_reflection(stage.gpu, *frame, everywhere);
    return shown;
}

void expect_near(const Image& picture, const Image& expected, double tolerance)
{
    ASSERT_EQ(picture.values.size(), expected.values.size());
    double farthest = 0;
    for (size_t i = 0; i < picture.values.size(); ++i)
        farthest = std::max(farthest, std::abs(double(picture.values[i]) - double(expected.values[i])));
    EXPECT_LE(farthest, tolerance);
}

TEST(AnsweredFrame, AMirrorShowsWhatStandsBehindTheCamera)
{
    const Scene scene = mirror_before_glowing_wall(0, 0);
    const Shown world = shown_by(scene, "frame,world", glow, {});
    EXPECT_EQ(world.picture.values, world.expected.values);
    EXPECT_GT(world.picture.values[0], 0.95F * glow.r);
    // The frame does not show the wall, and there is no other light.
    FrameSettings settings;
    settings.passes.insert_or_assign("miss_light", choice_value(MissLight::environment));
    const Shown frame = shown_by(scene, "frame", glm::vec3(0), settings);
    EXPECT_EQ(frame.picture.values, frame.expected.values);
}

TEST(AnsweredFrame, AMissedRayShowsWhatStandsInItsWay)
{
    FrameSettings settings;
    for (const auto& [miss_light, roughness] :
         {std::pair(MissLight::triangles, 0.0F), {MissLight::triangles, 0.3F}, {MissLight::rooms, 0.0F}}) {
        settings.passes.insert_or_assign("miss_light", choice_value(miss_light));
        const Shown shown = shown_by(mirror_before_glowing_wall(roughness, 0), "frame", glow, settings);
        expect_near(shown.picture, shown.expected, roughness > 0 ? 4 * double(glow.r) / 1024 : 0);
    }
}

// A board before the mirror: the camera sees its blue front, the mirror its green back. A ray that meets the back stops.
TEST(AnsweredFrame, AStoppedRayShowsTheSideThatItMet)
{
    Scene          scene = mirror_before_glowing_wall(0, 0);
    constexpr auto top_m = 0.5, left_m = 0.4, right_m = 0.9, behind_m = 0.01;
    const auto     add_side = [&](glm::dvec3 corner, double across_m, glm::vec3 emissive) {
        Material side = make_material("side", {0, 0, 0}, 0, 1);
        side.emissive = emissive;
        scene.materials.push_back(side);
        add_quad(scene, static_cast<uint32_t>(scene.materials.size() - 1), corner, {across_m, 0, 0}, {0, 2 * top_m, 0});
    };
    add_side({left_m, -top_m, -2}, right_m - left_m, {0, 0, 4});
    add_side({right_m, -top_m, -2 - behind_m}, left_m - right_m, {0, 4, 0});
    struct Count {
        size_t front = 0, back = 0;
    };
    const auto count = [&](MissLight miss_light) {
        FrameSettings settings;
        settings.passes.insert_or_assign("miss_light", choice_value(miss_light));
        const Image picture = shown_by(scene, "frame", glow, settings).picture;
        Count       pixels;
        for (size_t i = 0; i < picture.values.size(); i += picture.channels.size()) {
            pixels.back += picture.values[i + 1] > 3 ? 1 : 0;
            pixels.front += picture.values[i + 2] > 3 ? 1 : 0;
        }
        return pixels;
    };
    const Count as_front = count(MissLight::environment), as_met = count(MissLight::triangles);
    EXPECT_EQ(as_front.back, 0U);
    EXPECT_GT(as_met.back, 10U);
    EXPECT_EQ(as_met.front + as_met.back, as_front.front);
}

// More than a row of workgroups: their lists, which shaders append to, are launched to the end.
TEST(AnsweredFrame, EveryMissedRayOfALargePictureShowsIt)
{
    constexpr glm::ivec2 size_px{161, 129};
    static_assert(size_px.x * size_px.y > RAYS_PER_GROUP * LAUNCH_ROW_GROUPS);
    FrameSettings settings;
    settings.passes.insert_or_assign("miss_light", choice_value(MissLight::triangles));
    const Shown shown = shown_by(mirror_before_glowing_wall(0, 0), "frame", glow, settings, size_px);
    EXPECT_EQ(shown.picture.values, shown.expected.values);
}

// The mirror glows, too, and the wall is a mirror: two further bounces bring back the light of the wall, of the mirror
// and of the wall again.
TEST(AnsweredFrame, AMissedRayShowsWhatTheMetWallReflects)
{
    const Scene   scene = mirror_before_glowing_wall(0, 1, glow);
    FrameSettings settings;
    settings.passes.insert_or_assign("miss_light", choice_value(MissLight::triangles));
    for (const auto& [bounces, light] : {std::pair(BounceMode::off, glow), {BounceMode::direct, 3.0F * glow}}) {
        settings.passes.insert_or_assign("bounce_mode", choice_value(bounces));
        const Shown shown = shown_by(scene, "frame", light, settings);
        expect_near(shown.picture, shown.expected, 8 * double(glow.r) / 1024);
    }
}

/// A frame without sources, as it is planned and with every pass.
struct PlannedPicture {
    Image       planned, unculled;
    PlannedPass missed_rays;
};

PlannedPicture planned_picture(const Scene& scene, MissLight miss_light, Gloss gloss)
{
    FrameSettings settings;
    settings.passes.insert_or_assign("miss_light", choice_value(miss_light));
    settings.passes.insert_or_assign("gloss", choice_value(gloss));
    Stage stage = open_stage(device(), catalogue(), scene);
    show(stage, "default", {161, 91});
    const Technique&      hiz     = technique("hiz");
    const LabPtr          lab     = make_lab(stage, hiz, values_of(hiz), settings.trace);
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    const FramePlan       plan    = plan_frame(stage, lab, buffers, settings);
    PlannedPicture        result;
    result.missed_rays = *std::ranges::find(plan.passes, "missed_rays", &PlannedPass::id);
    for (const bool all : {false, true}) {
        const FramePtr frame = make_frame(stage.gpu, lab, buffers, all ? unculled(plan) : plan);
        run_frame(stage.gpu, *frame);
        (all ? result.unculled : result.planned) = read_shaded(stage.gpu, *frame);
    }
    return result;
}

TEST(MissedRays, SkippingThePassChangesNoBit)
{
    const Scene scene = load_scene("builtin:everything");
    for (const Gloss gloss : {Gloss::stochastic, Gloss::blur}) {
        const PlannedPicture followed = planned_picture(scene, MissLight::triangles, gloss);
        EXPECT_TRUE(followed.missed_rays.runs);
        EXPECT_NE(followed.missed_rays.reason.find("followed rays meet a triangle"), std::string::npos);
        EXPECT_EQ(followed.planned.values, followed.unculled.values);
        EXPECT_NE(followed.planned.values, planned_picture(scene, MissLight::environment, gloss).planned.values);
    }
}

// No missed ray of this scene meets anything.
TEST(MissedRays, RoomsLeaveOpenScenesAsTheyAre)
{
    const Scene          scene = load_scene("builtin:pole_field");
    const PlannedPicture open  = planned_picture(scene, MissLight::rooms, Gloss::stochastic);
    EXPECT_FALSE(open.missed_rays.runs);
    EXPECT_NE(open.missed_rays.reason.find("below 0.1 %"), std::string::npos) << open.missed_rays.reason;
    EXPECT_EQ(open.planned.values, open.unculled.values);
    EXPECT_EQ(open.planned.values, planned_picture(scene, MissLight::environment, Gloss::stochastic).planned.values);
}

// The pose of each frame is followed, whichever frame came before: the picture is that of a scene that stands so.
TEST(MissedRays, FollowAMovingSceneWhereItIs)
{
    const Scene moving = load_scene("builtin:moving_boxes");
    const auto  shown  = [](Stage& stage, int frame) {
        FrameSettings settings;
        settings.passes.insert_or_assign("gloss", choice_value(Gloss::off));
        show(stage, "default", {161, 91}, {frame, 0});
        const Technique&      hiz     = technique("hiz");
        const LabPtr          lab     = make_lab(stage, hiz, values_of(hiz), settings.trace);
        const FrameBuffersPtr buffers = make_frame_buffers(stage);
        const FramePlan       plan    = plan_frame(stage, lab, buffers, settings);
        EXPECT_TRUE(runs(plan, "missed_rays"));
        const FramePtr ready = make_frame(stage.gpu, lab, buffers, plan);
        run_frame(stage.gpu, *ready);
        return read_shaded(stage.gpu, *ready);
    };
    Stage       stage = open_stage(device(), catalogue(), moving);
    const Image first = shown(stage, 0), later = shown(stage, 12);
    Scene       still = scene_at(moving, 12);
    for (Draw& draw : still.draws) draw.motion = {};
    Stage posed = open_stage(device(), catalogue(), still);
    expect_near(later, shown(posed, 0), 1e-3);
    EXPECT_EQ(shown(stage, 0).values, first.values);
    EXPECT_NE(later.values, first.values);
    Stage fresh = open_stage(device(), catalogue(), moving);
    EXPECT_EQ(shown(fresh, 12).values, later.values);
}

TEST(MissedRays, FollowNoRayBecauseAnEarlierFrameDid)
{
    Stage stage = open_stage(device(), catalogue(), load_scene("builtin:moving_boxes"));
    show(stage, "default", {161, 91});
    const Technique&      hiz     = technique("hiz");
    const FrameBuffersPtr buffers = make_frame_buffers(stage);
    for (const MissLight miss_light : {MissLight::triangles, MissLight::environment}) {
        FrameSettings settings;
        settings.passes.insert_or_assign("miss_light", choice_value(miss_light));
        const LabPtr lab = make_lab(stage, hiz, values_of(hiz), settings.trace);
        EXPECT_EQ(runs(plan_frame(stage, lab, buffers, settings), "missed_rays"), miss_light == MissLight::triangles);
    }
}

// The mirror stands alone: the unculled frame follows its rays and finds nothing.
TEST(MissedRays, ShowTheEnvironmentWhereTheSceneIsOpen)
{
    Scene scene = load_scene("builtin:everything");
    std::erase_if(scene.draws, [](const Draw& draw) { return draw.name != "floor"; });
    ASSERT_EQ(scene.draws.size(), 1U);
    for (const Gloss gloss : {Gloss::stochastic, Gloss::blur}) {
        const PlannedPicture open = planned_picture(scene, MissLight::triangles, gloss);
        EXPECT_FALSE(open.missed_rays.runs);
        EXPECT_EQ(open.missed_rays.reason.substr(0, 5), "0 of ");
        EXPECT_EQ(open.planned.values, open.unculled.values);
        EXPECT_EQ(open.planned.values, planned_picture(scene, MissLight::environment, gloss).planned.values);
    }
}

TEST(AnsweredFrame, ARoughMirrorShowsItByTheRaysOfItsLobe)
{
    FrameSettings settings;
    for (const int rays : {1, 2}) {
        settings.passes.at("rays_per_pixel") = rays;
        const Shown world                    = shown_by(mirror_before_glowing_wall(0.3F, 0), "world", glow, settings);
        expect_near(world.picture, world.expected, 4 * double(glow.r) / 1024);
    }
}

// Light goes from the wall to the mirror and back once more: L = e + e, for white mirrors keep all of it.
TEST(AnsweredFrame, TheWorldFollowsFurtherReflections)
{
    const Scene scene = mirror_before_glowing_wall(0, 1);
    const Shown once  = shown_by(scene, "world:bounces=0", glow, {});
    EXPECT_EQ(once.picture.values, once.expected.values);
    const Shown again = shown_by(scene, "world:bounces=2", 2.0F * glow, {});
    expect_near(again.picture, again.expected, 8 * double(glow.r) / 1024);
}

TEST(AnsweredFrame, TheSourceFrameChangesNoBit)
{
    Stage stage = open_stage(device(), catalogue(), load_scene("builtin:everything"));
    show(stage, "default", {160, 90});
    const Technique&      hiz      = technique("hiz");
    const FrameSettings   settings = {};
    const LabPtr          lab      = make_lab(stage, hiz, values_of(hiz), settings.trace);
    const FrameBuffersPtr buffers  = make_frame_buffers(stage);
    const FramePlan       plan     = plan_frame(stage, lab, buffers, settings);
    const FramePtr        own      = make_frame(stage.gpu, lab, buffers, plan);
    const FrameTimes      times    = run_frame(stage.gpu, *own);
    const Image           alone    = read_shaded(stage.gpu, *own);
    const FramePtr        given    = make_frame(stage.gpu, lab, buffers, plan, nullptr, Answers::given);
    SourceContext         context  = make_source_context(stage, lab);
    const FrameTimes answered = run_answered_frame(context, *given, parse_sources("frame", "test"), HandOn::uncertain);
    EXPECT_EQ(read_shaded(stage.gpu, *given).values, alone.values);
    ASSERT_EQ(answered.passes_ms.size(), times.passes_ms.size());
    for (size_t i = 0; i < times.passes_ms.size(); ++i)
        EXPECT_EQ(answered.passes_ms[i].first, times.passes_ms[i].first);
    const FramePtr world = make_frame(stage.gpu, lab, buffers, plan, nullptr, Answers::given);
    run_answered_frame(context, *world, parse_sources("frame,world", "test"), HandOn::uncertain);
    EXPECT_NE(read_shaded(stage.gpu, *world).values, alone.values);
}

} // namespace
} // namespace ssrlab::test
