// The pipeline that records what a ray looks at: the answer is the same, and the visits are those of the walk.
#include "gpu/device.h"
#include "trace/lab.h"

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{161, 91};

struct Rays {
    Picture               picture;
    TraceSettings         settings = boxes({.thickness_m = 0.2, .max_distance_m = 20});
    std::vector<RayInput> some; // of those that reflect
};

Rays rays_of(const std::string& scene)
{
    Rays       rays{make_picture(scene, "default", size_px), boxes({.thickness_m = 0.2, .max_distance_m = 20}), {}};
    const auto tracer = tracer_on(rays.picture.gbuffer, technique("dda"), values_of(technique("dda")), rays.settings,
                                  rays.picture.image.depth.size());
    const auto all    = set_up_rays(device(), *tracer);
    for (size_t i = all.size() / 13; i < all.size(); i += all.size() / 6) rays.some.push_back(all[i]);
    return rays;
}

TEST(RecordedRays, AnswersAreThoseOfTheCountedPipelineForEveryTechnique)
{
    const Rays rays = rays_of("builtin:stairs");
    for (const Technique& t : catalogue().techniques) {
        const ParameterValues values = values_of(t);
        const auto            tracer = tracer_on(rays.picture.gbuffer, t, values, rays.settings, 1);
        for (const RayInput& ray : rays.some) {
            const RecordedRay recorded =
                record_ray(device(), lab_on_picture(rays.picture, t, values, rays.settings), ray);
            EXPECT_EQ(recorded.outcome, trace_rays(device(), *tracer, std::span(&ray, 1))[0]) << t.id;
            EXPECT_EQ(recorded.visit_count, recorded.visits.size());
            EXPECT_EQ(recorded.visits.empty(), recorded.outcome.depth_fetches + recorded.outcome.structure_fetches == 0)
                << t.id;
        }
    }
}

TEST(RecordedRays, VisitsAreTheWalkAndThePyramidSkipsPartsOfIt)
{
    const Rays rays = rays_of("builtin:stairs");
    size_t     hits = 0, skipped = 0;
    for (const RayInput& ray : rays.some) {
        const auto record = [&](const char* id) {
            return record_ray(
                device(), lab_on_picture(rays.picture, technique(id), values_of(technique(id)), rays.settings), ray);
        };
        const RecordedRay           walked = record("dda"), climbed = record("hiz");
        const std::vector<RayVisit>&pixels = walked.visits, &cells = climbed.visits;
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
        for (size_t i = 1; i < cells.size(); ++i) {
            EXPECT_LE(cells[i].level, cells[i - 1].level + 1);
            if (cells[i].level > cells[i - 1].level) {
                EXPECT_NE(cells[i].pixel >> cells[i].level, cells[i - 1].pixel >> cells[i].level)
                    << "climbs without leaving the cell above";
            }
        }
        skipped += pixels.size() > cells.size() ? pixels.size() - cells.size() : 0;
    }
    EXPECT_GT(hits, 0);
    EXPECT_GT(skipped, 0);
}

TEST(CountedWork, IsWhatTheRaysRead)
{
    const Rays rays = rays_of("builtin:stairs");
    for (const char* id : {"dda", "hiz", "quadtree"})
        for (const RayInput& ray : rays.some) {
            const auto recorded = record_ray(
                device(), lab_on_picture(rays.picture, technique(id), values_of(technique(id)), rays.settings), ray);
            const auto pixels = std::ranges::count(recorded.visits, 0, &RayVisit::level);
            EXPECT_EQ(recorded.outcome.depth_fetches, pixels) << id;
            EXPECT_EQ(recorded.outcome.structure_fetches, recorded.visits.size() - size_t(pixels)) << id;
        }
}

TEST(CountedWork, OfALayerIsAReadMoreAPixel)
{
    const Picture picture = make_picture("builtin:stairs", "default", size_px);
    const auto    walk    = trace(picture, technique("dda"), values_of(technique("dda")),
                                  boxes({.thickness_m = 0.2, .max_distance_m = 20, .layers = 2}));
    size_t        misses  = 0;
    for (size_t i = 0; i < walk.status.size(); ++i) {
        if (has_place(walk.status[i]) || walk.steps[i] == 0) continue;
        ++misses;
        ASSERT_EQ(walk.depth_fetches[i], 2 * walk.steps[i]) << i;
    }
    EXPECT_GT(misses, 100U);
}

// The two rays of a pair wait for each other, and pay for themselves alone.
TEST(CountedWork, OfPairsIsThatOfSingleRays)
{
    const Picture       picture  = make_picture("builtin:stairs", "default", size_px);
    const TraceSettings settings = boxes({.thickness_m = 0.2, .max_distance_m = 20});
    const auto          work_of  = [&](const char* id) {
        return trace(picture, technique(id), values_of(technique(id)), settings);
    };
    const TraceImage pairs = work_of("hiz_packets"), single = work_of("hiz_waves");
    EXPECT_EQ(pairs.steps, single.steps);
    EXPECT_EQ(pairs.depth_fetches, single.depth_fetches);
    ASSERT_EQ(pairs.structure_fetches.size(), single.structure_fetches.size());
    for (size_t i = 0; i < pairs.structure_fetches.size(); ++i)
        EXPECT_EQ(pairs.structure_fetches[i].fetches, single.structure_fetches[i].fetches);
}

} // namespace
} // namespace ssrlab::test
