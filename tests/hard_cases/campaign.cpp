// Exact techniques in a random campaign: hiz finds what dda finds, bit for bit, and both find what integers find.
#include "check/judge.h"
#include "gpu/device.h"
#include "hard_cases/integer_oracle.h"
#include "hard_cases/random_rays.h"

#include <fmt/core.h>

#include <cstdlib>

namespace ssrlab::test {
namespace {

bool long_run() { return std::getenv("SSRLAB_LONG") != nullptr; }

struct Count {
    size_t rays = 0, corners = 0, slivers = 0, gross = 0, out_of_steps = 0;
    size_t hits = 0;
    double per_million(size_t n) const
    {
        return rays == 0 ? 0 : 1e6 * static_cast<double>(n) / static_cast<double>(rays);
    }
};

std::vector<RayOutcome> outcomes_of(const std::string& id, const ParameterValues& changed, const GBufferPtr& gbuffer,
                                    const std::vector<RayInput>& rays)
{
    const Technique& t = technique(id);
    const auto tracer  = make_ray_tracer(device(), gbuffer, t, values_of(t, changed), campaign_settings, rays.size());
    return trace_rays(device(), *tracer, rays);
}

/// Compares with the oracle; a difference is a sliver or gross as check/judge.h says.
void judge_against_integers(const Setup& field, const std::vector<RayInput>& rays,
                            const std::vector<RayOutcome>& outcomes, Count& count, std::string& first)
{
    const Judge judge(field);
    for (size_t i = 0; i < rays.size(); ++i) {
        const OracleAnswer exact = integer_oracle(field.gbuffer, rays[i]);
        const RayOutcome&  found = outcomes[i];
        ++count.rays;
        count.hits += exact.hit;
        count.out_of_steps += found.status == TraceStatus::out_of_steps;
        const bool hit = found.status == TraceStatus::hit;
        if (hit == exact.hit && (!hit || found.hit_pixel == exact.pixel)) continue;
        // Where double precision sides with float and the integers with neither, the judge says "right": a sliver all the same.
        const Judgement judgement = judge.judge(rays[i], found, {});
        const bool      wrong     = judgement.verdict == Verdict::wrong,
                   corner         = hit && passes_through_a_corner(rays[i], found.hit_pixel);
        (wrong ? count.gross : corner ? count.corners : count.slivers)++;
        if (judgement.verdict == Verdict::wrong && first.empty()) first = judgement.reason;
    }
}

constexpr glm::ivec2 quick_sizes[] = {{17, 31},   {127, 131},  {641, 359}, {1920, 1080},
                                      {4099, 33}, {16384, 16}, {3, 8191},  {1, 97}};
constexpr glm::ivec2 long_sizes[]  = {{17, 31},     {641, 359},    {1366, 768}, {1921, 1081}, {3840, 2160},
                                      {7680, 4320}, {16384, 1024}, {16384, 1},  {5, 16383}};

std::vector<glm::ivec2> sizes()
{
    if (long_run()) return {std::begin(long_sizes), std::end(long_sizes)};
    return {std::begin(quick_sizes), std::end(quick_sizes)};
}

/// 100 million rays in the long run, a million otherwise.
size_t rays_per_field() { return (long_run() ? 100'000'000 : 1'000'000) / (sizes().size() * std::size(all_fields)); }

TEST(Campaign, HizEqualsThePixelWalkOnEveryRay)
{
    constexpr size_t                   batch    = 1'000'000;
    const std::vector<ParameterValues> variants = {{},
                                                   {{"pyramid", 1}, {"start_level", 14}, {"top_level", 14}},
                                                   {{"pyramid", 2}, {"start_level", 5}, {"top_level", 3}}};
    size_t                             rays = 0, differ = 0, too_long = 0, stuck = 0;
    for (const glm::ivec2& size : sizes())
        for (const Field field : all_fields) {
            const ssrlab::Setup setup   = make_field(field, size, 1);
            const auto          gbuffer = upload_depth(device(), setup.gbuffer.view, setup.gbuffer.depth);
            for (size_t done = 0; done < rays_per_field(); done += batch) {
                const auto list = random_rays(
                    size, std::min(batch, rays_per_field() - done),
                    static_cast<uint32_t>(7919 * done + 13 * static_cast<size_t>(field) + static_cast<size_t>(size.x)));
                const auto walk = outcomes_of("dda", {}, gbuffer, list);
                // The long run takes one variant a batch, in turn.
                for (size_t v = 0; v < variants.size(); ++v) {
                    if (long_run() && v != (done / batch) % variants.size()) continue;
                    const auto found = outcomes_of("hiz", variants[v], gbuffer, list);
                    const auto start = values_of(technique("hiz"), variants[v]).at("start_level");
                    for (size_t i = 0; i < list.size(); ++i) {
                        const bool same = found[i].status == walk[i].status &&
                                          (walk[i].status != TraceStatus::hit ||
                                           (found[i].hit_pixel == walk[i].hit_pixel && found[i].t == walk[i].t));
                        differ += !same;
                        too_long += found[i].steps > 2.0 * (size.x + size.y - 1) + start;
                        stuck +=
                            found[i].status == TraceStatus::out_of_steps || walk[i].status == TraceStatus::out_of_steps;
                    }
                }
                rays += list.size();
            }
        }
    fmt::print("{} rays: {} differ, {} out of steps, {} beyond 2 (W + H - 1) + start level\n", rays, differ, stuck,
               too_long);
    RecordProperty("rays", static_cast<int>(rays));
    EXPECT_EQ(differ, 0U);
    EXPECT_EQ(stuck, 0U);
    EXPECT_EQ(too_long, 0U);
}

TEST(Campaign, TheWalkFindsWhatIntegersFind)
{
    constexpr size_t batch = 1'000'000;
    Count            count;
    std::string      first;
    for (const glm::ivec2& size : sizes())
        for (const Field field : all_fields) {
            const ssrlab::Setup setup   = make_field(field, size, 2);
            const auto          gbuffer = upload_depth(device(), setup.gbuffer.view, setup.gbuffer.depth);
            for (size_t done = 0; done < rays_per_field(); done += batch) {
                const auto list = random_rays(size, std::min(batch, rays_per_field() - done),
                                              static_cast<uint32_t>(104729 * done + 17 * static_cast<size_t>(field) +
                                                                    static_cast<size_t>(size.y)));
                judge_against_integers(setup, list, outcomes_of("dda", {}, gbuffer, list), count, first);
            }
        }
    fmt::print("{} rays, {} hits: {} in a pixel touched at its corner, {} slivers ({:.1f} a million), {} gross, {} out "
               "of steps\n",
               count.rays, count.hits, count.corners, count.slivers, count.per_million(count.slivers), count.gross,
               count.out_of_steps);
    EXPECT_GT(count.hits, count.rays / 10);
    EXPECT_EQ(count.gross, 0U) << first;
    EXPECT_EQ(count.out_of_steps, 0U);
    EXPECT_LE(count.per_million(count.slivers), 50);
}

} // namespace
} // namespace ssrlab::test
