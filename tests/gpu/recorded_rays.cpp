// The pipeline that records what a ray looks at: the answer is the same, and the visits are those of the walk.
#include "gpu/device.h"
#include "render/ray_list.h"

#include <algorithm>

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{161, 91};

struct Rays {
    Picture               picture;
    TraceSettings         settings{.thickness_m = 0.2, .max_distance_m = 20};
    std::vector<RayInput> some; // of those that reflect
};

Rays rays_of(const std::string& scene)
{
    Rays       rays{make_picture(scene, "default", size_px), {.thickness_m = 0.2, .max_distance_m = 20}, {}};
    const auto tracer = make_ray_tracer(device(), rays.picture.gbuffer, technique("dda"), values_of(technique("dda")),
                                        rays.settings, rays.picture.image.depth.size());
    const auto all    = set_up_rays(device(), *tracer);
    for (size_t i = all.size() / 13; i < all.size(); i += all.size() / 6) rays.some.push_back(all[i]);
    return rays;
}

TEST(RecordedRays, AnswersAreThoseOfTheCountedPipelineForEveryTechnique)
{
    const Rays rays = rays_of("builtin:stairs");
    for (const Technique& t : list_techniques({})) {
        const ParameterValues values = values_of(t);
        const auto            tracer = make_ray_tracer(device(), rays.picture.gbuffer, t, values, rays.settings, 1);
        for (const RayInput& ray : rays.some) {
            const RecordedRay recorded = record_ray(device(), rays.picture.gbuffer, t, values, rays.settings, ray);
            EXPECT_EQ(recorded.outcome, trace_rays(device(), *tracer, std::span(&ray, 1))[0]) << t.id;
            EXPECT_EQ(recorded.visit_count, recorded.visits.size());
            EXPECT_EQ(recorded.visits.empty(), recorded.outcome.depth_fetches + recorded.outcome.structure_fetches == 0)
                << t.id;
        }
    }
}

/// The result reads its pixel once more.
std::vector<RayVisit> without_result(RecordedRay recorded)
{
    if (recorded.outcome.status == TraceStatus::hit) recorded.visits.pop_back();
    return recorded.visits;
}

TEST(RecordedRays, VisitsAreTheWalkAndThePyramidSkipsPartsOfIt)
{
    const Rays rays = rays_of("builtin:stairs");
    size_t     hits = 0, skipped = 0;
    for (const RayInput& ray : rays.some) {
        const auto record = [&](const char* id) {
            return record_ray(device(), rays.picture.gbuffer, technique(id), values_of(technique(id)), rays.settings,
                              ray);
        };
        const RecordedRay           walked = record("dda"), climbed = record("hiz");
        const std::vector<RayVisit> pixels = without_result(walked), cells = without_result(climbed);
        ASSERT_EQ(pixels.size(), walked.outcome.steps);
        ASSERT_EQ(cells.size(), climbed.outcome.steps);
        glm::ivec2 before(glm::floor(glm::dvec2(ray.origin_px_depth)));
        for (const RayVisit& visit : pixels) {
            const glm::ivec2 step = glm::abs(visit.pixel - before);
            EXPECT_TRUE(step.x <= 1 && step.y <= 1 && step.x + step.y > 0);
            EXPECT_EQ(visit.level, 0);
            EXPECT_EQ(visit.t_in, -1) << "between borders: all of the pixel";
            before = visit.pixel;
        }
        if (walked.outcome.status == TraceStatus::hit) {
            EXPECT_EQ(pixels.back().pixel, walked.outcome.hit_pixel);
            EXPECT_EQ(cells.back().pixel, walked.outcome.hit_pixel);
            ++hits;
        }
        for (const RayVisit& cell : cells) {
            const bool crossed = std::ranges::any_of(
                pixels, [&](const RayVisit& p) { return p.pixel >> cell.level == cell.pixel >> cell.level; });
            EXPECT_TRUE(crossed) << "level " << cell.level << " " << cell.pixel.x << ", " << cell.pixel.y;
        }
        skipped += pixels.size() > cells.size() ? pixels.size() - cells.size() : 0;
    }
    EXPECT_GT(hits, 0);
    EXPECT_GT(skipped, 0);
}

} // namespace
} // namespace ssrlab::test
