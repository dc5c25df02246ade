// Rays as the shader sets them up against the host's double precision: also a round trip of everything that both sides share
// (the view's uniform block, the settings' constants, packed pixels and statuses).
#include "frame/frame_inputs.h"
#include "gpu/device.h"
#include "shared.h"
#include "truth/screen_ray.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

using Rays = std::vector<PackedRay<double>>;

template <typename Real>
Rays make_rays(const Picture& picture, const TraceSettings& settings, NumberFormat number_format)
{
    const Technique&  dda     = technique("dda");
    const LabPtr      lab     = lab_on_picture(picture, dda, values_of(dda), settings);
    const RayBuffers  buffers = make_ray_buffers(device(), picture.image.depth.size(), number_format);
    const Buffer      view    = upload_view(device(), picture.view, number_format);
    const TracePasses passes  = make_trace_passes(device(), *lab, buffers, view);
    submit(device(), [&](const Commands& commands) { record_rays(commands, passes, *picture.gbuffer); });
    Rays rays;
    for (const PackedRay<Real>& ray : read_list<Real>(device(), buffers))
        rays.push_back({ray.origin, static_cast<double>(ray.length_m), ray.delta, ray.pixel});
    return rays;
}

/// How far two numbers are apart, where equal infinities are not apart at all.
double gap(double a, double b) { return a == b ? 0 : std::abs(a - b); }

struct Worst {
    double origin_px = 0, delta_px = 0, depth = 0, length = 0; // depth and length relative
    size_t other_end = 0;
    size_t rays      = 0;
};

Worst compare(const Picture& picture, const TraceSettings& settings, const Rays& rays)
{
    Worst worst;
    worst.rays        = rays.size();
    size_t reflecting = 0;
    for (const auto [i, x, y] : pixels_of(picture.view.size_px))
        reflecting += reflects(picture.image, {x, y}, settings);
    EXPECT_EQ(rays.size(), reflecting);
    std::vector<bool> seen(picture.image.depth.size());
    for (const PackedRay<double>& listed : rays) {
        const glm::ivec2 pixel = unpack_pixel(listed.pixel);
        EXPECT_FALSE(seen.at(at(picture.image, pixel.x, pixel.y)))
            << "two rays for pixel (" << pixel.x << ", " << pixel.y << ")";
        seen[at(picture.image, pixel.x, pixel.y)] = true;
        const ScreenRay ray                       = make_screen_ray(picture.image, pixel, settings);
        EXPECT_TRUE(ray.traced);
        worst.other_end += unpack_status(listed.pixel) != ray.end_status; // two limits within rounding
        const double nearest = std::max(ray.origin_px_depth.z, std::abs(ray.origin_px_depth.z + ray.delta_px_depth.z));
        worst.origin_px =
            std::max(worst.origin_px, glm::length(glm::dvec2(listed.origin) - glm::dvec2(ray.origin_px_depth)));
        worst.delta_px =
            std::max(worst.delta_px, glm::length(glm::dvec2(listed.delta) - glm::dvec2(ray.delta_px_depth)));
        worst.depth = std::max({worst.depth, gap(listed.origin.z, ray.origin_px_depth.z) / nearest,
                                gap(listed.delta.z, ray.delta_px_depth.z) / nearest});
        if (glm::length(ray.delta_px_depth) > 0)
            worst.length =
                std::max(worst.length, gap(listed.length_m, ray.length_m - settings.ray_offset_m) / ray.length_m);
    }
    return worst;
}

View off_centre_view(glm::ivec2 size)
{
    View view      = bench_view(size, 0.05);
    view.centre_px = {0.3 * size.x, 0.8 * size.y};
    view.focal_px  = {0.7 * size.x, 0.9 * size.x};
    return view;
}

View orthographic_view(glm::ivec2 size)
{
    View view       = bench_view(size);
    view.projection = Projection::orthographic;
    view.focal_px   = glm::dvec2(12);
    view.far_m      = 30;
    return view;
}

/// Half metals, and dielectrics at the bounds of what reflects and beside them.
GBufferImage materials(const View& view)
{
    GBufferImage image            = random_gbuffer(view, 9);
    const float  beyond_roughness = std::nextafter(0.4F, 1.0F), below_f0 = std::nextafter(0.02F, 0.0F);
    image.dielectric_f0.resize(image.depth.size());
    image.roughness.resize(image.depth.size());
    for (size_t i = 0; i < image.depth.size(); ++i) {
        image.metallic[i]      = i % 5 == 0 ? 0.25F : 0;
        image.dielectric_f0[i] = std::array{0.02F, below_f0, 0.5F}[i % 3];
        image.roughness[i]     = std::array{0.4F, beyond_roughness}[i % 2];
    }
    return image;
}

struct Case {
    const char*   name;
    GBufferImage  image;
    TraceSettings settings = boxes();
};

std::vector<Case> cases()
{
    constexpr double  infinity = std::numeric_limits<double>::infinity();
    std::vector<Case> list;
    for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(97, 1), glm::ivec2(1, 61), glm::ivec2(161, 91)})
        for (const View& view : {bench_view(size), off_centre_view(size), orthographic_view(size)}) {
            list.push_back({"random", random_gbuffer(view, 5), boxes({.max_distance_m = infinity})});
            list.push_back({"random, 3 m", random_gbuffer(view, 6), boxes({.max_distance_m = 3})});
            list.push_back(
                {"random, offset", random_gbuffer(view, 8), boxes({.max_distance_m = 40, .ray_offset_m = 0.25})});
        }
    list.push_back({"materials", materials(bench_view({161, 91})), boxes({.max_distance_m = infinity})});
    list.push_back({"floor and wall", floor_and_wall(bench_view({161, 91}), 10), boxes({.max_distance_m = 1e9})});
    list.push_back(
        {"floor alone", floor_and_wall(off_centre_view({161, 91}), infinity), boxes({.max_distance_m = infinity})});
    return list;
}

std::string describe(const Case& c)
{
    return fmt::format("{}, {}x{}, {}", c.name, c.image.view.size_px.x, c.image.view.size_px.y,
                       c.image.view.projection == Projection::perspective ? "perspective" : "orthographic");
}

/// Whether wide numbers are doubles, in turn.
class WideNumbers : public testing::TestWithParam<bool> {
protected:
    void SetUp() override
    {
        if (GetParam() && !device().info.float64) GTEST_SKIP() << "the device has no double precision";
        device().info.cheap_doubles = GetParam();
    }
    void TearDown() override { device().info.cheap_doubles = before_; }

private:
    bool before_ = device().info.cheap_doubles;
};
INSTANTIATE_TEST_SUITE_P(Rays, WideNumbers, testing::Values(false, true),
                         [](const auto& doubles) { return doubles.param ? "doubles" : "pairs_of_floats"; });

TEST_P(WideNumbers, AgreeWithDoublePrecision)
{
    for (const Case& c : cases()) {
        const Picture picture = make_picture(c.image);
        const Worst worst = compare(picture, c.settings, make_rays<float>(picture, c.settings, NumberFormat::float32));
        // Float: the nearest numbers there are, half of the last place; with a maximum distance, whose end is set up in float, or an offset some more.
        const bool   rounded = c.settings.ray_offset_m > 0 || c.settings.max_distance_m < 1e9;
        const double last    = 0x1p-24 * (rounded ? 12 : 1.01);
        const double px      = last * std::max(picture.view.size_px.x, picture.view.size_px.y);
        EXPECT_LE(worst.origin_px, c.settings.ray_offset_m > 0 ? px : 0) << describe(c);
        EXPECT_LE(worst.delta_px, px) << describe(c);
        EXPECT_LE(worst.depth, last) << describe(c);
        EXPECT_LE(worst.length, 12 * 0x1p-24) << describe(c);
        EXPECT_EQ(worst.other_end, 0U) << describe(c);
    }
}

TEST(Rays, DoubleTwinIsTheHostsBitForBit)
{
    if (!device().info.float64) GTEST_SKIP() << "the device has no double precision";
    for (const Case& c : cases()) {
        const Picture picture = make_picture(c.image);
        const Worst worst = compare(picture, c.settings, make_rays<double>(picture, c.settings, NumberFormat::float64));
        EXPECT_EQ(worst.origin_px, 0) << describe(c);
        EXPECT_EQ(worst.delta_px, 0) << describe(c);
        EXPECT_EQ(worst.depth, 0) << describe(c);
        EXPECT_EQ(worst.length, 0) << describe(c);
        EXPECT_EQ(worst.other_end, 0U) << describe(c);
    }
}

} // namespace
} // namespace ssrlab::test
