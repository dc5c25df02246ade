// The baselines, linear and linear_binary, held ray by ray against the same marches in double precision on the CPU. These share nothing with the shaders:
// rays and meetings are those of the screen truth.
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "truth/pixel_surface.h"
#include "truth/screen_ray.h"
#include "unit/truth_gbuffers.h"

namespace ssrlab::test {
namespace {

enum Space { view, screen, pixels };

struct March {
    int    space     = view;
    int    steps     = 0;
    double stride_px = 1;
    bool   interval = false, interpolate = false;
    int    binary_steps = 0; // of linear_binary
};

struct Found {
    TraceStatus status;
    glm::ivec2  pixel{0, 0};
    double      t     = 0;
    uint32_t    steps = 0;
    int         layer = 0;
};

/// One ray of a march.
struct Marcher {
    const GBufferImage&  image;
    const TraceSettings& settings;
    const March&         march;
    ScreenRay            ray;
    bool                 passed = false; // it met something from behind

    glm::ivec2 pixel_of(double t) const
    {
        const glm::dvec2 p(ray.origin_px_depth + t * ray.delta_px_depth);
        return glm::clamp(glm::ivec2(glm::floor(p)), glm::ivec2(0), image.view.size_px - 1);
    }

    double sample_t(int i) const
    {
        const glm::dvec2 way = glm::abs(glm::dvec2(ray.delta_px_depth));
        if (march.space == pixels) return i * march.stride_px / std::max({march.stride_px, way.x, way.y});
        const double part = double(i) / march.steps;
        if (march.space == screen) return part;
        const double of_length = settings.max_distance_m * part / ray.length_m;
        if (of_length > 1) return 2;
        if (image.view.projection == Projection::orthographic) return of_length;
        // 1 / distance is linear on screen.
        const double z0 = ray.origin_px_depth.z, z1 = z0 + ray.delta_px_depth.z;
        return of_length / (of_length + (1 - of_length) * z1 / z0);
    }

    Meeting meeting(glm::ivec2 pixel, int layer, double t_in, double t_out) const
    {
        const GBufferImage& held    = layer_of(image, layer);
        const size_t        i       = pixel_index(pixel, image.view.size_px);
        const auto          surface = pixel_surface(image, layer, i, settings);
        if (!surface) return {};
        return meet(*surface, {ray.origin_px_depth, ray.delta_px_depth, t_in, t_out},
                    glm::dot(glm::dvec3(held.normal_vs[i]), ray.direction_vs));
    }

    bool passes(const Meeting& met) const { return met.meets && met.from_behind && settings.behind == Behind::pass; }

    bool touches(glm::ivec2 pixel, double t_in, double t_out)
    {
        bool ends = false;
        for (int layer = 0; layer < layer_count(image, settings) && pixel != ray.start_pixel; ++layer) {
            const Meeting met = meeting(pixel, layer, t_in, t_out);
            passed |= passes(met);
            ends |= met.meets && !passes(met);
        }
        return ends;
    }

    /// Of the layers in which the ray ends there, that which it meets first; of two at once the one in front. t: empty where it meets it.
    Found hit(glm::ivec2 pixel, double t_in, double t_out, std::optional<double> t, int taken) const
    {
        Meeting first;
        int     first_layer = 0;
        for (int layer = 0; layer < layer_count(image, settings); ++layer) {
            const Meeting met = meeting(pixel, layer, t_in, t_out);
            if (!met.meets || passes(met) || (first.meets && met.t >= first.t)) continue;
            first       = met;
            first_layer = layer;
        }
        const bool stops = settings.behind == Behind::stop && first.from_behind;
        return {stops ? TraceStatus::stopped : TraceStatus::hit, pixel, t.value_or(first.t), uint32_t(taken),
                first_layer};
    }

    /// The part of the ray in a pixel's square.
    RayPart part_in(glm::ivec2 pixel) const
    {
        RayPart part{ray.origin_px_depth, ray.delta_px_depth, 0, 1};
        for (int axis : {0, 1}) {
            const double a = (pixel[axis] - ray.origin_px_depth[axis]) / ray.delta_px_depth[axis],
                         b = (pixel[axis] + 1 - ray.origin_px_depth[axis]) / ray.delta_px_depth[axis];
            if (ray.delta_px_depth[axis] == 0) continue;
            part.t_in  = std::max(part.t_in, std::min(a, b));
            part.t_out = std::min(part.t_out, std::max(a, b));
        }
        return part;
    }

    Found interpolated(double t_before, double t, int taken)
    {
        Found            sample  = hit(pixel_of(t), march.interval ? t_before : t, t, t, taken);
        const double     depth   = double(image.depth[pixel_index(sample.pixel, image.view.size_px)]);
        const double     t_front = (depth - ray.origin_px_depth.z) / ray.delta_px_depth.z;
        const glm::ivec2 front   = pixel_of(std::clamp(t_front, t_before, t));
        const RayPart    part    = part_in(front);
        if (!touches(front, part.t_in, part.t_out)) return sample;
        return hit(front, part.t_in, part.t_out, {}, taken);
    }

    Found run()
    {
        if (!ray.traced) return {TraceStatus::not_traced};
        const double begin    = std::min(part_in(ray.start_pixel).t_out, 1.0); // where the first step begins
        double       t_before = 0, t = 0;
        bool         ended = false, found = false;
        int          taken = 0;
        while (!ended && !found && taken < march.steps) {
            t_before = t;
            t        = sample_t(++taken);
            ended    = t > 1;
            found    = !ended && touches(pixel_of(t), march.interval ? std::max(t_before, begin) : t, t);
        }
        const bool more = march.space == pixels && !ended && sample_t(taken + 1) <= 1;
        if (!found)
            return {more     ? TraceStatus::out_of_steps
                    : passed ? TraceStatus::facing_away
                             : ray.end_status,
                    {},
                    0,
                    uint32_t(taken)};
        if (march.interpolate && ray.delta_px_depth.z != 0) return interpolated(std::max(t_before, begin), t, taken);
        if (march.interval) return hit(pixel_of(t), std::max(t_before, begin), t, t, taken);

        double free = t_before;
        for (int k = 0; k < march.binary_steps; ++k) {
            const double middle                                    = 0.5 * (free + t);
            (touches(pixel_of(middle), middle, middle) ? t : free) = middle;
        }
        return hit(pixel_of(t), t, t, t, taken + march.binary_steps);
    }
};

void expect_march(const Picture& picture, const std::string& id, const ParameterValues& changed, const March& march,
                  const TraceSettings& settings)
{
    const Technique&      t      = technique(id);
    const ParameterValues values = values_of(t, changed);
    const TraceImage      result = trace(picture, t, values, settings, NumberFormat::float64);
    const GBufferImage    image  = read_gbuffer(device(), *picture.gbuffer); // with the layers that the trace has drawn
    size_t                wrong = 0, hits = 0, behind = 0;
    for (size_t i = 0; i < result.status.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, picture.view.size_px);
        Marcher          marcher{image, settings, march, make_screen_ray(image, pixel, settings)};
        const Found      found = marcher.run();
        const bool       place = has_place(found.status);
        hits += place;
        behind += found.layer > 0;
        if (found.status == result.status[i] && found.steps == result.steps[i] &&
            (!place || (found.pixel == result.hit_pixel[i] && found.layer == result.hit_layer[i] &&
                        std::abs(found.t - result.hit_t[i]) <= double_twins_t)))
            continue;
        if (wrong++ < 3)
            ADD_FAILURE() << fmt::format("ray of pixel ({}, {}): expected {} at ({}, {}), layer {}, t = {}, {} steps; "
                                         "found {} at ({}, {}), layer {}, t = {}, {} steps",
                                         pixel.x, pixel.y, status_name(found.status), found.pixel.x, found.pixel.y,
                                         found.layer, found.t, found.steps, status_name(result.status[i]),
                                         result.hit_pixel[i].x, result.hit_pixel[i].y, result.hit_layer[i],
                                         result.hit_t[i], result.steps[i]);
    }
    EXPECT_EQ(wrong, 0U) << repeat_command("builtin:pole_field", "default", picture.view.size_px, t, values, settings);
    EXPECT_GT(hits, 400U);
    EXPECT_TRUE(settings.layers == 1 || behind > 10) << behind;
}

/// The limits differ with the rule, so that each is tried without trying all combinations.
const TraceSettings each_rule[] = {boxes({.thickness_m = 0.1, .max_distance_m = 20}),
                                   boxes({.thickness_m = 0.5, .max_distance_m = 12}, Behind::pass),
                                   boxes({.thickness_m = 2, .max_distance_m = 30}, Behind::stop)};
constexpr int       steps_in[]  = {48, 48, 200}; // of the three spaces
constexpr double    stride_px   = double(1.3F);  // what the shader gets; no sample falls on a border

/// Surfaces of random depths and normals, and another one behind each.
GBufferImage two_layers_of_noise(const View& view)
{
    GBufferImage image = random_gbuffer(view, 3), behind = random_gbuffer(view, 8);
    for (size_t i = 0; i < image.depth.size(); ++i)
        behind.depth[i] = image.depth[i] > 0 ? std::min(behind.depth[i], 0.9F * image.depth[i]) : 0;
    image.layers = {behind};
    return image;
}

class LinearMarch : public testing::TestWithParam<int> {
protected:
    void SetUp() override
    {
        if (!device().info.float64) GTEST_SKIP() << "this device has no double precision";
    }
    const Picture         picture = make_picture("builtin:pole_field", "default", {161, 91});
    const int             space = GetParam(), steps = steps_in[space];
    const ParameterValues common{{"space", space}, {"steps", steps}, {"stride_px", stride_px}};
};

TEST_P(LinearMarch, EqualsItsHostTwin)
{
    for (const TraceSettings& settings : each_rule)
        for (const bool interval : {false, true})
            for (const bool interpolate : {false, true}) {
                ParameterValues values = common;
                values["interval"] = interval, values["interpolate"] = interpolate;
                expect_march(picture, "linear", values, {space, steps, stride_px, interval, interpolate}, settings);
            }
}

TEST_P(LinearMarch, WithBinarySearchEqualsItsHostTwin)
{
    for (const TraceSettings& settings : each_rule)
        for (const int halvings : {0, 1, 7}) {
            ParameterValues values = common;
            values["binary_steps"] = halvings;
            expect_march(picture, "linear_binary", values, {space, steps, stride_px, false, false, halvings}, settings);
        }
}

TEST_P(LinearMarch, OfTwoLayersEqualsItsHostTwin)
{
    const Picture noise = make_picture(two_layers_of_noise(bench_view({161, 91})));
    for (TraceSettings settings : each_rule)
        for (const bool interval : {false, true}) {
            settings.layers        = 2;
            ParameterValues values = common;
            values["interval"]     = interval;
            expect_march(noise, "linear", values, {space, steps, stride_px, interval}, settings);
        }
}

TEST_P(LinearMarch, OfAnOrthographicViewEqualsItsHostTwin)
{
    View view       = bench_view({161, 91});
    view.projection = Projection::orthographic;
    view.focal_px   = glm::dvec2(12);
    view.far_m      = 30;
    expect_march(make_picture(two_layers_of_noise(view)), "linear", common, {space, steps, stride_px}, each_rule[2]);
}

INSTANTIATE_TEST_SUITE_P(Spaces, LinearMarch, testing::Values(view, screen, pixels));

} // namespace
} // namespace ssrlab::test
