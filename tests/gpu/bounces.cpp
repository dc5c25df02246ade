// Mirror in mirror: the traced chain against double precision, and history as a recursion.
#include "gpu/passes.h"
#include "scene/scene.h"
#include "truth/screen_truth.h"

namespace ssrlab::test {
namespace {

constexpr double    side_m = 2, back_m = 10;
const TraceSettings settings = boxes({.thickness_m = 0.5, .max_distance_m = 100});

/// Between mirrors at x = -2 and x = 2 the camera looks at a dull back wall 10 m away.
GBufferImage facing_mirrors(glm::ivec2 size_px)
{
    GBufferImage image = empty_gbuffer(bench_view(size_px));
    for (const auto [i, x, y] : pixels_of(size_px)) {
        const double slope = (x + 0.5 - image.view.centre_px.x) / image.view.focal_px.x;
        if (std::abs(slope) * back_m < side_m) {
            set_pixel(image, x, y, back_m, {0, 0, 1}, 0);
            image.radiance[i] = glm::vec3(1);
        } else {
            set_pixel(image, x, y, side_m / std::abs(slope), {slope > 0 ? -1 : 1, 0, 0}, 1);
        }
    }
    return image;
}

/// Every pixel has a colour of its own and some mirrors are duller than others.
GBufferImage coloured_mirrors(glm::ivec2 size_px)
{
    GBufferImage image = facing_mirrors(size_px);
    for (const auto [i, x, y] : pixels_of(size_px)) {
        image.radiance[i] = {static_cast<float>(x) / 256, static_cast<float>(y) / 128, 0.25F};
        if (image.metallic[i] > 0) image.metallic[i] = x % 2 == 0 ? 0.875F : 1.0F;
        // Some show their backs, off which nothing bounces.
        if (y % 8 == 3) image.normal_vs[i] *= -1.0F;
    }
    return image;
}

ParameterValues bouncing(BounceMode mode, int bounces, const ParameterValues& changed = {})
{
    ParameterValues passes   = report_passes();
    passes.at("bounces")     = bounces;
    passes.at("bounce_mode") = choice_value(mode);
    for (const auto& [name, value] : changed) passes.at(name) = value;
    return passes;
}

FramePtr prepare(const Picture& picture, const ParameterValues& passes, const char* id = "hiz")
{
    return prepared_frame(picture.buffers, technique(id), values_of(technique(id)), {settings, "plane", passes});
}

std::vector<float> shaded(ReadyFrame& frame)
{
    run_frame(device(), frame);
    return read_shaded(device(), frame).values;
}

const PlannedPass& bounces_of(const ReadyFrame& frame)
{
    const auto& plan = plan_of(frame).passes;
    return *std::ranges::find_if(plan, [](const PlannedPass& row) { return row.pass->id == "bounces"; });
}

struct Chain {
    glm::dvec3 colour{0};
    double     weight = 0;
};

double beta_of(const GBufferImage& image, glm::ivec2 pixel, double weight)
{
    return std::pow(static_cast<double>(image.metallic[at(image, pixel.x, pixel.y)]), 3) * weight;
}

double weight_of(const View& view, const ScreenRay& ray, const WalkResult& found)
{
    const glm::dvec2 offset = glm::dvec2(found.hit_px_depth) / glm::dvec2(view.size_px) - 0.5;
    return std::max(0.0, -ray.direction_vs.z) * std::clamp(1 - std::abs(offset.x) - std::abs(offset.y), 0.0, 1.0);
}

/// attenuation = inverse
double attenuation_of(const View& view, const ScreenRay& ray, const WalkResult& found)
{
    const auto point_vs = [&](glm::dvec3 px_depth) { return px_to_vs(view, glm::dvec2(px_depth), px_depth.z); };
    return std::min(1.0, 1 / glm::distance(point_vs(ray.origin_px_depth), point_vs(found.hit_px_depth)));
}

struct Following {
    int         bounces     = 0;
    Attenuation attenuation = Attenuation::off;
    Chain       missed      = {}; // what a miss brings back
    bool        fades       = true;
};

/// What the ray from `pixel` brings back after `bounces` further ones; by definition, in double precision.
Chain follow(const GBufferImage& image, const ScreenWalk& walk, glm::ivec2 pixel, glm::dvec3 direction_vs,
             Following following)
{
    const ScreenRay  ray   = make_screen_ray(image, pixel, direction_vs, settings);
    const WalkResult found = walk.walk(ray);
    if (found.status != TraceStatus::hit) return following.missed;
    const glm::ivec2 hit = found.hit_pixel;
    Chain            chain{glm::dvec3(image.radiance[at(image, hit.x, hit.y)]),
                following.fades ? weight_of(image.view, ray, found) : 1};
    const double     attenuation =
        following.attenuation == Attenuation::inverse ? attenuation_of(image.view, ray, found) : 1;
    const glm::dvec3 normal(image.normal_vs[at(image, hit.x, hit.y)]);
    const double     cosine = glm::dot(normal, direction_vs);
    if (following.bounces-- > 0 && reflects(image, hit) && cosine < 0) {
        const Chain next = follow(image, walk, hit, glm::normalize(direction_vs - 2 * cosine * normal), following);
        chain.colour += (next.colour - chain.colour) * beta_of(image, hit, next.weight);
    }
    chain.colour *= attenuation;
    return chain;
}

class Direct : public testing::TestWithParam<const char*> {};

TEST_P(Direct, IsTheChainOfMirrorDirections)
{
    const Picture       picture = make_picture(coloured_mirrors({192, 64}));
    const GBufferImage& image   = picture.image;
    const ScreenWalk    walk(image, settings);
    std::vector<float>  before;
    for (const Following& following : {Following{1}, Following{2}, Following{5}, Following{3, Attenuation::inverse}}) {
        const int  bounces = following.bounces;
        const auto passes  = bouncing(BounceMode::direct, bounces, {chosen(following.attenuation)});
        const auto values  = shaded(*prepare(picture, passes, GetParam()));
        EXPECT_NE(values, before) << bounces << " bounces show more";
        before = values;
        for (const auto [i, x, y] : pixels_of({192, 64})) {
            const glm::ivec2 pixel(x, y);
            glm::dvec3       expected = image.radiance[at(image, x, y)];
            if (reflects(image, pixel)) {
                const Chain chain = follow(image, walk, pixel, mirror_direction_vs(image, pixel), following);
                expected += (chain.colour - expected) * beta_of(image, pixel, chain.weight);
            }
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(static_cast<double>(values[3 * at(image, x, y) + static_cast<size_t>(c)]), expected[c],
                            2e-3 * expected[c] + 5e-4)
                    << x << ' ' << y << ", channel " << c << ", " << bounces << " bounces";
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, Direct, testing::Values("dda", "hiz"),
                         [](const auto& param) { return std::string(param.param); });

// A mirror panel hides the wall, which rays from behind it hit in the second layer: what they bring back is the wall, which reflects nothing, and not the
// panel of the same pixels.
TEST(Bounces, DoNotComeFromWhatStandsBeforeAHit)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), back_m);
    for (size_t i = 0; i < image.radiance.size(); ++i)
        image.radiance[i] = {static_cast<float>(i % 64) / 64, static_cast<float>(i / 64) / 64, 0.25F};
    GBufferImage behind = image;
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        if (y >= 40) image.metallic[at(image, x, y)] = 0; // in front of the panel
        if (std::abs(x - 32) < 12 && y >= 20 && y < 36)
            set_pixel(image, x, y, 4, glm::normalize(glm::dvec3(0, -0.36, 1)), 1); // down on the floor
        else
            behind.depth[at(image, x, y)] = 0;
    }
    image.layers          = {behind};
    const Picture picture = make_picture(image);
    TraceSettings layered = settings;
    layered.layers        = 2;
    const auto prepared   = [&](const ParameterValues& passes) {
        const Technique& t = technique("dda");
        return prepared_frame(picture.buffers, t, values_of(t), {layered, "plane", passes});
    };
    const TraceImage      traced = counted(*prepared(report_passes()));
    const ParameterValues no_fades{chosen(ViewerFade::off), chosen(EdgeFade::off)};
    size_t                hidden = 0;
    for (size_t i = 0; i < traced.status.size(); ++i)
        hidden += traced.status[i] == TraceStatus::hit && traced.hit_layer[i] == 1;
    EXPECT_GT(hidden, 20U);
    const auto without = shaded(*prepared(bouncing(BounceMode::off, 1, no_fades)));
    for (const BounceMode mode : {BounceMode::direct, BounceMode::history}) {
        const auto frame = prepared(bouncing(mode, 2, no_fades));
        EXPECT_FALSE(bounces_of(*frame).runs) << bounces_of(*frame).reason;
        ParameterValues passes            = bouncing(mode, 2, no_fades);
        passes.at("skip_unneeded_passes") = 0;
        EXPECT_EQ(shaded(*prepared(passes)), without);
    }
}

// Mirrors and a wall in the dark, under a sky of one colour: the reflection is the sky wherever the chain ends in a miss.
TEST(Bounces, ThatMissShowTheSky)
{
    Scene scene = load_scene("builtin:facing_mirrors");
    scene.lights.clear();
    scene.ambient = glm::vec3(0);
    for (Material& material : scene.materials) material.emissive = glm::vec3(0);
    const glm::vec3 sky(3, 2, 1);
    scene.environment.size_px     = {4, 2};
    scene.environment.radiance    = std::vector(8, sky);
    const Picture         picture = make_picture(scene, find_camera(scene, "default"), {161, 91});
    const GBufferImage&   image   = picture.image;
    const ScreenWalk      walk(image, settings);
    const ParameterValues plain{chosen(ViewerFade::off), chosen(EdgeFade::off), chosen(Gloss::off)};
    const Following       following{.bounces = 2, .missed = {glm::dvec3(sky), 1}, .fades = false};
    run_frame(device(), *prepare(picture, bouncing(BounceMode::direct, following.bounces, plain)));
    const Reflection found = read_colours(picture.buffers->reflection);
    size_t           rays = 0, lit_by_bounces = 0, wrong = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, image.view.size_px);
        if (!reflects(image, pixel)) continue;
        const glm::dvec3 direction = mirror_direction_vs(image, pixel);
        const Chain      chain     = follow(image, walk, pixel, direction, following);
        ++rays;
        lit_by_bounces += chain.colour.r > 0 &&
                          walk.walk(make_screen_ray(image, pixel, direction, settings)).status == TraceStatus::hit;
        wrong += !(glm::distance(glm::dvec3(found[i]), chain.colour) <= 4e-3);
    }
    EXPECT_GT(lit_by_bounces, 100U);
    EXPECT_LE(wrong, rays / 200) << "of " << rays; // where rounding leads a chain into another pixel
}

// Frame k + 1 shows at a hit that reflects what frame k shows there: the recursion over the pixels that were hit.
TEST(History, IsTheRecursionAndComesToRest)
{
    const Picture       picture = make_picture(coloured_mirrors({192, 64}));
    const GBufferImage& image   = picture.image;
    const ScreenWalk    walk(image, settings);
    constexpr auto      fading = Attenuation::inverse;
    std::vector<Chain>  frame(image.depth.size());
    const auto          next = [&](const std::vector<Chain>* previous) {
        std::vector<Chain> result(image.depth.size());
        for (const auto [i, x, y] : pixels_of({192, 64})) {
            if (!reflects(image, {x, y})) continue;
            const ScreenRay  ray   = make_screen_ray(image, {x, y}, settings);
            const WalkResult found = walk.walk(ray);
            if (found.status != TraceStatus::hit) continue;
            const size_t hit   = at(image, found.hit_pixel.x, found.hit_pixel.y);
            Chain&       chain = result[at(image, x, y)];
            chain              = {image.radiance[hit], weight_of(image.view, ray, found)};
            if (previous != nullptr && reflects(image, found.hit_pixel)) {
                const Chain& seen = (*previous)[hit];
                chain.colour += (seen.colour - chain.colour) * beta_of(image, found.hit_pixel, seen.weight);
            }
            chain.colour *= attenuation_of(image.view, ray, found);
        }
        return result;
    };
    frame = next(nullptr);
    for (int bounces = 1; bounces <= 3; ++bounces) {
        frame             = next(&frame);
        const auto values = shaded(*prepare(picture, bouncing(BounceMode::history, bounces, {chosen(fading)})));
        for (size_t i = 0; i < frame.size(); ++i) {
            glm::dvec3       own = image.radiance[i];
            const glm::ivec2 pixel(static_cast<int>(i % 192), static_cast<int>(i / 192));
            own += (frame[i].colour - own) * beta_of(image, pixel, frame[i].weight);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(static_cast<double>(values[3 * i + static_cast<size_t>(c)]), own[c], 2e-3 * own[c] + 5e-4)
                    << "pixel " << pixel.x << ' ' << pixel.y << ", " << bounces << " frames";
        }
    }
    // Every hit lies farther away than the reflector: the longest chain ends.
    const auto at_rest = shaded(*prepare(picture, bouncing(BounceMode::history, 8)));
    EXPECT_EQ(shaded(*prepare(picture, bouncing(BounceMode::history, 9))), at_rest);
    EXPECT_NE(shaded(*prepare(picture, bouncing(BounceMode::history, 1))), at_rest);
}

TEST(Bounces, DependOnNothingThatRanBefore)
{
    const Picture picture   = make_picture(coloured_mirrors({96, 32}));
    const auto    direct    = prepare(picture, bouncing(BounceMode::direct, 3)),
               history      = prepare(picture, bouncing(BounceMode::history, 3)),
               none         = prepare(picture, bouncing(BounceMode::off, 1));
    const auto first_direct = shaded(*direct), first_history = shaded(*history), first_none = shaded(*none);
    EXPECT_NE(first_direct, first_none);
    EXPECT_NE(first_direct, first_history);
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(shaded(*history), first_history);
        EXPECT_EQ(shaded(*direct), first_direct);
        EXPECT_EQ(shaded(*none), first_none);
    }
}

// Without a mirror among the hits further bounces change no bit; with one, they run and say why.
TEST(Bounces, AreLeftOutWhereNothingThatWasHitReflects)
{
    const Picture dull = make_picture(floor_and_wall(bench_view({64, 64}), 10));
    for (const BounceMode mode : {BounceMode::history, BounceMode::direct}) {
        const auto frame    = prepare(dull, bouncing(mode, 2)),
                   unculled = prepare(dull, bouncing(mode, 2, {{"skip_unneeded_passes", 0}}));
        EXPECT_FALSE(bounces_of(*frame).runs);
        EXPECT_TRUE(bounces_of(*unculled).runs);
        const std::string& reason = bounces_of(*frame).reason;
        EXPECT_TRUE(reason.starts_with("none of ") && reason.ends_with(" hits reflects")) << reason;
        EXPECT_EQ(shaded(*frame), shaded(*unculled)) << choice_value(mode);
    }
    const Picture mirrors = make_picture(coloured_mirrors({96, 32}));
    const auto    frame   = prepare(mirrors, bouncing(BounceMode::direct, 1));
    EXPECT_TRUE(bounces_of(*frame).runs);
    EXPECT_NE(bounces_of(*frame).reason.find(" hits reflect"), std::string::npos) << bounces_of(*frame).reason;
    EXPECT_EQ(shaded(*frame),
              shaded(*prepare(mirrors, bouncing(BounceMode::direct, 1, {{"skip_unneeded_passes", 0}}))));
}

// Rough mirrors of bright and dark columns between which a dark wall stands: a cone sees a mean of half of their light. Where the ray hit a bright
// column that reflects the wall, that column's whole light is taken away again: more than there is.
TEST(Bounces, LeaveNoNegativeLightWhereConesSawLess)
{
    GBufferImage image = facing_mirrors({256, 128});
    for (const auto [i, x, y] : pixels_of({256, 128})) {
        image.radiance[i]  = glm::vec3(image.metallic[i] > 0 && x % 2 == 0 ? 1.0F : 0.0F);
        image.roughness[i] = 0.7F;
    }
    const Picture picture = make_picture(image);
    const auto    frame =
        prepare(picture,
                bouncing(BounceMode::direct, 1, {chosen(Gloss::cone), chosen(ViewerFade::off), chosen(EdgeFade::off)}));
    run_frame(device(), *frame);
    size_t dark = 0, bright = 0;
    for (const glm::vec4& pixel : read_colours(picture.buffers->reflection)) {
        if (pixel.a <= 0) continue;
        ASSERT_GE(pixel.r, 0);
        dark += pixel.r == 0;
        bright += pixel.r > 0.3F;
    }
    EXPECT_GT(dark, 100U);
    EXPECT_GT(bright, 100U);
}

} // namespace
} // namespace ssrlab::test
