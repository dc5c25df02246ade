// Peers' formulations, written from their published descriptions, fail where they are known to fail: a check that cannot fail proves nothing.
#include "check/run_check.h"
#include "core/files.h"
#include "gpu/device.h"
#include "hard_cases/integer_oracle.h"
#include "hard_cases/random_rays.h"

namespace ssrlab::test {
namespace {

const Technique& fragile(const std::string& id)
{
    static const std::filesystem::path  dirs[]     = {data_root() / "techniques/rivals"};
    static const std::vector<Technique> techniques = load_catalogue(dirs).techniques;
    return find_technique(techniques, id);
}

CaseRow check(const std::string& id, const std::string& case_name)
{
    return run_case(device(), catalogue(), fragile(id), default_values(fragile(id)), "", find_case(case_name),
                    {.double_precision = false});
}

/// Rays per million whose answer differs from the integers', in one field of the random campaign; corners touched in a point do not count.
double wrong_per_million(const std::string& id, Field field, glm::ivec2 size_px, const ParameterValues& changed = {})
{
    const ssrlab::Setup setup   = make_field(field, size_px, 3);
    const auto          gbuffer = upload_depth(device(), setup.gbuffer.view, setup.gbuffer.depth);
    const auto          rays    = random_rays(size_px, 100'000, 11);
    const Technique&    t       = fragile(id);
    const auto          tracer  = tracer_on(gbuffer, t, values_of(t, changed), campaign_settings, rays.size());
    const auto          found   = trace_rays(device(), *tracer, rays);
    size_t              wrong   = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const OracleAnswer exact = integer_oracle(setup.gbuffer, rays[i]);
        const bool         hit   = found[i].status == TraceStatus::hit;
        if (hit == exact.hit && (!hit || found[i].hit_pixel == exact.pixel)) continue;
        wrong += !(hit && passes_through_a_corner(rays[i], found[i].hit_pixel));
    }
    const double rate = 1e6 * static_cast<double>(wrong) / static_cast<double>(rays.size());
    fmt::print("{} on field {} at {}x{}: {:.0f} rays a million wrong\n", id, static_cast<int>(field), size_px.x,
               size_px.y, rate);
    return rate;
}

/// A wall in the sky, 5 m away from column 40 on, and a level ray along the row, half a metre behind the wall's front.
RayOutcome behind_a_wall(const Technique& t, double thickness_m, const ParameterValues& changed = {})
{
    const View                  view   = bench_view({64, 8});
    const auto                  wall   = picture_of(view, [](glm::ivec2 pixel) { return pixel.x < 40 ? 0.0 : 5.0; });
    const auto                  tracer = tracer_on(upload_gbuffer(device(), wall), t, values_of(t, changed),
                                                   boxes({.thickness_m = thickness_m, .max_distance_m = 1e9}), 1);
    const std::vector<RayInput> rays{level_ray(view, {5.5, 3.5}, {55, 0}, 5.5)};
    return trace_rays(device(), *tracer, rays).front();
}

TEST(Fragile, AnEpsilonOfTheImageLosesAxisAlignedRays)
{
    const CaseRow row = check("epsilon_uv", "axis_aligned");
    EXPECT_EQ(row.wrong, row.rays) << "every ray of a level camera's floor runs down one column";
    EXPECT_GT(check("epsilon_uv", "signed_zero").breaks, 0U);
    EXPECT_GT(check("epsilon_uv", "narrow_and_wide").wrong, 1000U);
}

TEST(Fragile, UnitysLoopLosesWhatItEntersFromBehind)
{
    EXPECT_GT(wrong_per_million("unity_hiz", Field::terrain, {641, 359}, {{"max_steps", 2000}}), 1000)
        << "behind = hit: the walk hits a slab from behind, too";
}

TEST(Fragile, AnEpsilonCutsCornersMoreOftenTheLargerTheImage)
{
    EXPECT_EQ(wrong_per_million("dda", Field::poles, {1920, 1080}), 0);
    const double pixel = wrong_per_million("epsilon_pixel", Field::poles, {1920, 1080}),
                 uv    = wrong_per_million("epsilon_uv", Field::poles, {1920, 1080});
    EXPECT_GT(pixel, 300);
    EXPECT_GT(uv, 10 * pixel) << "1e-5 of 1920 px is four times 0.005 px, and axis-aligned rays are lost";
    EXPECT_GT(wrong_per_million("epsilon_pixel", Field::sparse_poles, {16384, 64}), 100);
}

TEST(Fragile, AccumulatedBordersDriftWithTheNumberOfSteps)
{
    EXPECT_LT(wrong_per_million("incremental_dda", Field::poles, {17, 31}), 500);
    EXPECT_GT(wrong_per_million("incremental_dda", Field::poles, {1920, 1080}), 10);
    EXPECT_GT(wrong_per_million("incremental_dda", Field::sparse_poles, {3840, 2160}), 100);
    const CaseRow row = check("incremental_dda", "last_row_and_column");
    EXPECT_GT(row.wrong, 0U) << "16384 columns: the last border's t is off by more than a pixel";
    EXPECT_GT(row.worst_deviation_px, 0.5);
}

TEST(Fragile, StoppingBehindTheFirstObjectLosesWhatIsBehindIt)
{
    const CaseRow row = check("first_occluder", "floating_beam");
    EXPECT_GT(row.wrong, row.rays / 50);
    // It reports running out: 128 cells are not enough for a row of poles.
    EXPECT_GT(check("first_occluder", "crossings_of_odd_sizes").out_of_steps, 0U);
    EXPECT_GT(wrong_per_million("first_occluder", Field::poles, {641, 359}), 20'000);
}

TEST(Fragile, EnginesMeetAWallByTheirOwnRules)
{
    const glm::ivec2 first{40, 3};
    EXPECT_EQ(behind_a_wall(technique("dda"), 1).hit_pixel, first);
    EXPECT_EQ(behind_a_wall(technique("dda"), 0.1).status, TraceStatus::left_screen);
    EXPECT_EQ(behind_a_wall(fragile("bevy_march"), 1).hit_pixel, first);
    EXPECT_EQ(behind_a_wall(fragile("bevy_march"), 0.1).status, TraceStatus::left_screen);
    EXPECT_EQ(behind_a_wall(fragile("godot_hiz"), 2).hit_pixel, first);
    EXPECT_EQ(behind_a_wall(fragile("godot_hiz"), 1).status, TraceStatus::left_screen)
        << "its thickness is along the line of sight, which is slanted here";
    EXPECT_EQ(behind_a_wall(fragile("babylon_dda"), 1).status, TraceStatus::left_screen) << "ends at the sky";
    EXPECT_EQ(behind_a_wall(fragile("babylon_dda"), 1, {{"ends_at_sky", 0}}).hit_pixel, first);
    const int hit = behind_a_wall(fragile("filament_dda"), 1, {{"beyond", 0}}).hit_pixel.x;
    EXPECT_TRUE(hit == 40 || hit == 41) << hit;
    EXPECT_EQ(behind_a_wall(fragile("filament_dda"), 1).hit_pixel.x, hit + 2) << "one stride beyond";
    EXPECT_EQ(behind_a_wall(fragile("unreal_steps"), 0.1).status, TraceStatus::hit) << "its thickness is its own";
    EXPECT_EQ(behind_a_wall(fragile("three_march"), 1).status, TraceStatus::left_screen) << "seen edge-on";
}

TEST(Fragile, MarchesStepOverPoles)
{
    for (const char* id : {"bevy_march", "eevee_march", "three_march", "unreal_steps"})
        EXPECT_GT(wrong_per_million(id, Field::poles, {641, 359}), 10'000) << id;
    EXPECT_GT(check("godot_hiz", "crossings_of_odd_sizes").out_of_steps, 0U);
}

} // namespace
} // namespace ssrlab::test
