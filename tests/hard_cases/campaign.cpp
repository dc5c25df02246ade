// Exact techniques in a random campaign: hiz finds what dda finds, bit for bit, and both find what integers find.
#include "check/judge.h"
#include "core/parallel_rows.h"
#include "gpu/device.h"
#include "hard_cases/integer_oracle.h"
#include "hard_cases/random_rays.h"

namespace ssrlab::test {
namespace {

/// A million rays over all sizes in every run, a hundred million in the long one. There the integers judge one batch in `judged_every`.
struct Plan {
    size_t                  rays, batch, judged_every;
    std::vector<glm::ivec2> sizes;
};

Plan plan()
{
    constexpr size_t short_run = 1'000'000;
    const size_t     rays      = planned_rays(short_run);
    if (rays <= short_run)
        return {rays,
                31'250,
                1,
                {{17, 31}, {127, 131}, {641, 359}, {1920, 1080}, {4099, 33}, {16384, 16}, {3, 8191}, {1, 97}}};
    return {rays,
            250'000,
            25,
            {{17, 31}, {641, 359}, {1366, 768}, {1921, 1081}, {3840, 2160}, {16384, 1024}, {16384, 1}, {5, 16383}}};
}

struct Count {
    size_t rays = 0, hits = 0;
    size_t differ = 0, differ_exact = 0, too_long = 0, stuck = 0; // hiz against dda, float and exact
    size_t judged = 0, corners = 0, slivers = 0, gross = 0;       // dda against integers
    size_t exact_wrong = 0;                                       // dda with arithmetic = exact against integers
    double slivers_per_million() const { return 1e6 * static_cast<double>(slivers) / static_cast<double>(judged); }

    void add(const Count& other)
    {
        for (size_t Count::*n :
             {&Count::rays, &Count::hits, &Count::differ, &Count::differ_exact, &Count::too_long, &Count::stuck,
              &Count::judged, &Count::corners, &Count::slivers, &Count::gross, &Count::exact_wrong})
            this->*n += other.*n;
    }
};

std::string table_row(const std::string& name, const Count& c)
{
    return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, c.rays, c.hits,
                       c.differ, c.differ_exact, c.stuck, c.too_long, c.judged, c.gross, c.slivers, c.corners,
                       c.exact_wrong);
}

constexpr const char* table_head =
    "| image | rays | hits | differ | the same, exact | out of steps | beyond the bound | judged by "
    "integers | gross | slivers | touch at a corner | exact: wrong |\n";

using Outcomes = std::vector<RayOutcome>;

bool same_bits(const RayOutcome& a, const RayOutcome& b)
{
    return a.status == b.status && (a.status != TraceStatus::hit || (a.hit_pixel == b.hit_pixel && a.t == b.t));
}

/// One picture and the tracers on it: dda and some ways to run hiz, each in float and in whole numbers.
class FieldTracers {
public:
    FieldTracers(const ssrlab::Setup& field, size_t batch)
        : gbuffer_(upload_depth(device(), field.gbuffer.view, field.gbuffer.depth)), batch_(batch),
          bound_(2.0 * (field.gbuffer.view.size_px.x + field.gbuffer.view.size_px.y - 1))
    {
        for (const double exact : {0.0, 1.0}) {
            if (exact != 0 && !missing_for_exact().empty()) continue;
            walks_.push_back(make("dda", {{"arithmetic", exact}}));
            for (const Variant& variant : hiz_variants) {
                if (exact != 0 && variant.id.starts_with("hiz_")) continue; // packets know float alone
                ParameterValues values = variant.values;
                if (exact != 0) values["arithmetic"] = exact;
                (exact == 0 ? hiz_float_ : hiz_exact_).push_back(make(variant.id, values));
            }
        }
    }

    /// None in whole numbers on a device that does not know them.
    Outcomes walk(bool exact, const std::vector<RayInput>& rays)
    {
        return exact < walks_.size() ? trace_rays(device(), *walks_[exact], rays) : Outcomes{};
    }

    /// Rays on which hiz in one of its ways differs from the walk; also counts broken bounds.
    size_t differing(bool exact, size_t variant, const std::vector<RayInput>& rays, const Outcomes& walk, Count& count)
    {
        const auto   found = trace_rays(device(), *(exact ? hiz_exact_ : hiz_float_)[variant], rays);
        const double start =
            values_of(technique(hiz_variants[variant].id), hiz_variants[variant].values).at("start_level");
        size_t differ = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            differ += !same_bits(found[i], walk[i]);
            count.too_long += found[i].steps > bound_ + start;
            count.stuck += found[i].status == TraceStatus::out_of_steps || walk[i].status == TraceStatus::out_of_steps;
        }
        return differ;
    }

    size_t variants(bool exact) const { return (exact ? hiz_exact_ : hiz_float_).size(); }

private:
    TracerPtr make(const std::string& id, const ParameterValues& changed)
    {
        return tracer_on(gbuffer_, technique(id), values_of(technique(id), changed), campaign_settings, batch_);
    }

    struct Variant {
        std::string     id;
        ParameterValues values;
    };
    /// Those that run in whole numbers, too, first.
    static inline const std::vector<Variant> hiz_variants = {
        {"hiz", {}},
        {"hiz", {{"depth_pyramid.kind", 1}, {"start_level", 14}, {"depth_pyramid.top_level", 14}}},
        {"hiz", {{"depth_pyramid.kind", 2}, {"start_level", 5}, {"depth_pyramid.top_level", 3}}},
        {"quadtree", {}},
        {"quadtree",
         {{"plane_quadtree.bins", 0}, {"start_level", 14}, {"climb", 14}, {"plane_quadtree.top_level", 14}}},
        {"quadtree", {{"plane_quadtree.planes", 1}, {"start_level", 5}, {"climb", 1}, {"plane_quadtree.top_level", 3}}},
        {"hiz_packets", {}},
        {"hiz_packets", {{"depth_pyramid.kind", 1}, {"start_level", 14}, {"depth_pyramid.top_level", 14}}},
        {"hiz_packets", {{"depth_pyramid.kind", 2}, {"start_level", 5}, {"depth_pyramid.top_level", 3}}},
        {"hiz_waves", {}}};

    GBufferPtr             gbuffer_;
    size_t                 batch_;
    double                 bound_;
    std::vector<TracerPtr> walks_, hiz_float_, hiz_exact_;
};

/// Compares with the oracle; a difference of the float walk is a sliver or gross as check/judge.h says, one of the exact walk is wrong.
void judge_by_integers(const ssrlab::Setup& field, const std::vector<RayInput>& rays, const Outcomes& walk,
                       const Outcomes& exact_walk, Count& count, std::string& first)
{
    const Judge      judge(field);
    std::mutex       mutex;
    constexpr size_t chunk  = 1000;
    const auto       chunks = static_cast<int>((rays.size() + chunk - 1) / chunk);
    parallel_rows(chunks, 0, [&](int number) {
        Count        local;
        std::string  wrong;
        const size_t from = static_cast<size_t>(number) * chunk;
        for (size_t i = from; i < std::min(rays.size(), from + chunk); ++i) {
            const OracleAnswer truth = integer_oracle(field.gbuffer, rays[i]);
            const auto         right = [&](const RayOutcome& found) {
                const bool hit = found.status == TraceStatus::hit;
                return hit == truth.hit && (!hit || found.hit_pixel == truth.pixel);
            };
            ++local.judged;
            local.hits += truth.hit;
            if (!exact_walk.empty() && !right(exact_walk[i])) {
                ++local.exact_wrong;
                wrong = fmt::format("exact arithmetic: ray from ({}, {}, {}) by ({}, {}, {})",
                                    rays[i].origin_px_depth.x, rays[i].origin_px_depth.y, rays[i].origin_px_depth.z,
                                    rays[i].delta_px_depth.x, rays[i].delta_px_depth.y, rays[i].delta_px_depth.z);
            }
            if (right(walk[i])) continue;
            // Where double precision sides with float and the integers with neither, the judge says "right": a sliver all the same.
            const Judgement judgement = judge.judge(rays[i], walk[i], {});
            const bool      gross     = judgement.verdict == Verdict::wrong,
                       corner =
                           walk[i].status == TraceStatus::hit && passes_through_a_corner(rays[i], walk[i].hit_pixel);
            (gross ? local.gross : corner ? local.corners : local.slivers)++;
            if (gross) wrong = judgement.reason;
        }
        const std::lock_guard lock(mutex);
        count.add(local);
        if (first.empty()) first = wrong;
    });
}

Count campaign_on(Field field, glm::ivec2 size, const Plan& plan, size_t rays, std::string& first)
{
    const ssrlab::Setup setup = make_field(field, size, 1);
    FieldTracers        tracers(setup, plan.batch);
    Count               count;
    for (size_t number = 0; count.rays < rays; ++number) {
        const auto seed  = static_cast<uint32_t>(7919 * number + 13 * static_cast<size_t>(field) +
                                                104729 * static_cast<size_t>(size.x));
        const auto list  = random_rays(size, std::min(plan.batch, rays - count.rays), seed);
        const auto walk  = tracers.walk(false, list);
        const bool judge = number % plan.judged_every == 0;
        // Every way to run hiz where the integers judge, else one of them in turn.
        for (size_t v = 0; v < tracers.variants(false); ++v)
            if (judge || v == number % tracers.variants(false))
                count.differ += tracers.differing(false, v, list, walk, count);
        count.rays += list.size();
        if (!judge) continue;
        const auto exact_walk = tracers.walk(true, list);
        for (size_t v = 0; v < tracers.variants(true); ++v)
            count.differ_exact += tracers.differing(true, v, list, exact_walk, count);
        judge_by_integers(setup, list, walk, exact_walk, count, first);
    }
    return count;
}

class Campaign : public testing::TestWithParam<glm::ivec2> {};

TEST_P(Campaign, RandomRaysOfAllClasses)
{
    const Plan       all  = plan();
    const glm::ivec2 size = GetParam();
    const size_t     rays = all.rays / (all.sizes.size() * std::size(all_fields));
    Count            count;
    std::string      first;
    for (const Field field : all_fields) count.add(campaign_on(field, size, all, rays, first));
    fmt::print("{}{}", table_head, table_row(fmt::format("{} × {}", size.x, size.y), count));
    EXPECT_EQ(count.rays, rays * std::size(all_fields));
    EXPECT_GT(count.hits, count.judged / 100);
    EXPECT_EQ(count.differ, 0U);
    EXPECT_EQ(count.differ_exact, 0U);
    EXPECT_EQ(count.stuck, 0U);
    EXPECT_EQ(count.too_long, 0U);
    EXPECT_EQ(count.gross, 0U) << first;
    EXPECT_LE(count.slivers_per_million(), 50);
    EXPECT_EQ(count.exact_wrong, 0U) << first;
}

INSTANTIATE_TEST_SUITE_P(Sizes, Campaign, testing::ValuesIn(plan().sizes),
                         [](const testing::TestParamInfo<glm::ivec2>& size) {
                             return fmt::format("{}x{}", size.param.x, size.param.y);
                         });

} // namespace
} // namespace ssrlab::test
