// Which rays a frame traces: several per pixel, or one for a block of pixels.
#include "gpu/passes.h"
#include "truth/screen_ray.h"

namespace ssrlab::test {
namespace {

struct Ray {
    glm::ivec2 pixel;
    glm::dvec3 origin, delta;
};

/// The list that the frame's own passes write.
std::vector<Ray> rays_of(ReadyFrame& frame)
{
    submit(device(),
           [&](const Commands& commands) { record_rays(commands, frame.inputs.trace, *frame.inputs.lab->gbuffer); });
    std::vector<Ray> rays;
    for (const PackedRay<float>& ray : read_list<float>(device(), *frame.inputs.rays))
        rays.push_back({unpack_pixel(ray.pixel), glm::dvec3(ray.origin), glm::dvec3(ray.delta)});
    return rays;
}

View orthographic_view(glm::ivec2 size_px)
{
    View view       = bench_view(size_px);
    view.projection = Projection::orthographic;
    view.focal_px   = glm::dvec2(12);
    view.far_m      = 30;
    return view;
}

size_t count_reflecting(const GBufferImage& image)
{
    size_t count = 0;
    for (const auto [i, x, y] : pixels_of(image.view.size_px)) count += reflects(image, {x, y});
    return count;
}

TEST(SeveralRays, StartOnThePixelsPlaneAndStandTogether)
{
    constexpr size_t per_pixel = 8;
    for (const View& view : {bench_view({161, 91}), orthographic_view({161, 91})}) {
        const Picture picture = make_picture(random_gbuffer(view, 5));
        const auto    frame   = frame_with(picture, {{"rays_per_pixel", per_pixel}, chosen(Gloss::off)});
        const auto    rays    = rays_of(*frame);
        ASSERT_EQ(rays.size(), per_pixel * count_reflecting(picture.image));
        size_t at_centre = 0, directions = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Ray& ray = rays[i];
            ASSERT_EQ(ray.pixel, rays[i / per_pixel * per_pixel].pixel) << i;
            ASSERT_EQ(glm::ivec2(glm::floor(glm::dvec2(ray.origin))), ray.pixel);
            at_centre += glm::dvec2(ray.origin) == glm::dvec2(ray.pixel) + 0.5;
            const glm::dvec3 point = pixel_point_vs(picture.image, ray.pixel);
            const glm::dvec3 start = px_to_vs(view, glm::dvec2(ray.origin), ray.origin.z);
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(picture.image.normal_vs[at(picture.image, ray.pixel.x, ray.pixel.y)]));
            ASSERT_LE(std::abs(glm::dot(normal, start - point)), 2e-5 * glm::length(point));
            ASSERT_GE(start.z, 2 * point.z * 1.0001);
            ASSERT_LE(start.z, 0.5 * point.z * 0.9999);
            // Mirrored about that plane as seen at the start, not at the centre.
            const double end_depth = ray.origin.z + ray.delta.z;
            if (glm::length(glm::dvec2(ray.delta)) < 4 || end_depth < 0.01 * ray.origin.z) continue;
            ++directions;
            const glm::dvec3 end = px_to_vs(view, glm::dvec2(ray.origin + ray.delta), end_depth);
            const glm::dvec3 seen =
                view.projection == Projection::perspective ? glm::normalize(start) : glm::dvec3(0, 0, -1);
            EXPECT_NEAR(glm::dot(glm::normalize(end - start), glm::reflect(seen, normal)), 1, 1e-4);
        }
        EXPECT_LT(at_centre, rays.size() / 20);
        EXPECT_GT(directions, rays.size() / 4);
        // The eight are spread: on average their mean is the centre, and no two pixels share a pattern.
        glm::dvec2                    mean(0);
        std::set<std::pair<int, int>> offsets;
        for (const Ray& ray : rays) {
            const glm::dvec2 offset = glm::dvec2(ray.origin) - glm::dvec2(ray.pixel);
            mean += offset / static_cast<double>(rays.size());
            ASSERT_TRUE(glm::all(glm::greaterThan(offset, glm::dvec2(0)))) << "a border belongs to no pixel alone";
            offsets.insert({static_cast<int>(offset.x * 256), static_cast<int>(offset.y * 256)});
        }
        EXPECT_NEAR(mean.x, 0.5, 0.01);
        EXPECT_NEAR(mean.y, 0.5, 0.01);
        EXPECT_GT(offsets.size(), rays.size() / 3);
    }
}

TEST(SeveralRays, StartAtTheCentreWhereThePlaneIsSeenEdgeOn)
{
    GBufferImage image = metal_wall({32, 32});
    for (glm::vec3& normal : image.normal_vs) normal = glm::normalize(glm::vec3(0, 1, 1e-4));
    const Picture picture = make_picture(image);
    const auto    frame   = frame_with(picture, {{"rays_per_pixel", 4}, chosen(Gloss::off)});
    size_t        centred = 0, edge_on = 0;
    for (const Ray& ray : rays_of(*frame)) {
        // Seen under less than 1/70 of a pixel's angle: beside the middle rows every offset doubles or halves the distance.
        if (std::abs(ray.pixel.y - 15.5) > 1) continue;
        ++edge_on;
        centred += glm::dvec2(ray.origin) == glm::dvec2(ray.pixel) + 0.5;
    }
    EXPECT_EQ(edge_on, 2U * 32 * 4);
    EXPECT_GT(centred, edge_on / 4);
    EXPECT_LT(centred, edge_on);
}

/// Puts a list of rays and their ends in the place of the traced one.
void set_list(ReadyFrame& frame, const std::vector<glm::ivec2>& pixels, const std::vector<glm::ivec2>& hits)
{
    std::vector<PackedRay<float>> listed;
    std::vector<PackedHit<float>> ends;
    for (size_t i = 0; i < pixels.size(); ++i) {
        const bool hit = hits[i].x >= 0;
        ends.push_back({hit ? pack_pixel(hits[i], TRACE_HIT) : pack_pixel({0, 0}, TRACE_LEFT_SCREEN), 0.5F});
        listed.push_back(
            {{glm::vec2(pixels[i]) + 0.5F, 0.02F}, 1, {10, 10, -0.01F}, pack_pixel(pixels[i], TRACE_LEFT_SCREEN)});
    }
    RayBuffers& rays = *frame.inputs.rays;
    set_ray_count(device(), rays, pixels.size());
    upload(device(), rays.list, listed.data(), listed.size() * sizeof(listed[0]));
    upload(device(), rays.hits, ends.data(), ends.size() * sizeof(ends[0]));
}

TEST(SeveralRays, CountWhenMoreThanHalfOfThemHit)
{
    GBufferImage image = metal_wall({16, 16});
    for (int x = 0; x < 16; ++x) image.radiance[at(image, x, 0)] = {static_cast<float>(x), 1, 0};
    constexpr glm::ivec2 miss{-1, -1};
    double               fade_m = 0;
    const auto           hit    = [](int x) { return glm::ivec2(x, 0); };
    const auto           run    = [&](double per_pixel, const std::vector<std::vector<glm::ivec2>>& ends) {
        const Picture           picture = make_picture(image);
        const auto              frame   = frame_with(picture, {{"rays_per_pixel", per_pixel},
                                                               chosen(Gloss::off),
                                                               {"min_direction_cosine", -1},
                                                               {"depth_step_fade_m", fade_m}});
        std::vector<glm::ivec2> pixels, hits;
        for (size_t i = 0; i < ends.size(); ++i)
            for (const glm::ivec2& end : ends[i]) {
                pixels.emplace_back(static_cast<int>(i), 5);
                hits.push_back(end);
            }
        set_list(*frame, pixels, hits);
        run_passes(*frame, {hit_colour_pass()}); // classification would start a list of its own
        const Reflection all = read_colours(picture.buffers->reflection);
        return Reflection(all.begin() + 5 * 16, all.begin() + 5 * 16 + static_cast<ptrdiff_t>(ends.size()));
    };
    const Reflection four = run(4, {{miss, miss, miss, miss},
                                    {hit(3), miss, miss, hit(3)}, // half is not more than half
                                    {hit(3), hit(6), miss, hit(12)},
                                    {hit(1), hit(2), hit(3), hit(2)}});
    EXPECT_EQ(four[0], glm::vec4(0));
    EXPECT_EQ(four[1], glm::vec4(0));
    EXPECT_EQ(four[2], glm::vec4(7, 1, 0, 0.75F));
    EXPECT_EQ(four[3], glm::vec4(2, 1, 0, 1));
    const Reflection two = run(2, {{hit(3), miss}, {hit(3), hit(5)}});
    EXPECT_EQ(two[0], glm::vec4(0));
    EXPECT_EQ(two[1], glm::vec4(4, 1, 0, 1));
    // At a step of 0.5 m a weight of 0.5: colours count by it.
    for (int x = 13; x < 16; ++x) set_pixel(image, x, 0, 5.5, {0, 0, 1}, 1);
    fade_m               = 1;
    const Reflection dim = run(4, {{hit(3), hit(12), hit(12), miss}});
    EXPECT_NEAR(dim[0].r, 7.5, 0.01); // (3 + 12 / 2 + 12 / 2) / (1 + 1 / 2 + 1 / 2)
    EXPECT_NEAR(dim[0].a, 0.5, 1e-3);
    fade_m               = 0;
    const Reflection one = run(1, {{hit(9)}, {miss}});
    EXPECT_EQ(one[0], glm::vec4(9, 1, 0, 1));
    EXPECT_EQ(one[1], glm::vec4(0));
}

// Pixel 3 of row 0 is 1 m nearer than all about it, pixel 10 half a metre: with a fade over 2 m its reflection weighs 1/2, that one's 3/4, and one of
// pixel 6 weighs 1. Rays drawn from lobes are averaged by another line.
TEST(SeveralRays, CountByTheirWeights)
{
    GBufferImage image = metal_wall({16, 16});
    for (int x = 0; x < 16; ++x) image.radiance[at(image, x, 0)] = {static_cast<float>(x), 1, 0};
    image.roughness.assign(image.roughness.size(), 0.4F);
    set_pixel(image, 3, 0, 4, {0, 0, 1}, 1);
    set_pixel(image, 10, 0, 4.5, {0, 0, 1}, 1);
    const Picture picture = make_picture(image);
    for (const Gloss gloss : {Gloss::off, Gloss::stochastic}) {
        const auto frame = frame_with(
            picture, {{"rays_per_pixel", 4}, chosen(gloss), {"min_direction_cosine", -1}, {"depth_step_fade_m", 2}});
        const glm::ivec2 pixel{5, 5};
        set_list(*frame, {pixel, pixel, pixel, pixel}, {{3, 0}, {6, 0}, {-1, -1}, {10, 0}});
        run_passes(*frame, {hit_colour_pass()});
        const glm::vec4 mean    = read_colours(picture.buffers->reflection)[at(image, pixel.x, pixel.y)];
        const float     weights = 0.5F + 1 + 0.75F;
        EXPECT_NEAR(mean.r, (0.5F * 3 + 1.0F * 6 + 0.75F * 10) / weights, 1e-2);
        EXPECT_NEAR(mean.g, 1, 1e-3);
        EXPECT_NEAR(mean.a, weights / 4, 1e-3);
    }
}

// A half vector lies on a cap of the sphere that is as high as the first random number; inverse of J. Dupuy, A. Benyoub 2023, "Sampling Visible
// GGX Normals with Spherical Caps". A narrow lobe's cap is cut at the share of its half width, in pixels, of 11.
TEST(RoughPixels, DrawRaysFromTheInnerPartOfNarrowLobes)
{
    size_t cut = 0;
    for (const float roughness : {0.1F, 0.2F, 0.3F, 0.6F}) {
        GBufferImage image = metal_wall({64, 64});
        image.roughness.assign(image.roughness.size(), roughness);
        const Picture picture = make_picture(image);
        const auto    frame   = frame_with(picture, {chosen(Gloss::stochastic)});
        const double  alpha   = double(roughness) * double(roughness);
        const double  share   = std::min(1.3 * alpha * image.view.focal_px.y / 11, 1.0);
        cut += share < 1;
        double widest = 0;
        for (const Ray& ray : rays_of(*frame)) {
            const glm::dvec3 end       = ray.origin + ray.delta;
            const glm::dvec3 start_vs  = px_to_vs(image.view, glm::dvec2(ray.origin), ray.origin.z);
            const glm::dvec3 to_eye    = -glm::normalize(start_vs);
            const glm::dvec3 to_light  = glm::normalize(px_to_vs(image.view, glm::dvec2(end), end.z) - start_vs);
            const glm::dvec3 half      = to_eye + to_light; // the wall's normal is z
            const glm::dvec3 facet     = glm::normalize(glm::dvec3(glm::dvec2(half) / alpha, half.z));
            const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * glm::dvec2(to_eye), to_eye.z));
            const glm::dvec3 on_cap    = 2 * glm::dot(facet, stretched) * facet - stretched;
            const double     height    = (1 - on_cap.z) / (1 + stretched.z);
            ASSERT_LE(height, share + 1e-3) << roughness << ", pixel " << ray.pixel.x << ", " << ray.pixel.y;
            widest = std::max(widest, height);
        }
        EXPECT_GT(widest, 0.9 * share) << roughness;
    }
    EXPECT_EQ(cut, 3U);
}

/// A third of the pixels reflect, at random.
GBufferImage speckled(glm::ivec2 size_px)
{
    GBufferImage image = random_gbuffer(bench_view(size_px), 9);
    std::mt19937 random(4);
    for (float& metallic : image.metallic) metallic = random() % 3 == 0 ? 1.0F : 0.0F;
    return image;
}

TEST(Blocks, AreTracedFromTheirFirstReflectingPixel)
{
    const Picture picture = make_picture(speckled({61, 35}));
    // From the centre outward, row by row: written down by hand.
    const std::vector<glm::ivec2> order_2 = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    const std::vector<glm::ivec2> order_4 = {{1, 1}, {2, 1}, {1, 2}, {2, 2}, {1, 0}, {2, 0}, {0, 1}, {3, 1},
                                             {0, 2}, {3, 2}, {1, 3}, {2, 3}, {0, 0}, {3, 0}, {0, 3}, {3, 3}};
    for (const int block_px : {2, 4}) {
        std::set<std::pair<int, int>> expected, found;
        for (int y = 0; y < 35; y += block_px)
            for (int x = 0; x < 61; x += block_px)
                for (const glm::ivec2& step : block_px == 2 ? order_2 : order_4) {
                    const glm::ivec2 pixel = glm::ivec2(x, y) + step;
                    if (pixel.x >= 61 || pixel.y >= 35 || !reflects(picture.image, pixel)) continue;
                    expected.insert({pixel.x, pixel.y});
                    break;
                }
        const auto frame =
            frame_with(picture, {chosen(block_px == 2 ? TraceResolution::half : TraceResolution::quarter)});
        const auto rays = rays_of(*frame);
        for (const Ray& ray : rays) found.insert({ray.pixel.x, ray.pixel.y});
        EXPECT_EQ(found, expected);
        EXPECT_EQ(rays.size(), expected.size());
        EXPECT_GT(expected.size(), 50U);
        // The pass that needs it finds it.
        run_frame(device(), *frame);
        const auto                    blocks = download_as<uint32_t>(device(), picture.buffers->block_pixel);
        std::set<std::pair<int, int>> named;
        for (const uint32_t block : blocks)
            if (block != NO_PIXEL) named.insert({unpack_pixel(block).x, unpack_pixel(block).y});
        EXPECT_EQ(named, expected);
    }
}

class Skipping : public testing::TestWithParam<ParameterValues> {};

// What is not needed changes nothing when it runs anyway; what is counted does not depend on the passes.
TEST_P(Skipping, LeavesEveryBit)
{
    const Picture   picture     = make_picture("builtin:sphere_over_mirror", "default", {161, 91});
    ParameterValues all         = GetParam();
    all["skip_unneeded_passes"] = 0;
    const auto planned = frame_with(picture, GetParam(), "hiz"), unculled = frame_with(picture, all, "hiz");
    run_frame(device(), *planned);
    const Image expected = read_shaded(device(), *planned);
    run_frame(device(), *unculled);
    EXPECT_EQ(read_shaded(device(), *unculled).values, expected.values);
    const auto  plain = frame_with(picture, {}, "hiz");
    std::string first;
    EXPECT_EQ(count_differences(counted(*planned), counted(*plain), bit_equal_t, first), 0U) << first;
}

INSTANTIATE_TEST_SUITE_P(
    Passes, Skipping,
    testing::Values(ParameterValues{}, ParameterValues{{"rays_per_pixel", 4}},
                    ParameterValues{chosen(TraceResolution::half)},
                    ParameterValues{chosen(TraceResolution::quarter), {"rays_per_pixel", 2}, chosen(Filter3x3::box3)},
                    ParameterValues{chosen(Filter3x3::median3)}));

} // namespace
} // namespace ssrlab::test
