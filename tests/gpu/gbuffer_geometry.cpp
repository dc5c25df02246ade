// The G-buffer of built-in scenes against closed forms: every pixel's depth and normal, and which pixels are background.
#include "core/pixel_index.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

/// A view ray in world space: points origin + s * direction; distance along the view axis = s.
struct EyeRay {
    glm::dvec3 origin_ws, direction_ws;
};

EyeRay eye_ray(const View& view, glm::dvec2 position_px)
{
    const glm::dmat4 view_to_world = glm::inverse(view.world_to_view);
    const glm::dvec2 offset        = (position_px - view.centre_px) / view.focal_px * glm::dvec2(1, -1);
    const bool       perspective   = view.projection == Projection::perspective;
    return {glm::dvec3(view_to_world * glm::dvec4(perspective ? glm::dvec2(0) : offset, 0, 1)),
            glm::dvec3(view_to_world * glm::dvec4(perspective ? offset : glm::dvec2(0), -1, 0))};
}

struct Seen {
    double     distance_m = 0;
    glm::dvec3 normal_ws{0};
    uint32_t   object = 0; // the draw's number in the scene, from 1
};

/// The part of a plane (axis = position) where `inside` holds.
void see_plane(const EyeRay& ray, int axis, double position, uint32_t object,
               const std::function<bool(glm::dvec3)>& inside, std::optional<Seen>& nearest)
{
    const double s = (position - ray.origin_ws[axis]) / ray.direction_ws[axis];
    if (!(s > 0) || (nearest && nearest->distance_m < s) || !inside(ray.origin_ws + s * ray.direction_ws)) return;
    glm::dvec3 normal(0);
    normal[axis] = ray.direction_ws[axis] < 0 ? 1 : -1;
    nearest      = Seen{s, normal, object};
}

void see_sphere(const EyeRay& ray, glm::dvec3 centre, double radius, uint32_t object, std::optional<Seen>& nearest)
{
    const glm::dvec3 o = ray.origin_ws - centre, d = ray.direction_ws;
    const double     a = glm::dot(d, d), b = glm::dot(o, d), root = b * b - a * (glm::dot(o, o) - radius * radius);
    if (root < 0) return;
    const double s = (-b - std::sqrt(root)) / a;
    if (!(s > 0) || (nearest && nearest->distance_m < s)) return;
    nearest = Seen{s, glm::normalize(o + s * d), object};
}

std::optional<Seen> floor_and_wall(const EyeRay& ray)
{
    std::optional<Seen> nearest;
    see_plane(
        ray, 1, -1, 1, [](glm::dvec3 p) { return std::abs(p.x) <= 40 && p.z <= 5 && p.z >= -10; }, nearest);
    see_plane(
        ray, 2, -10, 2, [](glm::dvec3 p) { return std::abs(p.x) <= 40 && p.y >= -1 && p.y <= 20; }, nearest);
    return nearest;
}

std::optional<Seen> floor_and_sphere(const EyeRay& ray)
{
    std::optional<Seen> nearest;
    see_plane(
        ray, 1, -1, 1, [](glm::dvec3 p) { return std::abs(p.x) <= 30 && p.z <= 5 && p.z >= -30; }, nearest);
    see_sphere(ray, {0, 0, -5}, 1, 2, nearest);
    return nearest;
}

Camera tilted(double pitch_down_deg, double roll_deg = 0)
{
    const double pitch = pitch_down_deg * std::numbers::pi / 180, roll = roll_deg * std::numbers::pi / 180;
    Camera       camera;
    camera.position_ws = {0, 0, 0};
    camera.target_ws   = {0, -std::sin(pitch), -std::cos(pitch)};
    camera.up_ws       = {std::sin(roll), std::cos(roll), 0};
    camera.fov_y_deg   = 90;
    return camera;
}

struct Slack {
    double depth   = 0; // relative
    double facet_m = 0; // how far facets lie inside the surface that they stand for
    double normal  = 0;
};

constexpr glm::dvec2 around[] = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {0, 0}};

struct Range {
    double low, high;
    void   add(double value) { low = std::min(low, value), high = std::max(high, value); }
};

/// Depths that the pixel may have: Vulkan lets a rasteriser move vertices to a grid of 1/256 px, and those that clipping makes once more.
Range depth_range(const View& view, glm::dvec2 centre, const std::function<std::optional<Seen>(const EyeRay&)>& see,
                  double facet_m)
{
    Range range{2, 0};
    for (const glm::dvec2& offset : around) {
        const EyeRay ray  = eye_ray(view, centre + offset / 128.0);
        const auto   seen = see(ray);
        if (!seen) continue;
        const double cosine = std::abs(glm::dot(glm::normalize(ray.direction_ws), seen->normal_ws));
        range.add(distance_to_depth(view, seen->distance_m));
        if (facet_m > 0) range.add(distance_to_depth(view, seen->distance_m + facet_m / cosine));
    }
    return range;
}

/// What is wrong with a pixel; empty: nothing.
std::string compare_pixel(const Picture& picture, size_t i, glm::dvec2 centre,
                          const std::function<std::optional<Seen>(const EyeRay&)>& see, Slack slack)
{
    const GBufferImage& image = picture.image;
    const auto          seen  = see(eye_ray(picture.view, centre));
    if (image.object_id[i] != (seen ? seen->object : 0))
        return fmt::format("shows object {} instead of {}", image.object_id[i], seen ? seen->object : 0);
    if (!seen)
        return image.depth[i] == 0 && image.normal_vs[i] == glm::vec3(0) && image.metallic[i] == 0
                   ? ""
                   : "background is not empty";
    const double     depth     = static_cast<double>(image.depth[i]);
    const Range      range     = depth_range(picture.view, centre, see, slack.facet_m);
    const double     rounding  = picture.view.projection == Projection::perspective ? slack.depth * depth : slack.depth;
    const glm::dvec3 normal_vs = glm::dmat3(picture.view.world_to_view) * seen->normal_ws;
    if (!(depth >= range.low - rounding && depth <= range.high + rounding))
        return fmt::format("depth {} is outside [{}, {}]", depth, range.low, range.high);
    if (!(glm::length(glm::dvec3(image.normal_vs[i]) - normal_vs) <= slack.normal))
        return fmt::format("normal is off by {}", glm::length(glm::dvec3(image.normal_vs[i]) - normal_vs));
    return std::abs(glm::length(image.normal_vs[i]) - 1) <= 1e-5F ? "" : "normal is not of unit length";
}

/// Compares every pixel except those within 1/64 px of an edge, where the rasteriser may choose either side.
void expect_seen(const Picture& picture, const std::function<std::optional<Seen>(const EyeRay&)>& see, Slack slack)
{
    const View&  view  = picture.view;
    const size_t count = picture.image.depth.size();
    size_t       edges = 0, wrong = 0;
    for (size_t i = 0; i < count; ++i) {
        const int        x = static_cast<int>(i) % view.size_px.x, y = static_cast<int>(i) / view.size_px.x;
        const glm::dvec2 centre = glm::dvec2(x, y) + 0.5;
        const auto       seen   = see(eye_ray(view, centre));
        bool             edge   = false;
        for (const glm::dvec2& offset : around) {
            const auto other = see(eye_ray(view, centre + offset / 64.0));
            edge |= (other ? other->object : 0) != (seen ? seen->object : 0);
        }
        edges += edge;
        const std::string mistake = edge ? "" : compare_pixel(picture, i, centre, see, slack);
        if (!mistake.empty() && wrong++ < 3)
            ADD_FAILURE() << fmt::format("pixel ({}, {}) of {}x{}: {}", x, y, view.size_px.x, view.size_px.y, mistake);
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_LE(static_cast<double>(edges), 0.02 * static_cast<double>(count) + 4);
}

class GBufferPitches : public testing::TestWithParam<double> {};

TEST_P(GBufferPitches, FloorAndWallAreWhereTheFormulasSay)
{
    if (!draws_exactly()) GTEST_SKIP() << "this driver draws less exactly";
    const Scene scene = load_scene("builtin:mirror_floor_wall");
    for (const glm::ivec2& size :
         {glm::ivec2(1, 1), glm::ivec2(97, 1), glm::ivec2(1, 33), glm::ivec2(160, 90), glm::ivec2(321, 203)})
        expect_seen(make_picture(scene, tilted(GetParam(), 7), size), floor_and_wall, {1e-6, 0, 1e-6});
}

// The sphere is made of 256 x 128 facets: its surface lies up to 1.6e-4 m inside, at the distances 4 m to 6 m.
TEST_P(GBufferPitches, SphereIsWhereTheFormulaSays)
{
    if (!draws_exactly()) GTEST_SKIP() << "this driver draws less exactly";
    const Scene scene = load_scene("builtin:sphere_over_mirror");
    const auto  see   = [](const EyeRay& ray) {
        auto seen = floor_and_sphere(ray);
        // Facets and sphere have different outlines: pixels that graze the sphere count as edges.
        const bool grazing =
            seen && seen->object == 2 && std::abs(glm::dot(glm::normalize(ray.direction_ws), seen->normal_ws)) < 0.15;
        if (grazing) seen->object = 1000 + static_cast<uint32_t>(seen->distance_m * 1e6);
        return seen;
    };
    for (const glm::ivec2& size : {glm::ivec2(160, 90), glm::ivec2(321, 203)})
        expect_seen(make_picture(scene, tilted(GetParam()), size), see, {1e-6, 1.6e-4, 2e-3});
}

INSTANTIATE_TEST_SUITE_P(Pitch, GBufferPitches, testing::Values(0, 0.5, 25, 60, -20));

TEST(GBuffer, OrthographicViewsShowTheSamePlanes)
{
    if (!draws_exactly()) GTEST_SKIP() << "this driver draws less exactly";
    Camera camera     = tilted(30);
    camera.projection = Projection::orthographic;
    camera.height_m   = 6;
    camera.near_m     = 0.1;
    camera.far_m      = 50;
    const Scene scene = load_scene("builtin:mirror_floor_wall");
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(97, 1), glm::ivec2(160, 90)})
        expect_seen(make_picture(scene, camera, size),
                    [](const EyeRay& ray) {
                        auto seen = floor_and_wall(ray);
                        return seen && seen->distance_m >= 0.1 && seen->distance_m <= 50 ? seen : std::nullopt;
                    },
                    {3e-7, 0, 1e-6});
}

TEST(GBuffer, VoidIsBackgroundEverywhere)
{
    const Picture picture = make_picture("builtin:void", "default", {33, 17});
    for (size_t i = 0; i < picture.image.depth.size(); ++i) {
        EXPECT_EQ(picture.image.depth[i], 0);
        EXPECT_EQ(picture.image.object_id[i], 0U);
        EXPECT_EQ(picture.image.metallic[i], 0);
    }
}

// Moving the image by whole pixels moves every pixel's content along.
TEST(GBuffer, OffCentreByWholePixelsMovesThePicture)
{
    if (!draws_exactly()) GTEST_SKIP() << "this driver draws less exactly";
    constexpr glm::ivec2 size{160, 90}, shift{5, -3};
    const Scene          scene  = load_scene("builtin:pole_field");
    Camera               camera = tilted(10);
    const Picture        still  = make_picture(scene, camera, size);
    camera.shift_px             = shift;
    const Picture moved         = make_picture(scene, camera, size);
    size_t        other_object = 0, compared = 0;
    for (int y = 3; y < size.y; ++y)
        for (int x = 0; x < size.x - 5; ++x) {
            const auto from = pixel_index({x, y}, size), to = pixel_index(glm::ivec2(x, y) + shift, size);
            ++compared;
            if (still.image.object_id[from] != moved.image.object_id[to]) {
                ++other_object; // an edge that runs through the pixel's centre
                continue;
            }
            EXPECT_NEAR(still.image.depth[from], moved.image.depth[to], 1e-4F * still.image.depth[from] + 1e-9F)
                << x << ", " << y;
            EXPECT_LE(glm::length(still.image.normal_vs[from] - moved.image.normal_vs[to]), 1e-2F) << x << ", " << y;
        }
    EXPECT_LE(other_object, compared / 1000);
}

} // namespace
} // namespace ssrlab::test
