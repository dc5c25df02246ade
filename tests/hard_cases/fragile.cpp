// Peers' formulations, written from their published descriptions, fail where they are known to fail: a check that cannot fail proves nothing.
#include "check/run_check.h"
#include "core/files.h"
#include "gpu/device.h"
#include "hard_cases/integer_oracle.h"
#include "hard_cases/random_rays.h"

#include <fmt/core.h>

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

} // namespace
} // namespace ssrlab::test
