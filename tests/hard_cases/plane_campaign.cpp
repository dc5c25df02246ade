// Random rays through pictures whose pixels hold planes of random slopes, and solids: every exact walk finds what dda finds, bit for bit, and the judge,
// which knows the contract in double precision, finds nothing wrong with it.
#include "check/judge.h"
#include "core/plane_gradient.h"
#include "gpu/device.h"
#include "hard_cases/random_rays.h"

namespace ssrlab::test {
namespace {

constexpr size_t     batch         = 10'000;
constexpr glm::ivec2 plane_sizes[] = {{257, 193}, {127, 131}, {641, 359}, {3, 1021}, {1, 97}};

/// Gradients from level to as steep as they may be, of either sign, one in twenty pixels without a plane; behind every third pixel a solid.
void add_planes(GBufferImage& image, uint32_t seed)
{
    std::mt19937                          engine(seed);
    std::uniform_real_distribution<float> unit(0, 1), exponent(-14, 0);
    const auto                            slope = [&](float depth) {
        return depth * std::exp2(exponent(engine)) * (unit(engine) < 0.5F ? -1.0F : 1.0F);
    };
    complete_field(image);
    for (const float depth : image.depth) {
        const bool      none = unit(engine) < 0.05F;
        const glm::vec2 gradient(none ? std::numeric_limits<float>::quiet_NaN() : slope(depth), slope(depth));
        image.gradient.push_back(depth > 0 ? unpack_gradient(pack_gradient(gradient)) : glm::vec2(0));
        image.solid_back.push_back(unit(engine) < 0.33F ? depth * unit(engine) : 0);
    }
}

/// Layers behind a picture: other planes at random depths, in every second pixel of the layer before.
void add_layers(GBufferImage& image, int count)
{
    std::mt19937                          engine(99);
    std::uniform_real_distribution<float> unit(0, 1);
    GBufferImage                          layer = image;
    for (int i = 1; i < count; ++i) {
        for (float& depth : layer.depth) depth = unit(engine) < 0.5F ? 0 : depth * (0.3F + 0.699F * unit(engine));
        layer.gradient.clear();
        layer.solid_back.clear();
        add_planes(layer, 100 + static_cast<uint32_t>(i));
        image.layers.push_back(layer);
    }
}

struct Count {
    size_t rays = 0, hits = 0, stops = 0, behind = 0, differ = 0, judged = 0, wrong = 0, near_ties = 0;
};

bool same_bits(const RayOutcome& a, const RayOutcome& b)
{
    return a.status == b.status &&
           (!has_place(a.status) || (a.hit_pixel == b.hit_pixel && a.hit_layer == b.hit_layer && a.t == b.t));
}

class PlaneCampaign : public testing::TestWithParam<glm::ivec2> {};

/// One field of pixels under one model and one rule.
class PlaneField {
public:
    PlaneField(Field field, glm::ivec2 size_px, const std::string& surface, Behind behind, int layers)
        : setup_(make_field(field, size_px, 1))
    {
        setup_.settings         = campaign_settings;
        setup_.settings.surface = surface;
        setup_.settings.behind  = behind;
        setup_.settings.layers  = layers;
        add_planes(setup_.gbuffer, 77);
        add_layers(setup_.gbuffer, layers);
        gbuffer_ = upload_gbuffer(device(), setup_.gbuffer);
        for (const double exact : {0.0, 1.0})
            if (exact == 0 || missing_for_exact().empty())
                for (const char* id : {"dda", "hiz", "quadtree"}) tracers_[exact > 0].push_back(make(id, exact));
        for (const char* id : {"hiz_packets", "hiz_waves"}) tracers_[0].push_back(make(id, std::nullopt));
    }

    void run(const std::vector<RayInput>& rays, bool judged, Count& count, std::string& first)
    {
        for (const auto& tracers : tracers_) {
            if (tracers.empty()) continue;
            const auto walk = trace_rays(device(), *tracers[0], rays);
            for (size_t i = 1; i < tracers.size(); ++i) {
                const auto found = trace_rays(device(), *tracers[i], rays);
                for (size_t ray = 0; ray < rays.size(); ++ray) count.differ += !same_bits(found[ray], walk[ray]);
            }
            if (&tracers != &tracers_[0]) continue;
            count.rays += rays.size();
            for (const RayOutcome& found : walk) {
                count.hits += found.status == TraceStatus::hit;
                count.stops += found.status == TraceStatus::stopped;
                count.behind += found.hit_layer > 0;
            }
            if (judged) judge(rays, walk, count, first);
        }
    }

private:
    TracerPtr make(const std::string& id, std::optional<double> exact)
    {
        ParameterValues values = default_values(technique(id));
        if (exact) values["arithmetic"] = *exact;
        return tracer_on(gbuffer_, technique(id), values, setup_.settings, batch);
    }

    void judge(const std::vector<RayInput>& rays, const std::vector<RayOutcome>& walk, Count& count, std::string& first)
    {
        const Judge judge(setup_);
        for (size_t i = 0; i < rays.size(); ++i) {
            const Judgement judgement = judge.judge(rays[i], walk[i], {});
            ++count.judged;
            count.near_ties += judgement.verdict == Verdict::sliver;
            if (judgement.verdict != Verdict::wrong) continue;
            ++count.wrong;
            if (first.empty()) first = judgement.reason;
        }
    }

    ssrlab::Setup          setup_;
    GBufferPtr             gbuffer_;
    std::vector<TracerPtr> tracers_[2]; // in float, and with arithmetic = exact
};

TEST_P(PlaneCampaign, RandomPlanesAndSolids)
{
    struct Model {
        std::string surface;
        Behind      behind;
        int         layers = 1;
    };
    const Model  models[] = {{"plane", Behind::hit},           {"plane", Behind::pass},  {"plane_solid", Behind::stop},
                             {"plane_solid", Behind::stop, 2}, {"box", Behind::pass, 2}, {"plane", Behind::hit, 4},
                             {"plane_infinite", Behind::stop}};
    const size_t rays = planned_rays(400'000) / (std::size(plane_sizes) * std::size(all_fields) * std::size(models));
    Count        count;
    std::string  first;
    for (const Field field : all_fields)
        for (const auto& [surface, behind, layers] : models) {
            PlaneField tested(field, GetParam(), surface, behind, layers);
            for (size_t done = 0; done < rays; done += batch) {
                const auto seed = static_cast<uint32_t>(done / batch + 31 * static_cast<size_t>(field));
                tested.run(random_rays(GetParam(), std::min(batch, rays - done), seed), done == 0, count, first);
            }
        }
    fmt::print("| image | rays | hits | stopped | behind the first layer | differ | judged | wrong | near ties |\n"
               "| {} × {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
               GetParam().x, GetParam().y, count.rays, count.hits, count.stops, count.behind, count.differ,
               count.judged, count.wrong, count.near_ties);
    EXPECT_GT(count.hits, count.rays / 100);
    EXPECT_GT(count.stops, count.rays / 1000);
    EXPECT_GT(count.behind, count.rays / 1000);
    EXPECT_EQ(count.differ, 0U);
    EXPECT_EQ(count.wrong, 0U) << first;
    EXPECT_LE(count.near_ties, count.judged / 1000);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PlaneCampaign, testing::ValuesIn(plane_sizes),
                         [](const testing::TestParamInfo<glm::ivec2>& size) {
                             return fmt::format("{}x{}", size.param.x, size.param.y);
                         });

} // namespace
} // namespace ssrlab::test
