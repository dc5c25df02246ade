// Blur by roughness, the environment, the directional albedo, and hits lit as their reflector sees them.
#include "gpu/passes.h"
#include "scene/prefiltered_environment.h"
#include "scene/scene.h"
#include "truth/screen_ray.h"

namespace ssrlab::test {
namespace {

constexpr glm::vec4 hole{0, 0, 0, 0};

/// A metal wall of 64 x 64 pixels with the given roughness.
Picture rough_wall(float roughness)
{
    GBufferImage image = metal_wall({64, 64});
    std::ranges::fill(image.roughness, roughness);
    return make_picture(image);
}

Reflection blur(const Picture& picture, const Reflection& reflection, const ParameterValues& passes)
{
    const auto frame = frame_with(picture, passes);
    set_reflection(picture, reflection);
    run_pass(*frame, blur_pass());
    return read_colours(picture.buffers->reflection);
}

TEST(Blur, SpreadsALineByTheGaussianOfItsRoughness)
{
    const Picture picture = rough_wall(0.5F);
    Reflection    line(64 * 64, {0, 0, 0, 1});
    for (int y = 0; y < 64; ++y) line[at(picture.image, 32, y)] = {1, 1, 1, 1};
    // These shares of the height times roughness 0.5: 8 and 28 pixels, two standard deviations.
    for (const int radius : {8, 28}) {
        const Reflection found = blur(picture, line, {{"blur_scale", radius / 32.0}});
        const auto       gauss = [&](int d) { return std::exp(-2.0 * d * d / (radius * radius)); };
        double           sum   = 0;
        for (int d = -radius; d <= radius; ++d) sum += gauss(d);
        for (int x = 0; x < 64; ++x) {
            const int d = x - 32;
            EXPECT_NEAR(found[at(picture.image, x, 30)].r, std::abs(d) <= radius ? gauss(d) / sum : 0, 1e-3)
                << "column " << x << ", radius " << radius;
        }
    }
}

// A radius of 8.4 pixels has nine taps a side, 8.4 / 9 of a pixel apart; each is read at the nearest pixel.
TEST(Blur, ReadsTheNearestPixels)
{
    GBufferImage image = metal_wall({128, 64}); // 64 pixels high: radii are shares of that
    std::ranges::fill(image.roughness, 0.5F);
    const Picture picture = make_picture(image);
    Reflection    line(128 * 64, {0, 0, 0, 1});
    for (int y = 0; y < 64; ++y) line[at(image, 64, y)] = {1, 1, 1, 1};
    const Reflection       found = blur(picture, line, {{"blur_scale", 12.4 / 32}, {"blur_bias", -4.0 / 64}});
    std::map<long, double> at_offset{{0, 1}};
    double                 sum = 1;
    for (int i = 1; i <= 9; ++i) {
        const double weight = std::exp(-2.0 * i * i / 81);
        at_offset[std::lround(i * 8.4 / 9)] += weight;
        sum += 2 * weight;
    }
    for (int d = 0; d <= 10; ++d)
        EXPECT_NEAR(found[at(image, 64 + d, 30)].r, at_offset.contains(d) ? at_offset[d] / sum : 0, 1e-3) << d;
}

// Less than half a step reaches no neighbour, and there is no radius below 0; 0.7 steps are one tap a side, at the next pixel and two deviations away.
TEST(Blur, BeginsAtHalfAStep)
{
    const Picture picture = rough_wall(0.5F);
    Reflection    line(64 * 64, {0, 0, 0, 1});
    for (int y = 0; y < 64; ++y) line[at(picture.image, 32, y)] = {1, 1, 1, 1};
    const auto with_radius = [&](double radius_px) {
        return blur(picture, line, {{"blur_scale", 1.0 / 32}, {"blur_bias", (radius_px - 1) / 64}});
    };
    EXPECT_EQ(with_radius(0.49), line);
    EXPECT_EQ(with_radius(-8), line);
    const Reflection found  = with_radius(0.7);
    const double     beside = std::exp(-2) / (1 + 2 * std::exp(-2));
    EXPECT_NEAR(found[at(picture.image, 31, 30)].r, beside, 1e-3);
    EXPECT_NEAR(found[at(picture.image, 32, 30)].r, 1 - 2 * beside, 1e-3);
    EXPECT_EQ(found[at(picture.image, 34, 30)].r, 0);
}

// At half resolution, before up-sampling: a step is a block, the radius is half as many steps, and beyond the border stands its last block. Of
// 65 x 63 pixels the blocks at the border are cut.
TEST(Blur, OfBlocksIsTheGaussianOfHalfAsManySteps)
{
    for (const glm::ivec2& size_px : {glm::ivec2(64, 64), glm::ivec2(65, 63)}) {
        GBufferImage image = metal_wall(size_px);
        std::ranges::fill(image.roughness, 0.5F);
        const Picture    picture = make_picture(image);
        const auto       frame   = frame_with(picture, {chosen(Gloss::blur),
                                                        chosen(TraceResolution::half),
                                                        chosen(BlurOrder::before_upsampling),
                                                        {"blur_scale", 0.375}});
        const glm::ivec2 blocks  = (size_px + 1) / 2;
        run_frame(device(), *frame); // says which pixels blocks are traced from
        const auto traced = download_as<uint32_t>(device(), picture.buffers->block_pixel);
        const auto source = [&](int x, int y) {
            return glm::dvec3(x % 8 == 7, y % 8 == 1, (x + 2 * y) % 16) / glm::dvec3(1, 1, 16);
        };
        Reflection reflection(image.depth.size(), nothing_reflects);
        for (const auto [i, x, y] : pixels_of(blocks)) {
            const glm::ivec2 pixel = unpack_pixel(traced[i]);
            ASSERT_EQ(pixel / 2, glm::ivec2(x, y));
            reflection[at(image, pixel.x, pixel.y)] = glm::vec4(source(x, y), 1);
        }
        set_reflection(picture, reflection);
        run_pass(*frame, ray_blur_pass());
        const Reflection found  = read_colours(picture.buffers->reflection);
        const double     radius = 0.375 * 0.5 * size_px.y / 2;
        const int        taps   = int(std::ceil(radius));
        for (const auto [i, x, y] : pixels_of(blocks)) {
            glm::dvec3 sum(0);
            double     total = 0;
            for (int v = -taps; v <= taps; ++v)
                for (int u = -taps; u <= taps; ++u) {
                    const auto   steps  = [&](int tap) { return int(std::round(tap * radius / taps)); };
                    const double weight = std::exp(-2.0 * (u * u + v * v) / (taps * taps));
                    sum += weight *
                           source(std::clamp(x + steps(u), 0, blocks.x - 1), std::clamp(y + steps(v), 0, blocks.y - 1));
                    total += weight;
                }
            const glm::ivec2 pixel = unpack_pixel(traced[i]);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(found[at(image, pixel.x, pixel.y)][c], sum[c] / total, 3e-3) << x << ", " << y;
        }
    }
}

TEST(Blur, LeavesSmoothPixelsToTheLastBit)
{
    GBufferImage image = metal_wall({64, 64});
    for (int y = 0; y < 64; ++y)
        for (int x = 32; x < 64; ++x) image.roughness[at(image, x, y)] = 0.8F;
    const Picture picture = make_picture(image);
    Reflection    noise;
    for (int i = 0; i < 64 * 64; ++i)
        noise.emplace_back(static_cast<float>(i * 7919 % 256) / 256, static_cast<float>(i * 104729 % 64) / 64, 0.5F, 1);
    EXPECT_GT(changes_on_the_right_alone(blur(picture, noise, {}), noise), 1800U);
}

// Push and pull: the hole takes its neighbours' colour, and a weight below theirs.
TEST(Blur, HolesTakeTheColourAboutThemAndStayLessTrusted)
{
    const Picture picture = rough_wall(0.5F);
    Reflection    wall(64 * 64, {0.25F, 0.5F, 1, 1});
    wall[at(picture.image, 32, 32)] = hole;
    // 2 pixels; 4 for the hole.
    const ParameterValues passes{{"blur_scale", 0.0625}, {"hole_blur_scale", 2}, {"blur_hole_weight", 0.25}};
    const Reflection      found = blur(picture, wall, passes);
    const auto            gauss = [](double i, double radius) { return std::exp(-2 * i * i / (radius * radius)); };
    const double          far   = 2 * (gauss(1, 4) + gauss(2, 4) + gauss(3, 4) + gauss(4, 4)),
                 sum            = 1 + 2 * gauss(1, 2) + 2 * gauss(2, 2);
    // Along x the hole has no part but in the whole, by a quarter of its weight; along y its row meets four whole ones.
    const double in_row = far / (far + 0.25), beside_in_row = (sum - gauss(1, 2)) / (sum - 0.75 * gauss(1, 2));
    EXPECT_NEAR(found[at(picture.image, 32, 32)].a, (in_row + sum - 1) / sum, 1e-3);
    EXPECT_NEAR(found[at(picture.image, 33, 32)].a, (beside_in_row + sum - 1) / sum, 1e-3);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[at(picture.image, 32, 32)][c], wall[0][c], 2e-3);
    for (const int x : {32, 33}) {
        EXPECT_LT(found[at(picture.image, x, 32)].a, 1);
        EXPECT_GT(found[at(picture.image, x, 32)].a, 0.9F);
    }
    EXPECT_EQ(found[at(picture.image, 10, 10)], wall[0]);
}

TEST(Blur, NothingComesFromPixelsThatDoNotReflect)
{
    const Picture picture = rough_wall(1);
    Reflection    halves(64 * 64, nothing_reflects);
    for (const auto [i, x, y] : pixels_of({32, 64})) halves[at(picture.image, x, y)] = {0.5F, 0.5F, 0.5F, 1};
    const Reflection found = blur(picture, halves, {});
    for (size_t i = 0; i < found.size(); ++i)
        for (int c = 0; c < 4; ++c) ASSERT_NEAR(found[i][c], halves[i][c], 1e-3) << i;
}

/// Bilinear in one of the levels, which lie one below the other.
glm::vec3 level_radiance(const EnvironmentMap& levels, glm::dvec3 direction, int level)
{
    const int        width = levels.size_px.x, height = width / 2;
    const glm::dvec2 at_px = direction_to_uv(direction) * glm::dvec2(width, height) - 0.5, low = glm::floor(at_px);
    const glm::vec2  part(at_px - low);
    const auto       texel = [&](int dx, int dy) {
        const int x = (int(low.x) + dx + width) % width, y = std::clamp(int(low.y) + dy, 0, height - 1);
        return levels.radiance[pixel_index({x, level * height + y}, levels.size_px)];
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x), glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
}

/// Between the two levels about a roughness, the sharper one the map itself if need be; in the lobe's direction (S. Lagarde, C. de Rousiers 2014).
glm::vec3 blurred_sky(const Scene& scene, const EnvironmentMap& levels, glm::dvec3 mirror, glm::dvec3 normal,
                      double roughness)
{
    const double     alpha = roughness * roughness, to_mirror = (1 - alpha) * (std::sqrt(1 - alpha) + alpha);
    const glm::dvec3 direction = glm::mix(normal, mirror, to_mirror);
    int              blurrier  = 0;
    while (blurrier + 1 < environment_levels && environment_level_roughness(blurrier) < roughness) ++blurrier;
    const double    level = environment_levels * std::pow(roughness, 2.0 / 3) - 1;
    const glm::vec3 sharper =
        blurrier == 0 ? sky_radiance(scene, direction) : level_radiance(levels, direction, blurrier - 1);
    return glm::mix(sharper, level_radiance(levels, direction, blurrier), float(level - (blurrier - 1)));
}

// A mirror reflects the map itself; what is rough, its mean over the lobe: between the levels on either side of its roughness.
void expect_blended_sky(Projection projection, bool behind)
{
    Scene scene = load_scene("builtin:everything");
    // Brighter on one side, so that it shows where the map's ends meet: along +z, where rays go that are reflected under an eye behind the scene.
    for (size_t i = 0; i < scene.environment.radiance.size(); ++i)
        if (pixel_at(i, scene.environment.size_px).x < scene.environment.size_px.x / 2)
            scene.environment.radiance[i] += 2.0F;
    Camera camera     = find_camera(scene, "default");
    camera.projection = projection;
    if (behind)
        camera.position_ws = {2 * camera.target_ws.x - camera.position_ws.x, camera.position_ws.y,
                              2 * camera.target_ws.z - camera.position_ws.z};
    camera.height_m       = 4;
    const Picture picture = make_picture(scene, camera, {161, 91});
    const auto    frame   = frame_with(picture, {chosen(Gloss::off)});
    Reflection    before(picture.image.depth.size(), nothing_reflects);
    for (size_t i = 0; i < before.size(); ++i)
        if (picture.image.metallic[i] > 0) before[i] = {2, 1, 0.5F, static_cast<float>(i % 3) / 2};
    // Some normals show away from the eye: what they are of is seen all the same.
    auto normals = download_as<glm::vec4>(device(), picture.gbuffer->normal);
    for (size_t i = 0; i < normals.size(); i += 5) normals[i] *= glm::vec4(-1, -1, -1, 1);
    upload(device(), picture.gbuffer->normal, normals.data(), normals.size() * sizeof(glm::vec4));
    set_reflection(picture, before);
    run_pass(*frame, environment_pass());
    const Reflection     after         = read_colours(picture.buffers->reflection);
    const glm::dmat3     view_to_world = glm::transpose(glm::dmat3(picture.view.world_to_view));
    const EnvironmentMap levels        = prefilter_environment(scene.environment);
    size_t               sharp = 0, rough = 0;
    for (size_t i = 0; i < before.size(); ++i) {
        if (before[i].a < 0 || before[i].a == 1) {
            ASSERT_EQ(after[i], before[i]) << i;
            continue;
        }
        ASSERT_EQ(after[i].a, 1);
        const glm::ivec2 pixel(static_cast<int>(i) % 161, static_cast<int>(i) / 161);
        const auto       roughness = static_cast<double>(picture.image.roughness[i]);
        const glm::dvec3 mirror    = view_to_world * mirror_direction_vs(picture.image, pixel),
                         normal    = view_to_world * glm::dvec3(picture.image.normal_vs[i]);
        rough += roughness > 0;
        sharp += roughness == 0;
        const glm::vec3 sky =
            roughness > 0 ? blurred_sky(scene, levels, mirror, normal, roughness) : sky_radiance(scene, mirror);
        const glm::vec3 expected = sky + (glm::vec3(before[i]) - sky) * before[i].a;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(after[i][c], expected[c], 0.01F * expected[c] + 0.01F) << i;
    }
    EXPECT_GT(sharp, 100U);
    EXPECT_GT(rough, 500U);
}

TEST(EnvironmentFallback, IsTheSkyInTheMirrorDirectionBlendedByTheWeight)
{
    for (const bool behind : {false, true}) {
        expect_blended_sky(Projection::perspective, behind);
        expect_blended_sky(Projection::orthographic, behind);
    }
}

// A drawn ray stands for its share of the lobe: the sky, blurred by 0.7 of the roughness about the ray itself, takes what the ray's weight leaves. Rays that
// found nothing end a million metres away.
TEST(EnvironmentFallback, TakesWhatDrawnRaysLeave)
{
    Scene scene = load_scene("builtin:everything");
    for (Material& material : scene.materials) // mirrors have no lobe, even where they are not ideal
        if (material.roughness == 0) material.roughness = 0.0195F;
    const Picture picture = make_picture(scene, find_camera(scene, "default"), {161, 91});
    const auto    frame   = frame_with(picture, {chosen(Gloss::stochastic),
                                                 chosen(ViewerFade::off),
                                                 chosen(EdgeFade::manhattan),
                                                 chosen(HitShading::diffuse),
                                                 chosen(BounceMode::off),
                                                 {"rays_per_pixel", 2}});
    run_frame(device(), *frame);
    const auto           rays          = read_list<float>(device(), *frame->inputs.rays);
    const auto           hits          = download_as<PackedHit<float>>(device(), frame->inputs.rays->hits, rays.size());
    const Reflection     light         = read_colours(picture.buffers->lobe_rays.at(2)->light);
    const auto           end           = download_as<glm::vec4>(device(), picture.buffers->lobe_rays.at(2)->end);
    const glm::dmat3     view_to_world = glm::transpose(glm::dmat3(picture.view.world_to_view));
    const EnvironmentMap levels        = prefilter_environment(scene.environment);
    size_t               missed = 0, mixed = 0, mirrors = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const glm::ivec2 pixel     = unpack_pixel(rays[i].pixel);
        const double     roughness = picture.image.roughness[at(picture.image, pixel.x, pixel.y)];
        const bool       hit       = unpack_status(hits[i].pixel) == TraceStatus::hit;
        const glm::dvec3 origin(rays[i].origin), delta(rays[i].delta), point = origin + delta * double(hits[i].t);
        const auto       point_vs = [&](glm::dvec3 px_depth) {
            return px_to_vs(picture.view, glm::dvec2(px_depth), px_depth.z);
        };
        // Depth is linear along the ray on screen: halfway is before every end, and not at infinity.
        const glm::dvec3 direction = glm::normalize(point_vs(origin + 0.5 * delta) - point_vs(origin));
        const glm::dvec2 offset    = glm::dvec2(point) / glm::dvec2(161, 91) - 0.5;
        const double     weight    = hit ? std::clamp(1 - std::abs(offset.x) - std::abs(offset.y), 0.0, 1.0) : 0;
        const glm::ivec2 met       = unpack_pixel(hits[i].pixel);
        const glm::vec3  surface   = picture.image.radiance[at(picture.image, met.x, met.y)],
                        sky_ws     = glm::vec3(view_to_world * direction);
        const glm::vec3 sky        = roughness > 0
                                         ? blurred_sky(scene, levels, glm::dvec3(sky_ws), glm::dvec3(sky_ws), 0.7 * roughness)
                                         : sky_radiance(scene, glm::dvec3(sky_ws));
        const size_t    texel      = at(picture.image, pixel.x, pixel.y) + (i % 2) * size_t(161 * 91);
        ASSERT_EQ(light[texel].a, 1) << i;
        for (int c = 0; c < 3; ++c) {
            const float expected = glm::mix(sky[c], surface[c], float(weight));
            ASSERT_NEAR(light[texel][c], expected, 0.01F * expected + 0.01F) << i;
        }
        missed += !hit;
        mixed += hit && weight < 0.9;
        mirrors += roughness < 0.02;
        ASSERT_EQ(end[texel].w > 0, roughness >= 0.02) << i;
        const glm::dvec3 expected_end = hit ? point_vs(point) : point_vs(origin) + 1e6 * direction;
        ASSERT_LT(glm::distance(glm::dvec3(end[texel]), expected_end), 1e-3 * glm::length(expected_end)) << i;
    }
    EXPECT_GT(missed, 300U);
    EXPECT_GT(mixed, 300U);
    EXPECT_GT(mirrors, 300U);
}

// A wall that faces the camera, in a sky that is 1 + y: its mean over a lobe about the direction d is 1 + c d.y, c the lobe's mean cosine.
TEST(EnvironmentFallback, IsBlurredByTheLobeOfTheRoughness)
{
    constexpr double pi       = std::numbers::pi;
    Scene            scene    = load_scene("builtin:stairs");
    scene.environment.size_px = {256, 128};
    scene.environment.radiance.clear();
    for (const auto [i, x, y] : pixels_of({256, 128}))
        scene.environment.radiance.emplace_back(1 + std::sin(pi * (0.5 - (y + 0.5) / 128)));
    const EnvironmentMap levels = prefilter_environment(scene.environment);
    for (int k = 0; k < environment_levels; ++k) {
        const double alpha2 = std::pow(environment_level_roughness(k), 4);
        double       sum = 0, weights = 0;
        for (int i = 0; i < 20000; ++i) {
            const double angle = 0.5 * pi * (i + 0.5) / 20000, cosine = std::cos(angle);
            const double spread = std::pow(std::cos(0.5 * angle), 2) * (alpha2 - 1) + 1;
            // D G2 sin / 4: n = v, so Lambda(v) = 0.
            const double weight = alpha2 / (spread * spread) * std::sin(angle) * 2 /
                                  (1 + std::sqrt(1 + alpha2 * (1 / (cosine * cosine) - 1)));
            sum += weight * cosine;
            weights += weight;
        }
        for (const int y : {20, 64, 100})
            EXPECT_NEAR(double(levels.radiance[size_t(k * 128 + y) * 256 + 77].g),
                        1 + sum / weights * std::sin(pi * (0.5 - (y + 0.5) / 128)), 0.02)
                << "level " << k << ", row " << y;
    }
}

/// The directional albedo of a GGX surface, by quadrature over its half vectors (B. Karis 2013, Real Shading in Unreal Engine 4).
double directional_albedo(double f0, double roughness, double cosine)
{
    const double     alpha = roughness * roughness;
    const glm::dvec3 v(std::sqrt(1 - cosine * cosine), 0, cosine);
    double           sum = 0;
    constexpr int    n   = 512;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double     u = (i + 0.5) / n, phi = 2 * std::numbers::pi * (j + 0.5) / n;
            const double     z = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)), s = std::sqrt(1 - z * z);
            const glm::dvec3 h(s * std::cos(phi), s * std::sin(phi), z), l             = 2 * glm::dot(v, h) * h - v;
            if (l.z <= 0) continue;
            const auto   lambda = [&](double c) { return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c); };
            const double v_h = std::max(glm::dot(v, h), 0.0), fresnel = f0 + (1 - f0) * std::pow(1 - v_h, 5);
            const double visibility = 0.5 / (l.z * lambda(cosine) + cosine * lambda(l.z));
            sum += fresnel * visibility * 4 * l.z * v_h / z;
        }
    return sum / (n * n);
}

// A quarter is metal of that base colour, the rest reflects half at normal incidence. Normals may point away from the eye.
TEST(Composite, GgxReflectsItsDirectionalAlbedo)
{
    for (const float roughness : {0.1F, 0.4F, 0.8F, 1.0F})
        for (const float base : {0.2F, 1.0F}) {
            GBufferImage image = metal_wall({64, 64});
            for (int x = 0; x < 64; ++x) image.normal_vs[at(image, x, 32)] = glm::normalize(glm::vec3(64 - x, 0, 4));
            for (int x = 0; x < 64; x += 8) image.normal_vs[at(image, x, 32)] *= -1.0F;
            std::ranges::fill(image.metallic, 0.25F);
            std::ranges::fill(image.dielectric_f0, 0.5F);
            std::ranges::fill(image.roughness, roughness);
            std::ranges::fill(image.base_colour, glm::vec3(base));
            const Picture picture = make_picture(image);
            const auto    frame   = frame_with(picture, {chosen(Reflectance::ggx)});
            set_reflection(picture, Reflection(64 * 64, glm::vec4(1)));
            run_pass(*frame, composite_pass());
            const Reflection found = read_colours(picture.buffers->shaded);
            for (const int x : {2, 16, 24, 28, 30}) {
                const glm::dvec3 to_eye = -glm::normalize(glm::dvec3((x + 0.5 - 32) / 32, -0.5 / 32, -1));
                const double     cosine =
                    std::abs(glm::dot(to_eye, glm::dvec3(picture.image.normal_vs[at(picture.image, x, 32)])));
                const double f0 = 0.25 * static_cast<double>(base) + 0.75 * 0.5;
                EXPECT_NEAR(found[at(picture.image, x, 32)].r,
                            directional_albedo(f0, static_cast<double>(roughness), cosine), 0.01)
                    << "roughness " << roughness << ", base " << base << ", cosine " << cosine;
            }
        }
}

/// GGX with height-correlated Smith visibility and Schlick's Fresnel factor, times the light's irradiance. At least so rough.
glm::dvec3 highlight(const Light& light, const GBufferImage& image, size_t i, glm::dvec3 to_eye_ws,
                     glm::dvec3 normal_ws, float least_roughness)
{
    const glm::dvec3 to_light = -glm::normalize(glm::dvec3(light.direction_ws)),
                     half     = glm::normalize(to_eye_ws + to_light);
    const double n_l = glm::dot(normal_ws, to_light), n_v = std::max(glm::dot(normal_ws, to_eye_ws), 1e-4);
    if (n_l <= 0) return {0, 0, 0};
    const double n_h = std::max(glm::dot(normal_ws, half), 0.0), v_h = std::max(glm::dot(to_eye_ws, half), 0.0);
    const float  roughness = std::max(image.roughness[i], least_roughness);
    const double alpha2    = std::pow(std::max(static_cast<double>(roughness), 0.05), 4.0);
    const double d         = n_h * n_h * (alpha2 - 1) + 1;
    const double smith =
        0.5 / (n_l * std::sqrt(n_v * n_v * (1 - alpha2) + alpha2) + n_v * std::sqrt(n_l * n_l * (1 - alpha2) + alpha2));
    const glm::dvec3 f0 =
        glm::mix(glm::dvec3(0.04), glm::dvec3(image.base_colour[i]), static_cast<double>(image.metallic[i]));
    return glm::dvec3(light.intensity) * n_l * (alpha2 / (std::numbers::pi * d * d) * smith) *
           (f0 + (1.0 - f0) * std::pow(1 - v_h, 5.0));
}

TEST(HitColour, MirroredLightIsTheHighlightThatTheReflectorSees)
{
    Scene scene = load_scene("builtin:stairs");
    for (Light& light : scene.lights) light.casts_shadow = false;
    // Reflectors rougher than what they show.
    for (Material& material : scene.materials)
        if (material.metallic > 0) material.roughness = 0.9F;
    const Picture    picture = make_picture(scene, find_camera(scene, "default"), {161, 91});
    const auto       frame   = frame_with(picture, {chosen(HitShading::mirrored), chosen(ViewerFade::off),
                                                    chosen(EdgeFade::off), chosen(PassSet::shading)});
    const TraceImage traced  = counted(*frame);
    run_frame(device(), *frame);
    const Reflection found         = read_colours(picture.buffers->reflection);
    const glm::dmat3 view_to_world = glm::transpose(glm::dmat3(picture.view.world_to_view));
    size_t           hits = 0, lit = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        if (traced.status[i] != TraceStatus::hit) continue;
        const glm::ivec2 pixel(static_cast<int>(i) % 161, static_cast<int>(i) / 161), hit = traced.hit_pixel[i];
        const size_t     at_hit    = at(picture.image, hit.x, hit.y);
        const glm::dvec3 direction = view_to_world * glm::normalize(mirror_direction_vs(picture.image, pixel));
        glm::dvec3       expected(picture.image.radiance[at_hit]);
        for (const Light& light : scene.lights)
            expected +=
                highlight(light, picture.image, at_hit, -direction,
                          view_to_world * glm::dvec3(picture.image.normal_vs[at_hit]), picture.image.roughness[i]);
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(static_cast<double>(found[i][c]), expected[c], 0.01 * expected[c] + 2e-3) << i;
        ++hits;
        lit += glm::length(expected - glm::dvec3(picture.image.radiance[at_hit])) > 1e-3;
    }
    EXPECT_GT(hits, 500U);
    EXPECT_GT(lit, 100U);
}

} // namespace
} // namespace ssrlab::test
