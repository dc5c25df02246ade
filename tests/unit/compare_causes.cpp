// Why rays are wrong: a wall 4 m away, a post of one pixel's width 2 m away, a bend; one ray for each cause.
#include "compare/causes.h"
#include "compare/pictures.h"
#include "truth_gbuffers.h"

namespace ssrlab {
namespace {

using namespace test;

constexpr int    post_x = 12, bend_x = 4;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct CausesCase {
    GBufferImage gbuffer = empty_gbuffer(bench_view({24, 9}));
    SceneTruth   truth;
    TraceImage   tested = make_trace_image({24, 9}, false);

    CausesCase()
    {
        const size_t count = gbuffer.depth.size();
        for (const auto [i, x, y] : pixels_of({24, 9})) {
            set_pixel(gbuffer, x, y, x == post_x ? 2 : x == bend_x ? 4.05 : 4, {0, 0, 1}, 1);
            gbuffer.object_id[at(gbuffer, x, y)] = x == post_x ? 2 : 1;
        }
        gbuffer.gradient.assign(count, {0, 0});
        truth.size_px = {24, 9};
        truth.cls.assign(count, TruthClass::not_traced);
        truth.point_px.resize(count);
        truth.point_vs.resize(count);
        truth.distance_m.assign(count, infinity);
    }

    /// The true point of a ray: at this place, so far from the camera's plane and so far along the ray.
    void set_truth(int ray, TruthClass cls, glm::dvec2 px = {0, 0}, double distance_m = 4, double way_m = infinity)
    {
        const auto i        = size_t(ray);
        truth.cls[i]        = cls;
        truth.point_px[i]   = px;
        truth.point_vs[i]   = {0, 0, -distance_m};
        truth.distance_m[i] = way_m;
        tested.status[i]    = TraceStatus::left_screen;
    }

    void set_end(int ray, TraceStatus status, glm::dvec2 px, double distance_m = 4)
    {
        const auto i           = size_t(ray);
        tested.status[i]       = status;
        tested.hit_pixel[i]    = glm::ivec2(px);
        tested.hit_px_depth[i] = {px, distance_to_depth(gbuffer.view, distance_m)};
    }

    WrongCause cause(int ray) const { return wrong_causes(tested, truth, gbuffer)[size_t(ray)]; }
};

TEST(WrongCauses, OfEachRay)
{
    using enum TraceStatus;
    CausesCase test;
    // Everything that is hit belongs to another object than the rays do.
    for (int ray = 0; ray < 24; ++ray) test.gbuffer.object_id[size_t(ray)] = 9;

    test.set_truth(0, TruthClass::visible, {20.5, 4.5}, 4, 9);
    test.set_end(0, hit, {20.5, 5.4});
    EXPECT_EQ(test.cause(0), WrongCause::right); // within 1 px
    test.set_truth(1, TruthClass::sky);
    EXPECT_EQ(test.cause(1), WrongCause::right); // rightly no hit
    test.set_truth(2, TruthClass::hidden, {20.5, 4.5}, 3, 0.1);
    EXPECT_EQ(test.cause(2), WrongCause::right); // no hit, and nothing to be found
    test.set_end(2, hit, {20.5, 4.5});
    EXPECT_EQ(test.cause(2), WrongCause::not_shown); // far behind the true point
    test.tested.hit_layer[2] = 0;

    test.set_truth(3, TruthClass::visible, {20.5, 4.5}, 3, 5);
    EXPECT_EQ(test.cause(3), WrongCause::thin); // the frame has 4 m there, all around
    test.set_truth(4, TruthClass::visible, {post_x + 1.1, 4.5}, 2, 5);
    EXPECT_EQ(test.cause(4), WrongCause::silhouette); // the post reaches into the next pixel
    test.set_truth(5, TruthClass::sky);
    test.set_end(5, hit, {post_x + 0.5, 4.5}, 2);
    EXPECT_EQ(test.cause(5), WrongCause::silhouette); // past the post's edge
    test.set_truth(6, TruthClass::sky);
    test.set_end(6, hit, {bend_x + 1.5, 4.5});
    EXPECT_EQ(test.cause(6), WrongCause::edge);
    test.set_truth(7, TruthClass::visible, {bend_x - 0.5, 4.5}, 4, 9);
    EXPECT_EQ(test.cause(7), WrongCause::edge); // its pixel holds it, but ends at a bend
    test.set_truth(8, TruthClass::visible, {20.5, 4.5}, 4, 99);
    test.set_end(8, stopped, {18.5, 6.5});
    EXPECT_EQ(test.cause(8), WrongCause::stopped);
    test.set_truth(9, TruthClass::sky);
    test.set_end(9, hit, {18.5, 6.5});
    EXPECT_EQ(test.cause(9), WrongCause::other);
    test.gbuffer.object_id[at(test.gbuffer, 18, 6)] = 9;
    EXPECT_EQ(test.cause(9), WrongCause::own_surface); // its own object, in its own plane
    test.gbuffer.object_id[at(test.gbuffer, 18, 6)] = 1;

    test.set_truth(10, TruthClass::visible, {20.5, 4.5}, 4, 9);
    EXPECT_EQ(test.cause(10), WrongCause::other); // its pixel holds it, in the midst of a plane
    test.gbuffer.normal_vs[10] = glm::normalize(glm::vec3(1, 0, 0.2F));
    EXPECT_EQ(test.cause(10), WrongCause::own_surface); // the shading normal sends it into the wall
}

// What stands straight above a hit, or is not there, makes an edge as what stands beside it does.
TEST(WrongCauses, AllEightNeighboursMayJump)
{
    CausesCase test;
    for (int ray = 0; ray < 24; ++ray) test.gbuffer.object_id[size_t(ray)] = 9;
    test.set_truth(5, TruthClass::sky);
    test.set_end(5, TraceStatus::hit, {20.5, 4.5});
    EXPECT_EQ(test.cause(5), WrongCause::other);
    for (const glm::ivec2& other : {glm::ivec2(20, 3), glm::ivec2(19, 4), glm::ivec2(21, 5)})
        for (const float depth : {0.0F, 0.05F}) {
            float&      at_other = test.gbuffer.depth[at(test.gbuffer, other.x, other.y)];
            const float before   = std::exchange(at_other, depth);
            EXPECT_EQ(test.cause(5), WrongCause::silhouette) << other.x << ' ' << other.y << ' ' << depth;
            at_other = before;
        }
}

// A hit a fifth farther than the true point passed it.
TEST(WrongCauses, AHitBehindTheTruePointPassedIt)
{
    CausesCase test;
    test.gbuffer.object_id[5] = 9;
    test.set_truth(5, TruthClass::visible, {20.5, 4.5}, 3);
    test.set_end(5, TraceStatus::hit, {18.5, 6.5});
    const View&  view  = test.gbuffer.view;
    const double depth = distance_to_depth(view, 4);
    const double way_m = glm::distance(px_to_vs(view, {18.5, 6.5}, depth), px_to_vs(view, {5.5, 0.5}, depth));
    for (const auto& [share, cause] : {std::pair(1.2, WrongCause::thin), {1.0, WrongCause::other}}) {
        test.truth.distance_m[5] = way_m / share;
        EXPECT_EQ(test.cause(5), cause) << share;
    }
}

// A plane turned to the right by 50 degrees sends the sight to the right, away from itself.
TEST(WrongCauses, OrthographicPlanesHaveTheirNormals)
{
    CausesCase test;
    View&      view           = test.gbuffer.view;
    view.projection           = Projection::orthographic;
    view.far_m                = 20;
    const glm::dvec3 normal   = glm::normalize(glm::dvec3(std::sin(0.87), 0, std::cos(0.87)));
    test.gbuffer.normal_vs[5] = glm::vec3(normal);
    test.gbuffer.gradient[5]  = {float(-normal.x / normal.z / view.focal_px.x / (view.far_m - view.near_m)), 0};
    test.set_truth(5, TruthClass::visible, {20.5, 4.5}, 4, 9);
    EXPECT_NE(test.cause(5), WrongCause::own_surface);
    test.gbuffer.gradient[5] *= -1.0F;
    EXPECT_EQ(test.cause(5), WrongCause::own_surface);
}

TEST(WrongCauses, AHiddenPointInALayerBehindIsRight)
{
    CausesCase test;
    test.gbuffer.layers.push_back(test.gbuffer);
    test.set_truth(0, TruthClass::hidden, {20.5, 4.5}, 4, 9);
    test.set_end(0, TraceStatus::hit, {20.5, 4.5});
    EXPECT_NE(test.cause(0), WrongCause::right);
    test.tested.hit_layer[0] = 1;
    EXPECT_EQ(test.cause(0), WrongCause::right);
}

// Beside the bend the second layer is flat.
TEST(WrongCauses, AHitIsJudgedByItsOwnLayer)
{
    CausesCase   test;
    GBufferImage flat = test.gbuffer;
    flat.depth.assign(flat.depth.size(), float(distance_to_depth(flat.view, 4)));
    flat.object_id.assign(flat.object_id.size(), 7);
    test.gbuffer.layers       = {flat};
    test.gbuffer.object_id[6] = 9;
    test.set_truth(6, TruthClass::sky);
    test.set_end(6, TraceStatus::hit, {bend_x + 1.5, 4.5});
    EXPECT_EQ(test.cause(6), WrongCause::edge);
    test.tested.hit_layer[6] = 1;
    EXPECT_EQ(test.cause(6), WrongCause::other);
    test.gbuffer.layers[0].object_id[at(test.gbuffer, bend_x + 1, 4)] = 9;
    EXPECT_EQ(test.cause(6), WrongCause::own_surface);
    test.tested.hit_layer[6] = 0;
    EXPECT_EQ(test.cause(6), WrongCause::edge);
}

// Over 12.7 m, 6 cm before the plane is a sine of 0.005, half a metre one of 0.04.
TEST(WrongCauses, AnOwnSurfaceIsMetNearlyInItsPlane)
{
    CausesCase test;
    for (const size_t i : {size_t(5), at(test.gbuffer, 18, 6)}) test.gbuffer.object_id[i] = 9;
    test.set_truth(5, TruthClass::sky);
    test.set_end(5, TraceStatus::hit, {18.5, 6.5}, 3.94);
    EXPECT_EQ(test.cause(5), WrongCause::own_surface);
    test.set_end(5, TraceStatus::hit, {18.5, 6.5}, 3.5);
    EXPECT_EQ(test.cause(5), WrongCause::other);
}

// All pixels of a leaning wall lie on each other's planes.
TEST(WrongCauses, APlaneLeansAsItsGradientSays)
{
    CausesCase test;
    for (const auto [i, x, y] : pixels_of({24, 9}))
        test.gbuffer.depth[at(test.gbuffer, x, y)] = 0.025F + 0.0005F * float(x - 12) - 0.0003F * float(y - 4);
    test.gbuffer.gradient.assign(test.gbuffer.depth.size(), {0.0005F, -0.0003F});
    test.gbuffer.object_id[5] = 9;
    test.set_truth(5, TruthClass::sky);
    test.set_end(5, TraceStatus::hit, {18.5, 6.5});
    EXPECT_EQ(test.cause(5), WrongCause::other);
    for (const glm::vec2& wrong : {glm::vec2(0, -0.0003F), glm::vec2(0.0005F, 0), glm::vec2(0.0005F, 0.0003F)}) {
        test.gbuffer.gradient.assign(test.gbuffer.depth.size(), wrong);
        EXPECT_NE(test.cause(5), WrongCause::other) << wrong.x << ' ' << wrong.y;
    }
}

TEST(WrongCauses, SharesSumToTheWrongRaysAndColoursTellThemApart)
{
    CausesCase test;
    for (int ray = 0; ray < 4; ++ray) test.set_truth(ray, TruthClass::visible, {20.5, 4.5}, 3, 5); // thin
    test.set_truth(4, TruthClass::sky);
    test.set_truth(5, TruthClass::sky);
    test.gbuffer.object_id[5] = 9;
    test.set_end(5, TraceStatus::hit, {18.5, 6.5}); // other
    const MeasureValues values = count_causes(test.tested, test.truth, test.gbuffer);
    EXPECT_EQ(values.at("wrong_rays"), 5 / 6.0);
    EXPECT_EQ(values.at("wrong_thin"), 4 / 6.0);
    EXPECT_EQ(values.at("wrong_other"), 1 / 6.0);
    double sum = 0;
    for (const auto& [name, value] : values) sum += name == "wrong_rays" ? 0 : value.value();
    EXPECT_DOUBLE_EQ(sum, 5 / 6.0);
    const Image image  = causes_picture(test.tested, test.truth, test.gbuffer);
    const auto  colour = [&](size_t i) {
        return glm::vec3(image.values[3 * i], image.values[3 * i + 1], image.values[3 * i + 2]);
    };
    EXPECT_EQ(colour(6), glm::vec3(0));                                          // not traced
    EXPECT_EQ(colour(5), glm::vec3(1));                                          // other
    EXPECT_TRUE(colour(0).r > 0.5F && colour(0).g > 0.5F && colour(0).b < 0.1F); // thin
    EXPECT_TRUE(colour(4).r < 0.2F && colour(4).r > 0);                          // right
}

} // namespace
} // namespace ssrlab
