// Sources that are G-buffers, ray by ray: exact techniques agree in each to the bit, and with the walk in double
// precision.
#include "gpu/device.h"
#include "harness/experiment.h"
#include "sources/answer_rays.h"
#include "truth/screen_truth.h"

namespace ssrlab::test {
namespace {

/// A ray as techniques get it, in the floats that they get.
ScreenRay in_floats(const View& view, const RayInput& input)
{
    ScreenRay ray;
    ray.traced          = true;
    ray.origin_px_depth = glm::dvec3(glm::vec3(input.origin_px_depth));
    ray.delta_px_depth  = glm::dvec3(glm::vec3(input.delta_px_depth));
    ray.start_pixel     = glm::min(glm::ivec2(ray.origin_px_depth), view.size_px - 1);
    ray.end_status      = input.end_status;
    ray.length_m        = input.length_m;
    // P = slope / depth * near, so that P1 - P0 times both depths is finite where P1 is not.
    const glm::dvec3 end   = ray.origin_px_depth + ray.delta_px_depth;
    const auto       slope = [&](glm::dvec3 at) {
        return (glm::dvec2(at) - view.centre_px) / view.focal_px * glm::dvec2(1, -1);
    };
    ray.direction_vs = glm::normalize(
        glm::dvec3(slope(end) * ray.origin_px_depth.z - slope(ray.origin_px_depth) * end.z, ray.delta_px_depth.z));
    return ray;
}

bool same_place(const WalkResult& walked, const RayOutcome& found)
{
    return walked.status == found.status &&
           (!has_place(found.status) || (walked.hit_pixel == found.hit_pixel && walked.hit_layer == found.hit_layer));
}

double ulp(double value)
{
    const auto rounded = static_cast<float>(std::abs(value));
    return double(std::nextafter(rounded, 2 * rounded + 1) - rounded);
}

/// Would the walk in double precision find the same if the ray were moved by the rounding of single precision?
bool is_near_tie(const ScreenWalk& walk, const View& view, const ScreenRay& ray, const RayOutcome& found)
{
    constexpr double roundings = 8;
    const double     px        = roundings * ulp(std::max(view.size_px.x, view.size_px.y));
    const double depth = roundings * ulp(std::max(ray.origin_px_depth.z, ray.origin_px_depth.z + ray.delta_px_depth.z));
    const glm::dvec3 step(px, px, depth);
    for (int i = 0; i < 27; ++i) {
        ScreenRay        moved = ray;
        const glm::dvec3 shift = step * (glm::dvec3(i % 3, i / 3 % 3, i / 9) - 1.0);
        moved.origin_px_depth += shift;
        if (same_place(walk.walk(moved), found)) return true;
    }
    return false;
}

struct Count {
    size_t places = 0, near_ties = 0, wrong = 0;
    double farthest_px = 0; // between two points of one pixel
};

void compare_with_twin(const TracedList& list, Count& count)
{
    const ScreenWalk walk(list.image, list.settings);
    const View&      view = list.image.view;
    for (size_t i = 0; i < list.rays.size(); ++i) {
        const ScreenRay   ray   = in_floats(view, list.rays[i]);
        const RayOutcome& found = list.outcomes[i];
        const WalkResult  truth = walk.walk(ray);
        count.places += has_place(found.status);
        if (same_place(truth, found)) {
            if (has_place(found.status))
                count.farthest_px = std::max(count.farthest_px, std::abs(truth.hit_t - found.t) *
                                                                    glm::length(glm::dvec2(ray.delta_px_depth)));
            continue;
        }
        if (is_near_tie(walk, view, ray, found)) {
            ++count.near_ties;
            continue;
        }
        if (count.wrong++ == 0)
            ADD_FAILURE() << fmt::format(
                "{} {} ray {}: {} ({}, {}) t {}, in double {} ({}, {}) t {}; from ({}, {}, {}) by ({}, {}, {})",
                list.settings.surface, size_text(view.size_px), i, status_name(found.status), found.hit_pixel.x,
                found.hit_pixel.y, found.t, status_name(truth.status), truth.hit_pixel.x, truth.hit_pixel.y,
                truth.hit_t, ray.origin_px_depth.x, ray.origin_px_depth.y, ray.origin_px_depth.z, ray.delta_px_depth.x,
                ray.delta_px_depth.y, ray.delta_px_depth.z);
    }
}

/// Rays on which a technique's answer has other bits.
size_t other_bits(const TracedList& list, const Technique& technique)
{
    const auto tracer = tracer_on(list.gbuffer, technique, values_of(technique), list.settings, list.rays.size());
    const auto own    = trace_rays(device(), *tracer, list.rays);
    size_t     others = 0;
    for (size_t i = 0; i < own.size(); ++i) {
        const RayOutcome& a = own[i];
        const RayOutcome& b = list.outcomes[i];
        others += a.status != b.status ||
                  (has_place(a.status) && (a.hit_pixel != b.hit_pixel || a.hit_layer != b.hit_layer || a.t != b.t));
    }
    return others;
}

struct Case {
    const char*              scene;
    glm::ivec2               size_px;
    TraceSettings            settings;
    std::vector<std::string> sources;
};

const TraceSettings in_sight{.behind = Behind::stop, .surface = "plane_infinite"};

const Case cases[] = {
    {"builtin:everything", {97, 55}, in_sight, {"layers:count=3", "wider", "cube:size_px=65", "past:count=1:every=1"}},
    {"builtin:hidden_shelf", {97, 55}, in_sight, {"layers:sides=front:count=2", "views:size_px=65"}},
    {"builtin:hidden_shelf", {64, 36}, boxes(), {"wider:margin=0.01", "cube:size_px=33"}},
};

/// As the camera would see it from half a metre aside.
View moved_aside(View view)
{
    view.world_to_view[3].x += 0.5;
    return view;
}

TEST(GBufferSources, AreTracedToTheBitByAllExactTechniquesAsInDoublePrecision)
{
    for (const Case& c : cases) {
        Stage stage = open_stage(device(), catalogue(), load_scene(c.scene));
        show(stage, "default", c.size_px);
        const Technique& dda = technique("dda");
        FrameSettings    settings;
        settings.trace        = c.settings;
        SourceContext context = make_source_context(stage, dda, values_of(dda), settings);
        context.earlier       = {moved_aside(context.image.view)};
        for (const std::string& source : c.sources) {
            SCOPED_TRACE(fmt::format("{} --sources {}, {}", c.scene, source, c.settings.surface));
            Count count;
            context.watch = [&](const TracedList& list) {
                compare_with_twin(list, count);
                for (const Technique& t : catalogue().techniques) {
                    if (t.exact) {
                        EXPECT_EQ(other_bits(list, t), 0U) << t.id << " with " << list.settings.surface;
                    }
                }
            };
            answer_rays(context, parse_sources("frame," + source, "test"), HandOn::uncertain);
            EXPECT_GT(count.places, 100U);
            // Of 17,000 rays none was one on lavapipe.
            EXPECT_LE(count.near_ties, 1U);
            EXPECT_EQ(count.wrong, 0U);
            EXPECT_LE(count.farthest_px, 1e-3);
        }
    }
}

} // namespace
} // namespace ssrlab::test
