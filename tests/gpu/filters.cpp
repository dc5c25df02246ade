// Passes that make one reflection out of several: up-sampling, down-sampling, filters.
#include "core/pixel_index.h"
#include "frame/directional_albedo.h"
#include "gpu/passes.h"

namespace ssrlab::test {
namespace {

using enum TraceResolution;

constexpr glm::vec4 red{1, 0, 0, 1}, blue{0, 0, 1, 1};

/// At half resolution: traces, so that the blocks name their pixels, then gives those left of column 31 red, the others blue, and up-samples by distance
/// and, if asked, by depth.
Reflection upsample(const Picture& picture, bool by_depth)
{
    const auto frame = frame_with(
        picture,
        {chosen(half), {"upsampling_depth", by_depth}, {"upsampling_normal", 0}, {"upsampling_reflectivity", 0}});
    run_frame(device(), *frame);
    Reflection reflection(picture.image.depth.size(), nothing_reflects);
    for (const uint32_t block : download_as<uint32_t>(device(), picture.buffers->block_pixel)) {
        if (block == NO_PIXEL) continue;
        const glm::ivec2 pixel                          = unpack_pixel(block);
        reflection[at(picture.image, pixel.x, pixel.y)] = pixel.x < 31 ? red : blue;
    }
    set_reflection(picture, reflection);
    run_pass(*frame, upsampling_pass());
    return read_colours(picture.buffers->reflection);
}

// Pixel (30, 9) belongs to the right surface; bilinear weights know only the traced pixels above and below it, which don't.
TEST(Upsampling, TakesTheMostAlikeWhereAllWeightsVanish)
{
    GBufferImage image =
        metal_wall({64, 16}); // from column 31 on another surface, between the traced columns 30 and 32
    for (int y = 0; y < 16; ++y)
        for (int x = 31; x < 64; ++x) set_pixel(image, x, y, 7, {0, 0, 1}, 1);
    set_pixel(image, 30, 9, 7, {0, 0, 1}, 1);
    set_pixel(image, 31, 5, 5.6, {0, 0, 1}, 1); // of neither surface, and nearer to the left one
    const Picture    picture  = make_picture(image);
    const Reflection by_depth = upsample(picture, true);
    EXPECT_EQ(upsample(picture, false)[at(image, 30, 9)], red);
    EXPECT_EQ(by_depth[at(image, 30, 9)], blue);
    EXPECT_EQ(by_depth[at(image, 31, 5)], red);
}

/// The split-sum table, bilinear; its entries have tests of their own (Composite.GgxReflectsItsDirectionalAlbedo).
double albedo(double f0, double roughness, double cosine)
{
    constexpr int    entries = DFG_TABLE_ENTRIES;
    const glm::dvec2 place = glm::dvec2(std::sqrt(cosine), roughness) * (entries - 1.0), low = glm::floor(place),
                     part = place - low;
    const auto entry      = [&](int dx, int dy) {
        const glm::ivec2 at = glm::min(glm::ivec2(low) + glm::ivec2(dx, dy), glm::ivec2(entries - 1));
        return glm::dvec2(dfg_table()[size_t(at.y * entries + at.x)]);
    };
    const glm::dvec2 terms =
        glm::mix(glm::mix(entry(0, 0), entry(1, 0), part.x), glm::mix(entry(0, 1), entry(1, 1), part.x), part.y);
    return std::clamp(f0 * terms.x + std::min(1.0, 50 * f0) * terms.y, 0.0, 1.0);
}

struct Seen {
    glm::dvec3 position_vs, normal_vs;
    double     reflectivity;
};

Seen seen_at(const GBufferImage& image, glm::ivec2 pixel)
{
    const size_t     i        = at(image, pixel.x, pixel.y);
    const glm::dvec3 position = px_to_vs(image.view, glm::dvec2(pixel) + 0.5, double(image.depth[i])),
                     facing   = glm::normalize(glm::dvec3(image.normal_vs[i]));
    const double luma         = glm::dot(glm::dvec3(image.base_colour[i]), {0.2126, 0.7152, 0.0722}),
                 metallic     = double(image.metallic[i]);
    const double f0           = glm::mix(double(image.dielectric_f0[i]), luma, metallic);
    return {position, facing,
            albedo(f0, double(image.roughness[i]), std::max(0.0, glm::dot(facing, -glm::normalize(position))))};
}

/// Of a device's filtering Vulkan asks 8 bits: reflectivities are off by 2^-8 of what neighbouring entries of the table differ by, which is below a half. The
/// tolerance divides that by a half, so weights are within 0.4 %, and a mean of values up to 1 within 0.4 %, and half floats add 2^-11.
TEST(Upsampling, IsTheHostsMean)
{
    constexpr glm::ivec2                   size_px{62, 46};
    std::mt19937                           random(31);
    std::uniform_real_distribution<double> unit(0, 1);
    GBufferImage                           image = metal_wall(size_px);
    for (const auto [i, x, y] : pixels_of(size_px)) {
        const glm::dvec3 leaning(0.3 * unit(random), 0.3 * unit(random), 1);
        // A wall that recedes to the right: along it depths differ more than across it.
        set_pixel(image, x, y, 5 + 0.05 * x + 0.02 * unit(random), glm::normalize(leaning),
                  random() % 8 == 0   ? 0
                  : random() % 2 == 0 ? 0.5F
                                      : 1.0F);
        image.base_colour[i]   = glm::vec3(unit(random), unit(random), unit(random));
        image.dielectric_f0[i] = 0.01F;
        image.roughness[i]     = float(unit(random));
    }
    Reflection values;
    for (size_t i = 0; i < image.depth.size(); ++i)
        values.emplace_back(unit(random), unit(random), unit(random), float(random() % 3) / 2);
    const Picture picture         = make_picture(image);
    const double  depth_tolerance = 0.02, reflectivity_tolerance = 0.5;
    for (const auto& [resolution, block_px] : {std::pair(half, 2), {quarter, 4}})
        for (int weights = 0; weights < 16; ++weights) {
            const bool by_distance = weights & 1, by_depth = weights & 2, by_normal = weights & 4,
                       by_reflectivity = weights & 8;
            ParameterValues passes{chosen(resolution),
                                   {"upsampling_distance", by_distance},
                                   {"upsampling_depth", by_depth},
                                   {"upsampling_normal", by_normal},
                                   {"upsampling_reflectivity", by_reflectivity},
                                   {"upsampling_depth_tolerance", depth_tolerance},
                                   {"upsampling_reflectivity_tolerance", reflectivity_tolerance}};
            const auto      frame = frame_with(picture, passes);
            run_frame(device(), *frame); // says which pixels blocks are traced from
            const glm::ivec2 blocks = (size_px - 1) / block_px + 1;
            const auto       traced = download_as<uint32_t>(device(), picture.buffers->block_pixel);
            Reflection       source(values.size(), nothing_reflects);
            for (int i = 0; i < blocks.x * blocks.y; ++i) {
                const uint32_t from =
                    traced[size_t(i / blocks.x * picture.buffers->block_pixel.size_px.x + i % blocks.x)];
                if (from == NO_PIXEL) continue;
                const glm::ivec2 pixel              = unpack_pixel(from);
                source[at(image, pixel.x, pixel.y)] = values[at(image, pixel.x, pixel.y)];
            }
            set_reflection(picture, source);
            run_pass(*frame, upsampling_pass());
            const Reflection found  = read_colours(picture.buffers->reflection);
            size_t           judged = 0;
            for (size_t i = 0; i < found.size(); ++i) {
                const glm::ivec2 pixel = pixel_at(i, size_px);
                if (image.metallic[i] == 0) {
                    ASSERT_EQ(found[i], nothing_reflects) << i;
                    continue;
                }
                if (source[i].a >= 0) continue;
                const Seen       own   = seen_at(picture.image, pixel);
                const glm::dvec2 place = glm::dvec2(pixel - (block_px - 1) / 2) / double(block_px),
                                 low = glm::floor(place), part = place - low;
                glm::dvec4 sum(0);
                double     total = 0;
                for (int corner = 0; corner < 4; ++corner) {
                    const glm::ivec2 step(corner % 2, corner / 2), block = glm::ivec2(low) + step;
                    if (block.x < 0 || block.y < 0 || block.x >= blocks.x || block.y >= blocks.y) continue;
                    const uint32_t from = traced[size_t(block.y * picture.buffers->block_pixel.size_px.x + block.x)];
                    if (from == NO_PIXEL) continue;
                    const Seen   other  = seen_at(picture.image, unpack_pixel(from));
                    const double off_m  = std::abs(glm::dot(own.normal_vs, other.position_vs - own.position_vs));
                    double       weight = 1;
                    if (by_distance)
                        weight *= (step.x == 1 ? part.x : 1 - part.x) * (step.y == 1 ? part.y : 1 - part.y);
                    if (by_depth) weight *= std::exp(off_m / (depth_tolerance * own.position_vs.z));
                    if (by_normal) weight *= std::pow(glm::dot(own.normal_vs, other.normal_vs), 32);
                    if (by_reflectivity)
                        weight *= std::exp(-std::abs(own.reflectivity - other.reflectivity) / reflectivity_tolerance);
                    const glm::dvec4 value(source[at(image, unpack_pixel(from).x, unpack_pixel(from).y)]);
                    sum += weight * glm::dvec4(glm::dvec3(value) * value.a, value.a);
                    total += weight;
                }
                if (total < 1e-3) continue; // next to nothing: the most alike counts
                ++judged;
                const glm::dvec4 expected =
                    sum.a > 0 ? glm::dvec4(glm::dvec3(sum) / sum.a, sum.a / total) : glm::dvec4(0);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(found[i][c] * found[i].a, expected[c] * expected.a, 5e-3)
                        << i << ", weights " << weights << ", blocks of " << block_px;
                ASSERT_NEAR(found[i].a, expected.a, 5e-3) << i << ", weights " << weights << ", blocks of " << block_px;
            }
            EXPECT_GT(judged, 1000U);
        }
}

TEST(ColourDownsampling, IsABlockMeanWithACross)
{
    GBufferImage image                = metal_wall({64, 64});
    image.radiance[at(image, 20, 21)] = {64, 0, 0};
    for (int x = 0; x < 64; ++x) image.radiance[at(image, x, 50)] = {0, 8, 0};
    for (glm::vec3& radiance : image.radiance) radiance.b = 3;
    for (glm::vec3& highlight : image.highlight) highlight.b = 5;
    const Picture picture = make_picture(image);
    {
        const auto frame = frame_with(picture, {chosen(half), chosen(HitShading::lit)});
        run_pass(*frame, colour_downsampling_pass());
        EXPECT_EQ(read_colours(picture.buffers->small_colour).front(), glm::vec4(0, 0, 8, 1)) << "with highlights";
    }
    for (const TraceResolution resolution : {half, quarter}) {
        const auto frame = frame_with(picture, {chosen(resolution), chosen(HitShading::diffuse)});
        run_pass(*frame, colour_downsampling_pass());
        const Reflection small    = read_colours(picture.buffers->small_colour);
        const int        block_px = resolution == half ? 2 : 4;
        const auto       texel    = [&](int x, int y) { return small[pixel_index({x, y}, {32, 32})]; };
        const glm::ivec2 block    = glm::ivec2(20, 21) / block_px;
        const float      mean     = 64.0F / static_cast<float>(block_px * block_px);
        EXPECT_EQ(texel(block.x, block.y), glm::vec4(mean / 2, 0, 3, 1));
        for (const glm::ivec2& arm : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
            EXPECT_EQ(texel(block.x + arm.x, block.y + arm.y).r, mean / 8);
        EXPECT_EQ(texel(block.x + 1, block.y + 1).r, 0);
        EXPECT_EQ(texel(block.x + 2, block.y).r, 0);
        const float line = 8.0F / static_cast<float>(block_px);
        EXPECT_EQ(texel(3, 50 / block_px).g, line * 0.75F);
        EXPECT_NEAR(texel(0, 50 / block_px).g, line * (0.75F - 0.125F) / 0.875F,
                    1e-2); // without an arm outside the picture
        EXPECT_EQ(texel(3, 50 / block_px + 1).g, line / 8);
    }
}

// An orthographic picture: above a wall, below it mirrors a little farther away that send their rays straight up. Every column has hits, the outer
// ones too, and all that they may find has one colour.
TEST(ColourDownsampling, IsThatColourUpToTheBorder)
{
    View view          = bench_view({64, 64});
    view.projection    = Projection::orthographic;
    view.far_m         = 20;
    view.focal_px      = glm::dvec2(12);
    GBufferImage image = empty_gbuffer(view);
    for (const auto [i, x, y] : pixels_of({64, 64})) {
        if (y < 32)
            set_pixel(image, x, y, 5, {0, 0, 1}, 0);
        else
            set_pixel(image, x, y, 5.4 - 0.005 * (y - 32), glm::normalize(glm::dvec3(0, 1, 1)), x < 60 || x == 63);
        image.radiance[at(image, x, y)] = {1, 2, 3};
    }
    const Picture picture = make_picture(image);
    for (const TraceResolution resolution : {half, quarter}) {
        const auto frame = frame_with(
            picture, {chosen(resolution), chosen(ViewerFade::off), chosen(EdgeFade::off), chosen(Gloss::off)});
        run_frame(device(), *frame);
        const Reflection found = read_colours(picture.buffers->reflection);
        for (int x = 0; x < 64; ++x) {
            if (x >= 60 && x < 63) continue; // which leaves column 63 alone in its block: it is traced itself
            EXPECT_LE(glm::distance(found[at(image, x, 50)], {1, 2, 3, 1}), 4e-3) << "column " << x;
        }
    }
}

/// What the kernels are to do, on the host.
Reflection filtered(const Reflection& source, glm::ivec2 size_px, bool median)
{
    Reflection result = source;
    for (const auto [i, x, y] : pixels_of(size_px)) {
        const auto index = [&](int px, int py) { return pixel_index({px, py}, size_px); };
        if (source[index(x, y)].a < 0) continue;
        std::vector<glm::vec4> near;
        for (int v = std::max(0, y - 1); v <= std::min(size_px.y - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(size_px.x - 1, x + 1); ++u)
                if (source[index(u, v)].a >= 0) near.push_back(source[index(u, v)]);
        if (median) {
            const auto luma = [](const glm::vec4& v) { return v.a * (0.2126F * v.r + 0.7152F * v.g + 0.0722F * v.b); };
            std::ranges::stable_sort(near, {}, luma);
            result[index(x, y)] = near[(near.size() - 1) / 2];
            continue;
        }
        glm::vec4 sum(0);
        for (const glm::vec4& v : near) sum += glm::vec4(glm::vec3(v) * v.a, v.a);
        result[index(x, y)] =
            sum.a > 0 ? glm::vec4(glm::vec3(sum) / sum.a, sum.a / static_cast<float>(near.size())) : glm::vec4(0);
    }
    return result;
}

Reflection run_filter(const Picture& picture, const Reflection& source, Filter3x3 filter)
{
    const auto frame = frame_with(picture, {chosen(filter)});
    set_reflection(picture, source);
    run_pass(*frame, filter_3x3_pass());
    return read_colours(picture.buffers->reflection);
}

TEST(Filter3x3Pass, IsTheHostsOnAnyReflection)
{
    const glm::ivec2 size_px{61, 35};
    GBufferImage     image = metal_wall(size_px);
    std::mt19937     random(3);
    Reflection       source;
    for (float& metallic : image.metallic) {
        const bool reflecting = random() % 4 != 0;
        metallic              = reflecting ? 1.0F : 0.0F;
        const auto  value     = [&] { return static_cast<float>(random() % 64) / 32; };
        const float weight    = static_cast<float>(random() % 3) / 2;
        source.push_back(reflecting ? glm::vec4(value(), value(), value(), weight) : nothing_reflects);
    }
    const Picture picture = make_picture(image);
    for (const bool median : {false, true}) {
        const Reflection found    = run_filter(picture, source, median ? Filter3x3::median3 : Filter3x3::box3),
                         expected = filtered(source, size_px, median);
        for (size_t i = 0; i < found.size(); ++i)
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(found[i][c], expected[i][c], median ? 0 : 1e-3 * std::abs(expected[i][c])) << i;
    }
}

TEST(CompositeReflection, MakesThePictureThatTheFrameMakes)
{
    const Picture picture = make_picture("builtin:sphere_over_mirror", "default", {161, 91});
    const auto    frame   = frame_with(picture, {}, "hiz");
    run_frame(device(), *frame);
    const Image      expected = read_shaded(device(), *frame);
    const Reflection traced   = read_colours(picture.buffers->reflection);
    EXPECT_EQ(composite_reflection(device(), *frame, traced).values, expected.values);
    EXPECT_NE(composite_reflection(device(), *frame, Reflection(traced.size(), nothing_reflects)).values,
              expected.values);
}

} // namespace
} // namespace ssrlab::test
