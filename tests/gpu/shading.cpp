// C = C_frag + (C_reflect - C_frag) * beta against the formula, for every switch.
#include "core/pixel_index.h"
#include "gpu/passes.h"
#include "truth/glossy_truth.h"
#include "truth/screen_ray.h"
#include "unit/truth_scenes.h"

namespace ssrlab::test {
namespace {

/// Floor and wall with a different colour in every pixel.
GBufferImage coloured()
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 10);
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        image.radiance[at(image, x, y)]  = {static_cast<float>(x) / 64, static_cast<float>(y) / 64, 0.25F};
        image.highlight[at(image, x, y)] = {0, 0.5F, static_cast<float>(x % 4) / 4};
        if (image.metallic[at(image, x, y)] > 0) image.metallic[at(image, x, y)] = x % 2 == 0 ? 0.75F : 1.0F;
    }
    return image;
}

/// The same with a wall of columns at three distances, and with holes.
GBufferImage rugged()
{
    GBufferImage image = coloured();
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        if (image.metallic[at(image, x, y)] > 0) continue;
        set_pixel(image, x, y, 10 + 0.1 * (x / 4 % 3), {0, 0, 1}, 0);
        if (x % 16 == 7 && y % 8 == 4) image.depth[at(image, x, y)] = 0;
    }
    return image;
}

double viewer_weight(ViewerFade fade, double away, double start)
{
    switch (fade) {
    case ViewerFade::off: return 1;
    case ViewerFade::linear: return std::max(0.0, away);
    case ViewerFade::cut: return away > 0 ? 1 : 0;
    case ViewerFade::smooth: break;
    }
    return std::clamp((away - start) / (1 - start), 0.0, 1.0);
}

constexpr double border_width = 0.1;

double edge_weight(EdgeFade fade, glm::dvec2 offset)
{
    const double radial = std::clamp(2 * glm::length(offset), 0.0, 1.0);
    switch (fade) {
    case EdgeFade::off: return 1;
    case EdgeFade::manhattan: return std::clamp(1 - std::abs(offset.x) - std::abs(offset.y), 0.0, 1.0);
    case EdgeFade::linear: return 1 - radial;
    case EdgeFade::border: {
        const double inside =
            std::clamp((0.5 - std::max(std::abs(offset.x), std::abs(offset.y))) / border_width, 0.0, 1.0);
        return inside * inside * (3 - 2 * inside);
    }
    case EdgeFade::squared: break;
    }
    return 1 - radial * radial;
}

double depth_step_weight(const GBufferImage& image, glm::ivec2 hit, double fade_m)
{
    if (fade_m == 0) return 1;
    const auto distance_m = [&](glm::ivec2 pixel) {
        return depth_to_distance(image.view, static_cast<double>(image.depth[at(image, pixel.x, pixel.y)]));
    };
    double largest_m = 0;
    for (const glm::ivec2& beside : {glm::ivec2(-1, 0), glm::ivec2(1, 0), glm::ivec2(0, -1), glm::ivec2(0, 1)}) {
        const glm::ivec2 pixel = glm::clamp(hit + beside, glm::ivec2(0), image.view.size_px - 1);
        const bool       hole  = image.depth[at(image, pixel.x, pixel.y)] <= 0;
        largest_m              = std::max(largest_m, hole ? fade_m : std::abs(distance_m(pixel) - distance_m(hit)));
    }
    return 1 - std::min(largest_m / fade_m, 1.0);
}

glm::dvec3 start_vs(const GBufferImage& image, size_t i)
{
    return pixel_point_vs(image, pixel_at(i, image.view.size_px));
}

/// Between the ray and the direction to the middle of the pixel that it hit.
double direction_cosine(const GBufferImage& image, const TraceImage& result, size_t i)
{
    const glm::ivec2 pixel = pixel_at(i, image.view.size_px);
    return glm::dot(mirror_direction_vs(image, pixel),
                    glm::normalize(pixel_point_vs(image, result.hit_pixel[i]) - start_vs(image, i)));
}

double attenuation(Attenuation attenuation, const GBufferImage& image, const TraceImage& result, size_t i)
{
    const glm::dvec3 end      = result.hit_px_depth[i];
    const double     length_m = glm::distance(px_to_vs(image.view, glm::dvec2(end), end.z), start_vs(image, i));
    switch (attenuation) {
    case Attenuation::off: return 1;
    case Attenuation::inverse: return std::min(1.0, 1 / length_m);
    case Attenuation::inverse_square: break;
    }
    return std::min(1.0, 1 / (length_m * length_m));
}

double beta(const GBufferImage& image, const TraceImage& result, size_t i, const ParameterValues& passes)
{
    const glm::ivec2 pixel(static_cast<int>(i) % 64, static_cast<int>(i) / 64);
    const double     exponent = passes.at("metallic_exponent");
    double           value    = exponent > 0 ? std::pow(static_cast<double>(image.metallic[i]), exponent) : 1;
    const double     away     = -mirror_direction_vs(image, pixel).z;
    const glm::dvec2 offset   = glm::dvec2(result.hit_px_depth[i]) / 64.0 - 0.5;
    const double     viewer   = viewer_weight(choice<ViewerFade>(passes), away, passes.at("viewer_fade_start"));
    const double     edge     = edge_weight(choice<EdgeFade>(passes), offset);
    const double     most     = 1 - passes.at("base_colour_min_weight");
    const double     step     = depth_step_weight(image, result.hit_pixel[i], passes.at("depth_step_fade_m"));
    if (direction_cosine(image, result, i) < passes.at("min_direction_cosine")) return 0;
    value *= choice<FadeOperator>(passes) == FadeOperator::product ? viewer * edge * step * most
                                                                   : std::min({viewer, edge, step, most});
    return value;
}

class Shading : public testing::TestWithParam<ParameterValues> {};

TEST_P(Shading, IsTheFormulaAtEveryPixel)
{
    const Picture       picture  = make_picture(rugged());
    const TraceSettings settings = boxes({.thickness_m = 0.5, .max_distance_m = 50});
    ParameterValues     passes   = report_passes();
    passes.at("edge_fade_width") = border_width;
    for (const auto& [name, value] : GetParam()) passes.at(name) = value;
    const auto frame =
        prepared_frame(picture.buffers, technique("hiz"), values_of(technique("hiz")), {settings, "plane", passes});
    const TraceImage result = counted(*frame);
    run_frame(device(), *frame);
    const Image shaded = read_shaded(device(), *frame);
    size_t      hits = 0, seen = 0;
    for (size_t i = 0; i < result.status.size(); ++i) {
        const bool hit = result.status[i] == TraceStatus::hit;
        // Rounding may move a hit over that bound.
        if (hit && std::abs(direction_cosine(picture.image, result, i) - passes.at("min_direction_cosine")) < 1e-5)
            continue;
        glm::dvec3 expected = glm::dvec3(picture.image.radiance[i]) + glm::dvec3(picture.image.highlight[i]);
        // What is kept in half precision: the pixel's own light in two parts, the reflection, its weight, and the picture.
        glm::dvec3 rounded = expected;
        if (hit) {
            ++hits;
            seen += beta(picture.image, result, i, passes) > 0;
            const auto       from = pixel_index(result.hit_pixel[i], result.size_px);
            const glm::dvec3 reflected =
                glm::dvec3(picture.image.radiance[from]) * // without the highlight: that belongs to the camera
                attenuation(choice<Attenuation>(passes), picture.image, result, i);
            const glm::dvec3 change = (reflected - expected) * beta(picture.image, result, i, passes);
            rounded += reflected * beta(picture.image, result, i, passes) + glm::abs(change);
            expected += change;
        }
        rounded += expected;
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(static_cast<double>(shaded.values[3 * i + static_cast<size_t>(c)]), expected[c],
                        0x1p-11 * rounded[c] + 1e-5)
                << "pixel " << i << ", channel " << c;
    }
    EXPECT_GT(hits, 300U);
    EXPECT_GT(seen, 100U);
    EXPECT_TRUE(passes.at("min_direction_cosine") == -1 || seen < hits - 100);
}

INSTANTIATE_TEST_SUITE_P(
    Settings, Shading,
    testing::Values(ParameterValues{},
                    ParameterValues{{"metallic_exponent", 0}, chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{chosen(ViewerFade::off), chosen(EdgeFade::border)},
                    ParameterValues{{"metallic_exponent", 1.5}, chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{{"metallic_exponent", 0}, chosen(ViewerFade::linear), chosen(EdgeFade::off)},
                    ParameterValues{{"metallic_exponent", 0}, chosen(ViewerFade::cut), chosen(EdgeFade::manhattan)},
                    ParameterValues{chosen(ViewerFade::smooth), {"viewer_fade_start", 0.4}, chosen(EdgeFade::linear)},
                    // Litheon's blending: the smaller weight, at most 0.4.
                    ParameterValues{chosen(ViewerFade::smooth),
                                    chosen(EdgeFade::squared),
                                    chosen(FadeOperator::minimum),
                                    {"base_colour_min_weight", 0.6}},
                    ParameterValues{{"depth_step_fade_m", 0.25}, chosen(ViewerFade::off), chosen(EdgeFade::off)},
                    ParameterValues{{"depth_step_fade_m", 0.25},
                                    {"base_colour_min_weight", 0.5},
                                    chosen(FadeOperator::minimum),
                                    chosen(EdgeFade::off)},
                    ParameterValues{chosen(Attenuation::inverse), chosen(EdgeFade::off)},
                    ParameterValues{chosen(Attenuation::inverse_square), chosen(EdgeFade::off)},
                    ParameterValues{{"min_direction_cosine", 0.9998}, chosen(EdgeFade::off)},
                    ParameterValues{{"skip_unneeded_passes", 0}, {"metallic_exponent", 2}}));

/// A floor of that metal and a wall of stripes of other colours behind it, whose light is their colour.
Scene floor_before_stripes(float metallic)
{
    Scene scene;
    scene.ambient                    = glm::vec3(1);
    const uint32_t floor             = add_material(scene, {0.5F, 0.25F, 0}, metallic);
    scene.materials[floor].roughness = 0;
    add_quad(scene, floor, {-20, -1, 2}, {40, 0, 0}, {0, 0, -10});
    for (int stripe = 0; stripe < 40; ++stripe) {
        const glm::vec3 colour = glm::vec3(stripe % 2, stripe % 3, stripe % 5) * glm::vec3(1, 0.5F, 0.25F);
        add_quad(scene, add_material(scene, colour, 0), {stripe - 20, -1, -8}, {1, 0, 0}, {0, 20, 0});
    }
    for (Draw& draw : scene.draws) {
        draw.bounds_min_ws = glm::vec3(-50);
        draw.bounds_max_ws = glm::vec3(50);
    }
    return scene;
}

// Of an exact tracer without fades nothing is left between picture and truth where it meets the point that is truly reflected.
TEST(ShadingByMetallic, IsTheTruePictureOfAMirror)
{
    for (const float metallic : {1.0F, 0.5F})
        for (const float exponent : {1.0F, 2.0F}) {
            const Scene scene = floor_before_stripes(metallic);
            Camera      camera;
            camera.target_ws        = {0, -0.5, -8};
            const Picture   picture = make_picture(scene, camera, {64, 64});
            ParameterValues passes  = report_passes();
            for (const auto& [name, value] :
                 ParameterValues{chosen(ViewerFade::off), chosen(EdgeFade::off), {"metallic_exponent", exponent}})
                passes.at(name) = value;
            const TraceSettings settings{.max_distance_m = 50, .surface = "plane", .dielectric_min_f0 = 1};
            const auto          frame = prepared_frame(picture.buffers, technique("dda"), values_of(technique("dda")),
                                                       {settings, "plane", passes});
            const TraceImage    found = counted(*frame);
            run_frame(device(), *frame);
            const Image       shaded = read_shaded(device(), *frame);
            const SceneBvh    bvh(scene);
            const SceneTruth  rays = scene_truth(bvh, scene, picture.image, settings);
            const GlossyTruth truth =
                glossy_truth(bvh, scene, picture.image, settings, {.metallic_exponent = exponent});
            const Image real   = true_picture(truth, picture.image, scene.ambient);
            size_t      judged = 0;
            for (size_t i = 0; i < found.status.size(); ++i) {
                const bool hit = found.status[i] == TraceStatus::hit;
                if (found.status[i] != TraceStatus::not_traced && !hit) continue;
                // Beyond an edge, the pixel that is met shows another stripe than the point. A driver may draw the floor so coarsely that
                // true rays begin below it, and meet it: SwiftShader does at three quarters of the pixels.
                if (hit &&
                    glm::distance(rays.radiance[i],
                                  picture.image.radiance[pixel_index(found.hit_pixel[i], found.size_px)]) > 0.01F)
                    continue;
                judged += hit;
                for (size_t c = 3 * i; c < 3 * i + 3; ++c)
                    ASSERT_NEAR(shaded.values[c], real.values[c], 4 * 0x1p-11F)
                        << i << ' ' << metallic << ' ' << exponent;
            }
            EXPECT_GT(judged, 200U) << metallic << ' ' << exponent;
        }
}

// A mirror on the left turned to the right, a nearer wall there: rays meet the wall on their way back to the viewer.
TEST(ShadingTowardTheViewer, WeighsNothing)
{
    GBufferImage image = empty_gbuffer(bench_view({64, 64}));
    for (const auto [i, x, y] : pixels_of({64, 64}))
        if (x < 32)
            set_pixel(image, x, y, 10, glm::normalize(glm::dvec3(1, 0, 2)), 1);
        else
            set_pixel(image, x, y, 9, {0, 0, 1}, 0);
    const Picture       picture  = make_picture(image);
    const TraceSettings settings = boxes({.thickness_m = 0.5, .max_distance_m = 50});
    for (const ViewerFade fade : {ViewerFade::linear, ViewerFade::cut, ViewerFade::smooth}) {
        ParameterValues passes = report_passes();
        for (const auto& [name, value] : ParameterValues{chosen(fade), chosen(EdgeFade::off)}) passes.at(name) = value;
        const auto frame =
            prepared_frame(picture.buffers, technique("dda"), values_of(technique("dda")), {settings, "plane", passes});
        const TraceImage result = counted(*frame);
        run_frame(device(), *frame);
        const Reflection found  = read_colours(picture.buffers->reflection);
        size_t           toward = 0;
        for (size_t i = 0; i < result.status.size(); ++i) {
            if (result.status[i] != TraceStatus::hit) continue;
            if (mirror_direction_vs(image, pixel_at(i, image.view.size_px)).z <= 0) continue;
            ++toward;
            EXPECT_EQ(found[i].a, 0) << i;
        }
        EXPECT_GT(toward, 100U);
    }
}

// Nothing hit, nothing changed: the lit colour to the last bit, also of pixels that are no surface.
TEST(ShadingOfMisses, LeavesTheLitColour)
{
    const Picture       picture  = make_picture(coloured());
    const TraceSettings settings = boxes({.thickness_m = 0, .max_distance_m = 0.001});
    const auto frame = prepared_frame(picture.buffers, technique("dda"), values_of(technique("dda")), {settings});
    run_frame(device(), *frame);
    const Image shaded = read_shaded(device(), *frame);
    for (size_t i = 0; i < picture.image.depth.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(shaded.values[3 * i + static_cast<size_t>(c)],
                        picture.image.radiance[i][c] + picture.image.highlight[i][c], 1e-3F);
}

} // namespace
} // namespace ssrlab::test
