// The second depth layer against closed forms: what it shows, what the rays that missed find in it, and that leaving it out
// where nothing missed changes nothing.
#include "gpu/device.h"
#include "unit/truth_scenes.h"

namespace ssrlab::test {
namespace {

constexpr double panel_m = 4, wall_m = 8;

void set_bounds(Scene& scene)
{
    for (Draw& draw : scene.draws) {
        draw.bounds_min_ws = glm::vec3(-500);
        draw.bounds_max_ws = glm::vec3(500);
    }
}

/// A mirror floor, a wall at 8 m and before it, at 4 m, a panel above the floor: |x| <= 1, 0 <= y <= 1.
Scene panel_before_wall(bool with_panel = true)
{
    Scene scene;
    scene.ambient         = glm::vec3(1); // radiance = base colour
    const uint32_t mirror = add_material(scene, glm::vec3(0.0F), 1), wall = add_material(scene, {0, 1, 0}, 0),
                   panel = add_material(scene, {1, 0, 0}, 0);
    // Neither goes on behind the other: the second layer would show it.
    add_quad(scene, mirror, {-200, -1, 10}, {400, 0, 0}, {0, 0, -10 - wall_m});
    add_quad(scene, wall, {-200, -1, -wall_m}, {400, 0, 0}, {0, 200, 0});
    if (with_panel) add_quad(scene, panel, {-1, 0, -panel_m}, {2, 0, 0}, {0, 1, 0});
    set_bounds(scene);
    return scene;
}

Camera level_camera(Projection projection = Projection::perspective)
{
    Camera camera;
    camera.name        = "default";
    camera.position_ws = {0, 0, 0};
    camera.target_ws   = {0, 0, -1};
    camera.fov_y_deg   = 90;
    camera.projection  = projection;
    return camera;
}

ParameterValues passes_with(const ParameterValues& changed)
{
    ParameterValues passes            = report_passes();
    passes.at("hidden_layer")         = 1;
    passes.at("gloss")                = choice_value(Gloss::off); // each pixel shows what its own ray found
    passes.at("environment_fallback") = 0;
    for (const auto& [name, value] : changed) passes.at(name) = value;
    return passes;
}

const PlannedPass& planned(const ReadyFrame& frame, const std::string& id)
{
    const auto& plan = plan_of(frame).passes;
    return *std::ranges::find_if(plan, [&](const PlannedPass& row) { return row.pass->id == id; });
}

FramePtr prepare(const Picture& picture, const std::string& id, const TraceSettings& settings,
                 const ParameterValues& changed = {})
{
    const Technique& t = technique(id);
    return prepared_frame(picture.buffers, t, values_of(t), {settings, "plane", passes_with(changed)});
}

std::vector<float> shaded(ReadyFrame& frame)
{
    run_frame(device(), frame);
    return read_shaded(device(), frame).values;
}

const TraceSettings thin = boxes({.thickness_m = 0.5, .max_distance_m = 100});

/// Does the view ray through this pixel's centre meet the panel?
bool on_panel(const View& view, glm::ivec2 pixel)
{
    const glm::dvec3 at = px_to_vs(view, glm::dvec2(pixel) + 0.5, distance_to_depth(view, panel_m));
    return std::abs(at.x) < 1 && at.y > 0 && at.y < 1;
}

class Layers : public testing::TestWithParam<Projection> {};

// Behind the panel stands the wall; behind everything else stands nothing.
TEST_P(Layers, TheSecondShowsWhatThePanelHides)
{
    const Picture picture = make_picture(panel_before_wall(), level_camera(GetParam()), {96, 64});
    for (const double separation_m : {0.0, 0.1, 3.9, 4.1}) {
        const auto frame =
            prepare(picture, "hiz", thin, {{"skip_unneeded_passes", 0}, {"hidden_layer_separation_m", separation_m}});
        run_frame(device(), *frame);
        const GBufferImage layer = read_second_layer(device(), *frame);
        size_t             shown = 0;
        for (const auto [i, x, y] : pixels_of({96, 64})) {
            const bool expected = on_panel(picture.view, {x, y}) && separation_m < wall_m - panel_m;
            ASSERT_EQ(layer.depth[i] > 0, expected) << x << ' ' << y << ", separation " << separation_m;
            if (!expected) continue;
            ++shown;
            EXPECT_NEAR(depth_to_distance(picture.view, static_cast<double>(layer.depth[i])), wall_m, 1e-4);
            EXPECT_EQ(layer.object_id[i], 2U);
            EXPECT_EQ(layer.radiance[i], glm::vec3(0, 1, 0));
            EXPECT_EQ(layer.normal_vs[i], glm::vec3(0, 0, 1));
        }
        EXPECT_EQ(shown > 100, separation_m < 4) << shown;
    }
}

// In the walk no separation is asked for, and what faces away is left out even if its material has two sides.
TEST_P(Layers, OfTheWalkShowTheNextSurfacesThatFaceTheCamera)
{
    if (most_layers() < 4) GTEST_SKIP() << "this device has too few images for four layers";
    Scene scene                     = panel_before_wall();
    scene.materials[1].double_sided = true;
    add_quad(scene, 1, {-1, 0, -5}, {0, 1, 0}, {2, 0, 0});   // seen from behind
    add_quad(scene, 1, {-1, 0, -4.1}, {2, 0, 0}, {0, 1, 0}); // close behind the panel
    for (Draw& draw : scene.draws) {
        draw.bounds_min_ws = glm::vec3(-500);
        draw.bounds_max_ws = glm::vec3(500);
    }
    const Picture picture  = make_picture(scene, level_camera(GetParam()), {96, 64});
    TraceSettings settings = boxes({.thickness_m = 0.1, .max_distance_m = 100});
    settings.layers        = 4;
    trace(picture, technique("dda"), values_of(technique("dda")), settings);
    const GBufferImage with = read_gbuffer(device(), *picture.gbuffer);
    ASSERT_EQ(with.layers.size(), 3U);
    const double distances_m[] = {4.1, wall_m};
    size_t       shown         = 0;
    for (const auto [i, x, y] : pixels_of({96, 64})) {
        if (!on_panel(picture.view, {x, y})) continue;
        // A view ray through the panel's edge may pass the quad behind it.
        if (GetParam() == Projection::perspective && with.layers[0].depth[i] > 0 &&
            depth_to_distance(picture.view, double(with.layers[0].depth[i])) > 5)
            continue;
        ++shown;
        for (size_t layer = 0; layer < 2; ++layer)
            EXPECT_NEAR(depth_to_distance(picture.view, double(with.layers[layer].depth[i])), distances_m[layer], 1e-3);
        EXPECT_LE(with.layers[2].depth[i], 0);
    }
    EXPECT_GT(shown, 50U);
}

INSTANTIATE_TEST_SUITE_P(Projections, Layers, testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& param) {
                             return param.param == Projection::perspective ? "perspective" : "orthographic";
                         });

class HiddenLayer : public testing::TestWithParam<const char*> {};

// The wall's mirror image without the panel is the answer: rays that pass behind the panel find the wall in the second layer where
// they would have found it in the first, had the panel not stood there.
TEST_P(HiddenLayer, RaysThatMissedFindTheWallBehindThePanel)
{
    const glm::ivec2 size_px(192, 128);
    const Picture    with      = make_picture(panel_before_wall(), level_camera(), size_px);
    const Picture    bare      = make_picture(panel_before_wall(false), level_camera(), size_px);
    const auto       frame     = prepare(with, GetParam(), thin);
    const TraceImage first     = counted(*frame);
    const TraceImage unblocked = trace(bare, technique(GetParam()), values_of(technique(GetParam())), thin);
    EXPECT_TRUE(planned(*frame, "hidden_layer").runs);
    EXPECT_NE(planned(*frame, "hidden_layer").reason.find("rays missed"), std::string::npos);
    run_frame(device(), *frame);
    const TraceImage second    = *read_hidden_hits(device(), *frame);
    const Image      picture   = read_shaded(device(), *frame);
    const auto       without   = prepare(with, GetParam(), thin, {{"hidden_layer", 0}});
    const auto       holes     = shaded(*without);
    size_t           recovered = 0;
    for (size_t i = 0; i < first.status.size(); ++i) {
        if (first.status[i] == TraceStatus::not_traced) continue;
        const bool hidden = unblocked.status[i] == TraceStatus::hit && on_panel(with.view, unblocked.hit_pixel[i]) &&
                            first.status[i] != TraceStatus::hit;
        ASSERT_EQ(second.status[i] == TraceStatus::hit, hidden) << "ray " << i;
        if (!hidden) {
            for (size_t c = 0; c < 3; ++c) ASSERT_EQ(picture.values[3 * i + c], holes[3 * i + c]) << "pixel " << i;
            continue;
        }
        ++recovered;
        EXPECT_EQ(second.hit_pixel[i], unblocked.hit_pixel[i]);
        EXPECT_EQ(holes[3 * i + 1], 0) << "ghost shadow";
        EXPECT_GT(picture.values[3 * i + 1], 0.2F) << "the wall is green";
        EXPECT_EQ(picture.values[3 * i], 0) << "the panel is red";
    }
    EXPECT_GT(recovered, 50U);
}

INSTANTIATE_TEST_SUITE_P(Techniques, HiddenLayer, testing::Values("dda", "hiz"),
                         [](const auto& param) { return std::string(param.param); });

// The pyramid that a technique walks has to be the second layer's, too.
TEST(HiddenLayerWalk, HizFindsThereWhatThePixelWalkFinds)
{
    const Picture picture = make_picture("builtin:everything", "default", {641, 359});
    const auto    found   = [&](const char* id, const ParameterValues& changed = {}) {
        const auto frame = prepare(picture, id, thin, changed);
        run_frame(device(), *frame);
        return *read_hidden_hits(device(), *frame);
    };
    const TraceImage walk = found("dda");
    std::string      first;
    EXPECT_EQ(count_differences(found("hiz"), walk, bit_equal_t, first), 0U) << first;
    EXPECT_EQ(count_differences(found("hiz", {{"skip_unneeded_passes", 0}}), walk, bit_equal_t, first), 0U)
        << "what does not reflect looks for nothing there: " << first;
    EXPECT_GT(std::ranges::count(walk.status, TraceStatus::hit), 1000);
}

TEST(HiddenLayerPlan, NeedsTheScene)
{
    const Picture uploaded = make_picture(floor_and_wall(bench_view({32, 32}), 10));
    const auto    frame    = prepare(uploaded, "hiz", thin, {{"skip_unneeded_passes", 0}});
    EXPECT_FALSE(planned(*frame, "hidden_layer").runs);
    EXPECT_EQ(planned(*frame, "hidden_layer").reason, "no scene to draw again");
}

TEST(HiddenLayerPlan, IsOffUpToTheThreshold)
{
    const Picture picture = make_picture(panel_before_wall(), level_camera(), {96, 64});
    for (const double skips : {0.0, 1.0}) {
        EXPECT_TRUE(planned(*prepare(picture, "hiz", thin, {{"skip_unneeded_passes", skips}}), "hidden_layer").runs);
        const auto frame =
            prepare(picture, "hiz", thin, {{"skip_unneeded_passes", skips}, {"hidden_layer_threshold", 0.9}});
        EXPECT_FALSE(planned(*frame, "hidden_layer").runs);
        EXPECT_NE(planned(*frame, "hidden_layer").reason.find("the threshold is 90 %"), std::string::npos);
    }
}

// A mirror just before the wall: every ray hits, and the second layer, drawn all the same, changes no bit.
TEST(HiddenLayerPlan, IsLeftOutWhereEveryRayHits)
{
    Scene scene = panel_before_wall();
    scene.vertices.resize(0);
    scene.indices.resize(0);
    scene.draws.resize(0);
    add_quad(scene, 0, {-1, -1, -6}, {2, 0, 0}, {0, 0, -1});
    add_wall(scene, 1, wall_m);
    add_quad(scene, 2, {-1, 0, -panel_m}, {2, 0, 0}, {0, 1, 0});
    set_bounds(scene);
    const Picture picture  = make_picture(scene, level_camera(), {96, 64});
    const auto    frame    = prepare(picture, "hiz", thin);
    const auto    unculled = prepare(picture, "hiz", thin, {{"skip_unneeded_passes", 0}});
    EXPECT_FALSE(planned(*frame, "hidden_layer").runs);
    EXPECT_TRUE(planned(*unculled, "hidden_layer").runs);
    const std::string& reason = planned(*frame, "hidden_layer").reason;
    EXPECT_TRUE(reason.starts_with("none of ") && reason.ends_with(" rays missed")) << reason;
    EXPECT_EQ(reason, planned(*unculled, "hidden_layer").reason) << "only pixels that reflect count";
    EXPECT_EQ(shaded(*frame), shaded(*unculled));
}

} // namespace
} // namespace ssrlab::test
