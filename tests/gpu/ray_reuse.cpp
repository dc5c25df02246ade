// The reuse of neighbours' rays and the filters behind it, pixel by pixel against the same sums on the host.
#include "core/pixel_index.h"
#include "gpu/passes.h"

#include <glm/gtc/packing.hpp>

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{64, 64};
constexpr int        rays_per_pixel  = 2;
constexpr double     depth_tolerance = 0.02, mirror_roughness = 0.02;

/// What the passes read. light, end: ray after ray, an image high.
struct Rays {
    std::vector<glm::vec4> light, end;
};

/// Two walls, 5 and 5.2 m away, that are not quite even; normals lean and some face away; a tenth reflects nothing, a tenth is a mirror.
GBufferImage uneven_walls(std::mt19937& random)
{
    std::uniform_real_distribution<double> unit(-1, 1);
    GBufferImage                           image = metal_wall(size_px);
    for (const auto [i, x, y] : pixels_of(size_px)) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3(0.1 * unit(random), 0.1 * unit(random), 1));
        set_pixel(image, x, y, (x + y < 64 ? 5 : 5.2) + 0.05 * unit(random), random() % 8 == 0 ? -normal : normal,
                  random() % 10 == 0 ? 0 : 1);
        image.roughness[i] = random() % 10 == 0 ? 0.0195F : static_cast<float>(0.5 + 0.3 * unit(random));
    }
    return image;
}

Rays random_rays(std::mt19937& random)
{
    std::uniform_real_distribution<float> unit(0, 1);
    Rays                                  rays;
    for (size_t i = 0; i < rays_per_pixel * pixel_count(size_px); ++i) {
        const float     bright = random() % 16 == 0 ? 20 : 1, weight = static_cast<float>(random() % 3) / 2;
        const glm::vec4 light(bright * unit(random), bright * unit(random), bright * unit(random),
                              random() % 16 == 0 ? -1 : weight);
        rays.light.push_back(glm::unpackHalf4x16(glm::packHalf4x16(light)));
        // Few lie behind the walls.
        const glm::vec3 point(8 * unit(random) - 4, 8 * unit(random) - 4, -5.5F + 5 * unit(random));
        rays.end.emplace_back(point, random() % 16 == 0 ? 0 : 0.02F + 3 * unit(random) * unit(random));
    }
    return rays;
}

uint32_t pcg(uint32_t value)
{
    const uint32_t state = value * 747796405U + 2891336453U,
                   word  = ((state >> ((state >> 28) + 4)) ^ state) * 277803737U;
    return (word >> 22) ^ word;
}

struct Reflector {
    glm::dvec3 position_vs, normal_vs, to_eye_vs;
    double     roughness;
};

Reflector reflector_at(const GBufferImage& image, glm::ivec2 pixel)
{
    const size_t i = pixel_index(pixel, size_px);
    Reflector    own{px_to_vs(image.view, glm::dvec2(pixel) + 0.5, static_cast<double>(image.depth[i])),
                  glm::normalize(glm::dvec3(image.normal_vs[i])),
                  {},
                  static_cast<double>(image.roughness[i])};
    own.to_eye_vs = -glm::normalize(own.position_vs);
    if (glm::dot(own.normal_vs, own.to_eye_vs) < 0) own.normal_vs = -own.normal_vs;
    return own;
}

/// D G2 / (4 n.v) of GGX, as tests/gpu/lobe_rays.cpp has it.
double lobe_value(const Reflector& own, glm::dvec3 to_light)
{
    const double alpha = own.roughness * own.roughness, n_v = glm::dot(own.normal_vs, own.to_eye_vs),
                 n_l  = glm::dot(own.normal_vs, to_light);
    const auto lambda = [&](double cosine) {
        return (std::sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
    };
    const double n_h    = glm::dot(own.normal_vs, glm::normalize(own.to_eye_vs + to_light));
    const double spread = n_h * n_h * (alpha * alpha - 1) + 1;
    return alpha * alpha / (std::numbers::pi * spread * spread) / (1 + lambda(n_v) + lambda(n_l)) / (4 * n_v);
}

double same_surface(const GBufferImage& image, const Reflector& own, glm::ivec2 other)
{
    const double     depth = image.depth[pixel_index(other, size_px)];
    const glm::dvec3 there = px_to_vs(image.view, glm::dvec2(other) + 0.5, depth);
    return std::exp(-std::abs(glm::dot(own.normal_vs, there - own.position_vs)) / (depth_tolerance * -there.z));
}

/// Half the width of the lobe where it meets the nearest thing that the pixel's rays met, in pixels.
double spread_px(const GBufferImage& image, const Reflector& own, glm::ivec2 pixel, const Rays& rays, glm::ivec2 traced)
{
    double nearest_m = 1e30;
    for (int ray = 0; ray < rays_per_pixel; ++ray) {
        const glm::dvec4 end(rays.end[pixel_index(traced + glm::ivec2(0, ray * size_px.y), size_px)]);
        if (end.w > 0) nearest_m = std::min(nearest_m, glm::distance(glm::dvec3(end), own.position_vs));
    }
    const double     depth = double(image.depth[pixel_index(pixel, size_px)]);
    const glm::dvec3 next  = px_to_vs(image.view, glm::dvec2(pixel) + glm::dvec2(1.5, 0.5), depth);
    return 0.8 * 1.3 * own.roughness * own.roughness * nearest_m / glm::distance(next, own.position_vs);
}

double spread_weight(double away) { return away > 3 ? 0 : std::exp(-0.5 * away * away); }

bool inside(glm::ivec2 pixel)
{
    return glm::all(glm::greaterThanEqual(pixel, glm::ivec2(0))) && glm::all(glm::lessThan(pixel, size_px));
}

glm::dvec4 mean(glm::dvec4 sum, double total)
{
    return sum.a > 0 ? glm::dvec4(glm::dvec3(sum) / sum.a, sum.a / total) : glm::dvec4(0);
}

/// Empty: another place may be the nearest one where cosines are off by 2^-10, twice what Vulkan allows near 0.
std::optional<glm::dvec4> reused(const GBufferImage& image, const Rays& rays, glm::ivec2 pixel, glm::dvec4 own_light,
                                 double radius_px, int neighbours, const std::vector<uint32_t>* blocks)
{
    const Reflector own = reflector_at(image, pixel);
    if (own.roughness < mirror_roughness) return own_light;
    const double turn       = 2 * std::numbers::pi * pcg(uint32_t(pixel.x) + pcg(uint32_t(pixel.y))) / 4294967296.0;
    glm::ivec2   traced_own = pixel;
    if (blocks != nullptr) {
        const uint32_t traced = (*blocks)[pixel_index(pixel / 2, size_px / 2)];
        if (traced == NO_PIXEL) return own_light;
        traced_own = unpack_pixel(traced);
    }
    const double spread = spread_px(image, own, pixel, rays, traced_own);
    glm::dvec4   sum(0);
    glm::dvec3   brightest(0);
    double       total = 0, most = 0, next = 0;
    int          counted = 0;
    for (int i = 0; i < neighbours; ++i) {
        const double     distance_px = radius_px * std::sqrt(double(i) / neighbours), angle = turn + 2.3999632 * i;
        const glm::dvec2 offset    = distance_px * glm::dvec2(std::cos(angle), std::sin(angle));
        const glm::dvec2 to_border = glm::abs(glm::fract(offset) - 0.5);
        if (std::min(to_border.x, to_border.y) <= distance_px / 1024) return std::nullopt;
        glm::ivec2 place = pixel + glm::ivec2(glm::round(offset));
        if (!inside(place)) continue;
        if (blocks != nullptr) {
            const uint32_t traced = (*blocks)[pixel_index(place / 2, size_px / 2)];
            if (traced == NO_PIXEL) continue;
            place = unpack_pixel(traced);
        }
        const double away = glm::distance(glm::dvec2(place), glm::dvec2(pixel)) / spread;
        if (std::abs(away - 3) < 1e-3) return std::nullopt;
        if (away > 3 || image.metallic[pixel_index(place, size_px)] == 0) continue;
        for (int ray = 0; ray < rays_per_pixel; ++ray) {
            const size_t     texel = pixel_index(place + glm::ivec2(0, ray * size_px.y), size_px);
            const glm::dvec4 light(rays.light[texel]), end(rays.end[texel]);
            const glm::dvec3 to_light = glm::normalize(glm::dvec3(end) - own.position_vs);
            const double     cosine   = glm::dot(own.normal_vs, to_light);
            if (std::abs(cosine - 1e-3) < 1e-4) return std::nullopt; // above or below?
            if (light.a < 0 || end.w <= 0 || cosine < 1e-3) continue;
            const double ratio = spread_weight(away) * same_surface(image, own, place) *
                                 std::min(lobe_value(own, to_light) / end.w, 8.0);
            const double bright = light.a * (0.2126 * light.r + 0.7152 * light.g + 0.0722 * light.b);
            sum += ratio * glm::dvec4(glm::dvec3(light) * light.a, light.a);
            total += ratio;
            ++counted;
            if (bright > most) {
                next      = most;
                most      = bright;
                brightest = ratio * light.a * glm::dvec3(light);
            } else
                next = std::max(next, bright);
        }
    }
    if (total < 1e-3) return std::nullopt; // a quotient of next to nothing
    if (counted > 1 && most > 0) sum -= glm::dvec4(brightest * (1 - next / most), 0);
    return mean(sum, total);
}

double as_half(double value) { return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value))); }

/// Of 13 places in steps so far apart, by a Gaussian over the steps and one of the narrower lobe's width, the likeness of roughness
/// and that of the surface. Roughness and the inverse of the width are kept as half floats.
std::optional<glm::dvec4> filtered(const GBufferImage& image, const Rays& rays, const Reflection& source,
                                   glm::ivec2 pixel, double spacing_px)
{
    const glm::dvec4 value(source[pixel_index(pixel, size_px)]);
    const Reflector  own = reflector_at(image, pixel);
    if (value.a < 0 || own.roughness < mirror_roughness) return value;
    const auto sharpness = [&](glm::ivec2 of) {
        return as_half(1 / spread_px(image, reflector_at(image, of), of, rays, of));
    };
    glm::dvec4 sum(0);
    double     total = 0;
    for (int i = 0; i < 25; ++i) {
        const glm::ivec2 step(i % 5 - 2, i / 5 - 2),
            place = pixel + glm::ivec2(glm::round(glm::dvec2(step) * spacing_px));
        if (!inside(place) || std::abs(step.x) + std::abs(step.y) > 2) continue;
        const glm::dvec4 other(source[pixel_index(place, size_px)]);
        if (other.a < 0) continue;
        const double away =
            glm::distance(glm::dvec2(place), glm::dvec2(pixel)) * std::max(sharpness(pixel), sharpness(place));
        if (std::abs(away - 3) < 3e-3) return std::nullopt;
        const double off =
            std::abs(as_half(double(image.roughness[pixel_index(place, size_px)])) - as_half(own.roughness));
        const double weight = std::exp(-0.25 * (step.x * step.x + step.y * step.y) - off / 0.05) * spread_weight(away) *
                              same_surface(image, own, place);
        sum += weight * glm::dvec4(glm::dvec3(other) * other.a, other.a);
        total += weight;
    }
    return total > 0 && sum.a > 0 ? mean(sum, total) : value;
}

struct Passed {
    GBufferImage          image;
    Reflection            traced, dense, wide;
    std::vector<uint32_t> blocks;
};

Passed run_reuse(GBufferImage image, const Rays& rays, const ParameterValues& changed)
{
    ParameterValues passes{
        chosen(Gloss::stochastic), {"rays_per_pixel", rays_per_pixel}, {"reuse_depth_tolerance", depth_tolerance}};
    passes.insert(changed.begin(), changed.end());
    const Picture picture = make_picture(image);
    const auto    frame   = frame_with(picture, passes);
    run_frame(device(), *frame); // makes the images of the rays, and says which pixels blocks are traced from
    LobeRayImages&        images = *picture.buffers->lobe_rays.at(rays_per_pixel);
    std::vector<uint64_t> texels;
    for (const glm::vec4& light : rays.light) texels.push_back(glm::packHalf4x16(light));
    upload(device(), images.light, texels.data(), texels.size() * sizeof(uint64_t));
    upload(device(), images.end, rays.end.data(), rays.end.size() * sizeof(glm::vec4));
    Passed passed;
    passed.image = picture.image;
    for (size_t i = 0; i < pixel_count(size_px); ++i)
        passed.traced.push_back(picture.image.metallic[i] > 0 ? glm::vec4(i % 32, 0.25F, 0, 1) : nothing_reflects);
    set_reflection(picture, passed.traced);
    run_pass(*frame, ray_reuse_pass());
    for (const auto& texel : download_as<std::array<uint64_t, 2>>(device(), images.gathered))
        passed.dense.push_back(glm::unpackHalf4x16(texel[0]));
    passed.wide = read_colours(picture.buffers->reflection);
    if (changed.contains(chosen(TraceResolution::half).first))
        passed.blocks = download_as<uint32_t>(device(), picture.buffers->block_pixel);
    return passed;
}

/// The ratios are within 0.2 % (LobeRays.ValueAndDensityAreThoseOfTheMicrofacetModel), so a mean of what they weigh is within 0.4 % of the
/// brightest, and half floats add 2^-10.
constexpr double share = 0.005;

// No filter reaches beyond its own pixel where the radius is 0; the rays are then those within 1.5 pixels, or blocks.
TEST(RayReuse, IsTheHostsSumOverTheNeighboursRays)
{
    std::mt19937       random(17);
    const GBufferImage image = uneven_walls(random);
    const Rays         rays  = random_rays(random);
    for (const int block_px : {1, 2}) {
        ParameterValues passes{{"reuse_radius", 0}, {"reuse_neighbours", 8}};
        if (block_px == 2) passes.insert(chosen(TraceResolution::half));
        const Passed passed = run_reuse(image, rays, passes);
        size_t       judged = 0, mirrors = 0;
        for (size_t i = 0; i < passed.wide.size(); ++i) {
            if (passed.image.metallic[i] == 0) {
                EXPECT_LT(passed.wide[i].a, 0) << i;
                continue;
            }
            const auto expected = reused(passed.image, rays, pixel_at(i, size_px), glm::dvec4(passed.traced[i]),
                                         1.5 * block_px, 8, block_px == 2 ? &passed.blocks : nullptr);
            if (!expected) continue;
            ++judged;
            mirrors += passed.image.roughness[i] < 0.02F;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(passed.wide[i][c] * passed.wide[i].a, (*expected)[c] * expected->a, 20 * share)
                    << i << ", blocks of " << block_px;
            ASSERT_NEAR(passed.wide[i].a, expected->a, share) << i;
        }
        EXPECT_GT(judged, 1500U);
        EXPECT_GT(mirrors, 150U);
    }
}

// One pixel's own rays, which are alike, make what that pixel is filtered from: first over neighbours, then in steps.
TEST(RayReuse, IsFilteredOverTheSameSurface)
{
    std::mt19937       random(18);
    const GBufferImage image = uneven_walls(random);
    Rays               rays  = random_rays(random);
    for (size_t i = 0; i < rays.light.size(); ++i) {
        const size_t first  = i % pixel_count(size_px);
        rays.light[first].a = std::abs(rays.light[first].a);
        rays.light[i]       = rays.light[first];
        rays.end[i]         = {0, 0, 0, 1}; // the eye, which every reflector faces
    }
    const double radius = 1; // a step of mirrors would be a third of a pixel, and two of them reach the next one
    const Passed passed = run_reuse(image, rays, {{"reuse_radius", radius}, {"reuse_neighbours", 1}});
    Reflection   own    = passed.traced;
    for (size_t i = 0; i < own.size(); ++i)
        if (own[i].a >= 0 && passed.image.roughness[i] >= 0.02F)
            own[i] = rays.light[i].a > 0 ? rays.light[i] : glm::vec4(0);
    size_t judged = 0, wider = 0;
    double brighter = 0; // in the mean over pixels: halves that are rounded down would make it -3e-4
    for (size_t i = 0; i < own.size(); ++i) {
        const glm::ivec2 pixel      = pixel_at(i, size_px);
        const double     spacing_px = 0.25 * radius * double(passed.image.roughness[i]) * size_px.y;
        // A step of whole pixels and a half may round either way.
        const auto halfway = [](double steps) { return std::abs(steps - std::floor(steps) - 0.5) < 1e-4; };
        if (halfway(spacing_px) || halfway(2 * spacing_px)) continue;
        const auto dense = filtered(passed.image, rays, own, pixel, std::min(spacing_px, 1.0)),
                   wide  = filtered(passed.image, rays, passed.dense, pixel, spacing_px);
        if (!dense || !wide) continue;
        ++judged;
        wider += spacing_px > 1.5;
        for (int c = 0; c < 4; ++c) {
            ASSERT_NEAR(passed.dense[i][c], (*dense)[c], 20 * share) << i;
            ASSERT_NEAR(passed.wide[i][c], (*wide)[c], 20 * share) << i;
        }
        brighter += wide->r > 0 ? double(passed.wide[i].r) / wide->r - 1 : 0;
    }
    EXPECT_GT(judged, 3000U);
    EXPECT_GT(wider, 2000U);
    EXPECT_NEAR(brighter / static_cast<double>(judged), 0, 1e-4);
}

// Before a flat, nearly smooth wall stands a dark bar, as wide as a pixel and 10 cm away; beside it everything is far and bright. The lobe is
// about a pixel wide there: what the bar's pixels see stays dark, and the bar does not spread.
TEST(RayReuse, AThinThingNearTheReflectorStays)
{
    constexpr int   bar_x = 32;
    constexpr float rough = 0.06F;
    GBufferImage    image = metal_wall(size_px);
    std::ranges::fill(image.roughness, rough);
    Rays rays;
    for (size_t i = 0; i < rays_per_pixel * pixel_count(size_px); ++i) {
        const glm::ivec2 pixel     = pixel_at(i % pixel_count(size_px), size_px);
        const Reflector  own       = reflector_at(image, pixel);
        const glm::dvec3 direction = glm::reflect(-own.to_eye_vs, own.normal_vs);
        const bool       meets_bar = pixel.x == bar_x;
        rays.light.push_back(meets_bar ? glm::vec4(0, 0, 0, 1) : glm::vec4(1));
        rays.end.emplace_back(own.position_vs + (meets_bar ? 0.1 : 1e6) * direction, lobe_value(own, direction));
    }
    const Passed passed = run_reuse(image, rays, {});
    for (int y = 8; y < size_px.y - 8; ++y)
        for (int x = 8; x < size_px.x - 8; ++x) {
            const float shown = passed.wide[pixel_index({x, y}, size_px)].g;
            EXPECT_TRUE(x == bar_x ? shown < 0.1F : shown > 0.9F) << x << ", " << y << ": " << shown;
        }
}

} // namespace
} // namespace ssrlab::test
