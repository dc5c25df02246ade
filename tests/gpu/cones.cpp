// Cone tracing against its twin on the host, and what cones leave alone.
#include "gpu/passes.h"

namespace ssrlab::test {
namespace {

/// A floor of the given roughness before a wall, where every column has the colour that `colour` says.
template <typename Colour> Picture floor_before_wall(float roughness, const Colour& colour)
{
    constexpr glm::ivec2 size_px{128, 128};
    GBufferImage         image = floor_and_wall(bench_view(size_px), 4);
    std::ranges::fill(image.roughness, roughness);
    for (size_t i = 0; i < image.radiance.size(); ++i) image.radiance[i] = colour(static_cast<int>(i) % size_px.x);
    std::ranges::fill(image.highlight, glm::vec3(0.5F));
    return make_picture(image);
}

/// What hit_colour makes of the hits, without fades.
Reflection reflection_of(const Picture& picture, ParameterValues passes)
{
    passes.insert({chosen(ViewerFade::off),
                   chosen(EdgeFade::off),
                   chosen(BounceMode::off),
                   {"skip_unneeded_passes", 0},
                   {"blur_scale", 0}});
    const auto frame = frame_with(picture, passes);
    run_frame(device(), *frame);
    return read_colours(picture.buffers->reflection);
}

TEST(Cones, LeaveSmoothSurfacesToTheLastBit)
{
    const Picture picture =
        floor_before_wall(0, [](int x) { return glm::vec3(static_cast<float>(x * 7919 % 256) / 256); });
    const Reflection cones = reflection_of(picture, {chosen(Gloss::cone)});
    EXPECT_GT(std::ranges::count_if(cones, [](const glm::vec4& pixel) { return pixel.a > 0; }), 1000);
    EXPECT_EQ(cones, reflection_of(picture, {chosen(Gloss::off)}));
}

/// What cones look up, made anew on the host: level 0 are the pixels.
class HostPyramid {
public:
    struct Cell {
        glm::dvec4 colour; // and visibility
        double     nearest_m, farthest_m;
    };

    HostPyramid(const GBufferImage& image, bool lit)
    {
        sizes_ = {image.view.size_px};
        levels_.emplace_back();
        for (size_t i = 0; i < image.depth.size(); ++i) {
            const glm::dvec3 light =
                glm::dvec3(image.radiance[i]) + (lit ? glm::dvec3(image.highlight[i]) : glm::dvec3(0));
            const double distance_m = image.depth[i] > 0 ? depth_to_distance(image.view, double(image.depth[i])) : 1e30;
            levels_[0].push_back({glm::dvec4(light, 1), distance_m, distance_m});
        }
        while (sizes_.back().y > 1) add_level();
    }
    int  top() const { return static_cast<int>(levels_.size()) - 1; }
    auto size(int level) const { return sizes_.at(level); }
    auto cell(glm::ivec2 at, int level) const
    {
        const glm::ivec2 size = sizes_.at(level), known = glm::clamp(at, glm::ivec2(0), size - 1);
        return levels_.at(level)[pixel_index(known, size)];
    }
    glm::dvec4 bilinear(glm::dvec2 place_px, int level) const
    {
        const glm::dvec2 place = place_px / std::exp2(level) - 0.5, low = glm::floor(place), part = place - low;
        const auto       at = [&](int x, int y) { return cell(glm::ivec2(low) + glm::ivec2(x, y), level).colour; };
        return glm::mix(glm::mix(at(0, 0), at(1, 0), part.x), glm::mix(at(0, 1), at(1, 1), part.x), part.y);
    }
    /// Circles from the hit back to the reflector, until they make a whole.
    struct Light {
        glm::dvec3 colour;
        double     whole = 1; // what was divided by
    };
    Light light(glm::dvec2 from_px, glm::dvec2 to_px, double sine, int steps, glm::dvec3 sharp) const
    {
        double     height = glm::distance(from_px, to_px), whole = 0;
        glm::dvec3 sum(0);
        for (int i = 0; i < steps && whole < 1; ++i) {
            const double radius = height * sine / (1 + sine);
            if (i == 0 && radius < 0.5) return {sharp};
            const double     level = std::clamp(std::log2(2 * radius), 0.0, double(top())), finer = std::floor(level);
            const glm::dvec2 centre = from_px + glm::normalize(to_px - from_px) * (height - radius);
            const glm::dvec4 seen   = glm::mix(bilinear(centre, int(finer)),
                                               bilinear(centre, std::min(int(finer) + 1, top())), level - finer);
            const double     share  = std::min(seen.a, 1 - whole);
            sum += share * glm::dvec3(seen);
            whole += share;
            height -= 2 * radius;
        }
        return {sum / whole, whole};
    }

private:
    void add_level()
    {
        const int         below = top();
        const glm::ivec2  size  = (sizes_.back() + 1) / 2;
        std::vector<Cell> cells;
        for (const auto [i, x, y] : pixels_of(size)) {
            // Parts beyond the picture are those beside it.
            const Cell part[4] = {cell({2 * x, 2 * y}, below), cell({2 * x + 1, 2 * y}, below),
                                  cell({2 * x, 2 * y + 1}, below), cell({2 * x + 1, 2 * y + 1}, below)};
            Cell       made{glm::dvec4(0), part[0].nearest_m, part[0].farthest_m};
            for (const Cell& own : part) {
                made.nearest_m  = std::min(made.nearest_m, own.nearest_m);
                made.farthest_m = std::max(made.farthest_m, own.farthest_m);
            }
            const double range_m = made.farthest_m - made.nearest_m;
            for (const Cell& own : part)
                made.colour.a += (range_m > 0 ? (own.nearest_m - made.nearest_m) / range_m : 1) * own.colour.a / 4;
            const double tent[4] = {1 / 8.0, 3 / 8.0, 3 / 8.0, 1 / 8.0};
            for (int v = 0; v < 4; ++v)
                for (int u = 0; u < 4; ++u)
                    made.colour += glm::dvec4(
                        tent[u] * tent[v] * glm::dvec3(cell({2 * x + u - 1, 2 * y + v - 1}, below).colour), 0);
            cells.push_back(made);
        }
        sizes_.push_back(size);
        levels_.push_back(std::move(cells));
    }
    std::vector<glm::ivec2>        sizes_;
    std::vector<std::vector<Cell>> levels_;
};

/// The floor before a wall, both uneven, a hundredth background, of any roughness and colour.
Picture uneven_floor_before_wall(glm::ivec2 size_px)
{
    std::mt19937                          random(7);
    std::uniform_real_distribution<float> unit(0, 1);
    GBufferImage                          image = floor_and_wall(bench_view(size_px), 4);
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const int y = static_cast<int>(i) / size_px.x;
        // A floor of one plane hides nothing of itself: its rays start from even pixels, and meet the wall.
        if (image.metallic[i] == 0) image.depth[i] *= random() % 100 == 0 ? 0 : 1 + 0.1F * unit(random);
        image.roughness[i] = 0.9F * unit(random);
        const float bright = y % 16 < 8 ? 1.0F : 0.2F;
        image.radiance[i]  = bright * glm::vec3(unit(random), unit(random), 1);
        image.highlight[i] = glm::vec3(0, unit(random), 0);
    }
    return make_picture(image);
}

// Every cell is stored with two roundings of 2^-11 (or one of 2^-10, where a device rounds down), and so is what it is made of: relative to colours
// and visibilities of at most 2 and 1 that is 2^-10 a level. A cone's angle comes from acos(), whose error Vulkan bounds by 4096 units in the last
// place, 4e-4 of it: circles are off by less than a thousandth of their diameter, which cells are as wide as. A share that is a little off leaves
// that much to the next circle.
TEST(Cones, EqualTheirHostTwin)
{
    constexpr double angle_error = 1e-3;
    for (const glm::ivec2& size_px : {glm::ivec2(101, 75), glm::ivec2(75, 131)}) {
        const Picture picture = uneven_floor_before_wall(size_px);
        for (const bool lit : {false, true}) {
            const HostPyramid host(picture.image, lit);
            const auto        shading = chosen(lit ? HitShading::lit : HitShading::diffuse);
            const double      stored  = host.top() * 2 * std::exp2(-10);
            for (const int steps : {1, 4}) {
                ParameterValues  passes{chosen(Gloss::cone),
                                       shading,
                                       chosen(ViewerFade::off),
                                       chosen(EdgeFade::off),
                                       chosen(BounceMode::off),
                                       {"skip_unneeded_passes", 0},
                                       {"blur_scale", 0},
                                       {"cone_steps", steps},
                                       {"cone_scale", steps == 1 ? 1 : 2},
                                       {"environment_fallback", 0}};
                const auto       frame  = frame_with(picture, passes);
                const TraceImage traced = counted(*frame);
                run_frame(device(), *frame);
                const Reflection found = read_colours(picture.buffers->reflection);
                const Reflection cells = read_colours(picture.buffers->cone->cells);
                for (int level = 1; level <= host.top(); ++level)
                    for (const auto [i, x, y] : pixels_of(host.size(level))) {
                        const int       row = (pyramid_root(size_px) >> level) + y;
                        const glm::vec4 cell =
                            cells[size_t(row) * size_t(picture.buffers->cone->cells.size_px.x) + size_t(x)];
                        const auto twin = host.cell({x, y}, level).colour;
                        for (int c = 0; c < 4; ++c)
                            ASSERT_NEAR(cell[c], twin[c], level * 2 * std::exp2(-10))
                                << level << ": " << x << ", " << y;
                    }
                size_t judged = 0, of_several = 0;
                for (size_t i = 0; i < found.size(); ++i) {
                    if (traced.status[i] != TraceStatus::hit) continue;
                    const glm::dvec2 from_px = glm::dvec2(i % size_t(size_px.x), i / size_t(size_px.x)) + 0.5,
                                     to_px(traced.hit_px_depth[i]);
                    const double alpha2 = std::pow(double(picture.image.roughness[i]), 4);
                    const double sine =
                        std::sin(std::min((steps == 1 ? 1 : 2) * std::acos(std::pow(0.244, alpha2 / (2 - alpha2))),
                                          std::numbers::pi / 2));
                    const double radius = glm::distance(from_px, to_px) * sine / (1 + sine);
                    if (std::abs(radius - 0.5) < 0.01) continue; // sharp, or a circle?
                    const glm::dvec3 sharp(host.cell(traced.hit_pixel[i], 0).colour);
                    const auto       twin = host.light(from_px, to_px, sine, steps, sharp);
                    if (twin.whole < 0.1) continue; // a quotient of next to nothing
                    ++judged;
                    of_several += steps > 1 &&
                                  glm::distance(twin.colour, host.light(from_px, to_px, sine, 1, sharp).colour) > 0.1;
                    for (int c = 0; c < 3; ++c)
                        ASSERT_NEAR(found[i][c], twin.colour[c], (stored + 4 * angle_error) / twin.whole)
                            << i << ", " << steps << " circles";
                }
                EXPECT_GT(judged, 1000U);
                EXPECT_TRUE(steps == 1 || of_several > 50) << of_several;
            }
        }
    }
}

// Rays pass behind a panel at 2 m and hit, in the second layer, the wall at 4 m. What they bring back is of that layer: not of a cone, which sees the first
// one; not bent away, since the wall lies where they go; and not faded, since the wall is flat.
TEST(Cones, SeeNothingOfDeeperLayers)
{
    GBufferImage image = floor_and_wall(bench_view({64, 64}), 4), behind = empty_gbuffer(image.view);
    std::ranges::fill(image.roughness, 0.6F);
    std::ranges::fill(image.radiance, glm::vec3(1, 0, 0));
    std::ranges::fill(behind.radiance, glm::vec3(0, 1, 0));
    for (int y = 24; y < 36; ++y)
        for (int x = 0; x < 64; ++x) {
            set_pixel(image, x, y, 2, {0, 0, 1}, 0);
            set_pixel(behind, x, y, 4, {0, 0, 1}, 0);
        }
    image.layers          = {behind};
    const Picture picture = make_picture(image);
    FrameSettings settings{.trace = boxes({.thickness_m = 0.5, .max_distance_m = 50})};
    settings.trace.layers = 2;
    for (const auto& [name, value] : ParameterValues{chosen(Gloss::cone),
                                                     chosen(HitShading::diffuse),
                                                     chosen(ViewerFade::off),
                                                     chosen(EdgeFade::off),
                                                     chosen(BounceMode::off),
                                                     {"environment_fallback", 0},
                                                     {"min_direction_cosine", 0.98},
                                                     {"depth_step_fade_m", 1}})
        settings.passes.at(name) = value;
    const auto       frame  = prepared_frame(picture.buffers, technique("dda"), values_of(technique("dda")), settings);
    const TraceImage traced = counted(*frame);
    run_frame(device(), *frame);
    const Reflection found  = read_colours(picture.buffers->reflection);
    size_t           deeper = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        if (traced.status[i] != TraceStatus::hit || traced.hit_layer[i] == 0) continue;
        if (traced.hit_pixel[i].y == 24 || traced.hit_pixel[i].y == 35) continue; // beside it the layer is empty
        ++deeper;
        // The reflection is kept as halves; below one these are 2^-11 apart.
        for (int channel = 0; channel < 4; ++channel)
            ASSERT_NEAR(found[i][channel], channel % 2, std::ldexp(1, -11)) << i;
    }
    EXPECT_GT(deeper, 200U);
}

} // namespace
} // namespace ssrlab::test
