// What holds for every technique found on disk, whatever it finds: results are finite, on screen, on the ray, bounded and repeatable.
// Techniques of your own: SSRLAB_TECHNIQUES=FOLDER
#include "core/files.h"
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "truth/screen_truth.h"

namespace ssrlab::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Case {
    std::string scene;
    glm::ivec2  size_px;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene << " " << c.size_px.x << "x" << c.size_px.y; }

std::string case_name(const testing::TestParamInfo<Case>& info)
{
    return fmt::format("{}_{}x{}", info.param.scene.substr(info.param.scene.find(':') + 1), info.param.size_px.x,
                       info.param.size_px.y);
}

std::vector<TraceSettings> settings_for(glm::ivec2 size_px)
{
    std::vector<TraceSettings> list;
    for (const double thickness : {0.1, infinity, 0.0})
        for (const double distance : {9.0, infinity})
            list.push_back(boxes({.thickness_m = thickness, .max_distance_m = distance}));
    if (size_px != glm::ivec2(161, 91)) return {list[0], list[3]};
    list.push_back(boxes({.thickness_m = 0.1, .max_distance_m = 20}, Behind::pass));
    return list;
}

/// The defaults, and each choice and switch by itself.
std::vector<ParameterValues> values_for(const Technique& technique, glm::ivec2 size_px)
{
    std::vector<ParameterValues> list{default_values(technique)};
    if (size_px != glm::ivec2(161, 91)) return list;
    for (const Parameter& parameter : technique.parameters) {
        const int choices = parameter.type == ParameterType::choice    ? static_cast<int>(parameter.choices.size())
                            : parameter.type == ParameterType::boolean ? 2
                                                                       : 0;
        for (int value = 0; value < choices; ++value)
            if (value != parameter.default_value) list.push_back(values_of(technique, {{parameter.name, value}}));
    }
    return list;
}

/// What is wrong with the result at one pixel; empty: nothing.
std::string broken(const Picture& picture, const Technique& technique, const TraceSettings& settings,
                   const TraceImage& result, size_t i, double most_steps)
{
    const glm::ivec2 size  = result.size_px, start(static_cast<int>(i) % size.x, static_cast<int>(i) / size.x),
                     pixel = result.hit_pixel[i];
    if (static_cast<size_t>(result.status[i]) >= trace_status_names.size())
        return fmt::format("status {}", static_cast<int>(result.status[i]));
    if ((result.status[i] != TraceStatus::not_traced) != reflects(picture.image, start))
        return "traced where nothing reflects, or the reverse";
    if (result.steps[i] > most_steps)
        return fmt::format("{} steps, at most {} were declared", result.steps[i], most_steps);
    if (settings.behind != Behind::pass && result.status[i] == TraceStatus::facing_away)
        return "facing_away, but no ray may pass";
    if (!std::isfinite(result.hit_t[i])) return fmt::format("t = {}", result.hit_t[i]);
    if (result.status[i] != TraceStatus::hit) return "";

    const glm::dvec3 point = result.hit_px_depth[i];
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
        return "the hit point is not finite";
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= size.x || pixel.y >= size.y)
        return fmt::format("hit pixel ({}, {}) is off screen", pixel.x, pixel.y);
    if (pixel == start) return "hits its own pixel";
    if (!(result.hit_t[i] > 0 && result.hit_t[i] <= 1)) return fmt::format("t = {}", result.hit_t[i]);
    const double     rounding_px = 5e-7 * std::max({size.x, size.y, 64});
    const glm::dvec2 inside      = glm::dvec2(point) - glm::dvec2(pixel);
    if (std::min(inside.x, inside.y) < -rounding_px || std::max(inside.x, inside.y) > 1 + rounding_px)
        return fmt::format("hit point ({}, {}) is outside its pixel ({}, {})", point.x, point.y, pixel.x, pixel.y);
    const double depth = static_cast<double>(picture.image.depth[pixel_index(pixel, size)]);
    if (depth <= 0) return fmt::format("hits background at ({}, {})", pixel.x, pixel.y);
    if (!technique.exact) return "";
    const double own_depth = static_cast<double>(picture.image.depth[i]),
                 rounding  = 1e-6 * std::max({own_depth, depth, point.z});
    if (point.z > depth + rounding || point.z < slab_back(picture.view, depth, settings) - rounding)
        return fmt::format("depth {} of the hit point is outside the slab [{}, {}]", point.z,
                           slab_back(picture.view, depth, settings), depth);
    return "";
}

void expect_contract(const Case& c, const Picture& picture, const Technique& technique, const ParameterValues& values,
                     const TraceSettings& settings)
{
    const auto        frame  = prepared_frame(picture.buffers, technique, values, {settings});
    const TraceImage  result = counted(*frame), again = counted(*frame);
    const std::string repeat = repeat_command(c.scene, "default", c.size_px, technique, values, settings);
    size_t            wrong  = 0;
    for (size_t i = 0; i < result.status.size(); ++i) {
        const std::string text = broken(picture, technique, settings, result, i, iteration_bound(technique, values));
        if (!text.empty() && wrong++ < 3)
            ADD_FAILURE() << fmt::format("ray of pixel ({}, {}): {}\n{}", pixel_at(i, c.size_px).x,
                                         pixel_at(i, c.size_px).y, text, repeat);
    }
    EXPECT_EQ(wrong, 0U) << repeat;
    std::string first;
    EXPECT_EQ(count_differences(result, again, bit_equal_t, first), 0U) << "the second run differs: " << first << "\n"
                                                                        << repeat;
    EXPECT_TRUE(result.steps == again.steps && result.depth_fetches == again.depth_fetches &&
                result.structure_fetches == again.structure_fetches)
        << "the second run counts other work\n"
        << repeat;
}

/// The defaults under every setting; each other value under one of them in turn.
void expect_contract(const Case& c, std::span<const Technique> techniques)
{
    const Picture                    picture  = make_picture(c.scene, "default", c.size_px);
    const std::vector<TraceSettings> settings = settings_for(c.size_px);
    for (const Technique& t : techniques) {
        const std::vector<ParameterValues> values = values_for(t, c.size_px);
        for (size_t i = 0; i < values.size() + settings.size() - 1; ++i) {
            const ParameterValues& chosen = values[i < settings.size() ? 0 : i - settings.size() + 1];
            if (missing_feature(device(), t, chosen).empty())
                expect_contract(c, picture, t, chosen, settings[i % settings.size()]);
        }
    }
}

/// A budget of a few steps: whoever has more to do says out_of_steps, and nobody finds what needs more.
void expect_budget(const Case& c, std::span<const Technique> techniques)
{
    const Picture       picture  = make_picture(c.scene, "default", c.size_px);
    const TraceSettings settings = boxes({.thickness_m = 0.1, .max_distance_m = infinity});
    for (const Technique& t : techniques) {
        if (std::ranges::find(t.parameters, "max_steps", &Parameter::name) == t.parameters.end()) continue;
        const TraceImage full = trace(picture, t, values_of(t), settings);
        for (const uint32_t most : {1U, 7U}) {
            const ParameterValues values = values_of(t, {{"max_steps", most}});
            const TraceImage      cut    = trace(picture, t, values, settings);
            size_t                wrong  = 0;
            for (size_t i = 0; i < cut.status.size(); ++i)
                wrong += cut.status[i] != (full.steps[i] <= most ? full.status[i] : TraceStatus::out_of_steps) ||
                         cut.steps[i] > most;
            EXPECT_EQ(wrong, 0U) << repeat_command(c.scene, "default", c.size_px, t, values, settings);
        }
    }
}

class EveryTechnique : public testing::TestWithParam<Case> {};

TEST_P(EveryTechnique, HoldsTheContract) { expect_contract(GetParam(), catalogue().techniques); }
TEST_P(EveryTechnique, SaysWhenTheBudgetIsSpent) { expect_budget(GetParam(), catalogue().techniques); }

/// Loops as others published them: their hit rules are their own, and what every answer must be holds for them, too. Not for those with an
/// epsilon, which are fragile on purpose: it carries their hits across a border.
std::vector<Technique> rivals()
{
    const std::filesystem::path folders[]  = {data_root() / "techniques/rivals"};
    std::vector<Technique>      techniques = load_catalogue(folders).techniques;
    std::erase_if(techniques, [](const Technique& t) {
        return t.folder.parent_path().filename() != "rivals" || t.id.starts_with("epsilon_");
    });
    return techniques;
}

TEST(EveryRival, HoldsTheContract) { expect_contract({"builtin:corridor", {161, 91}}, rivals()); }
TEST(EveryRival, SaysWhenTheBudgetIsSpent) { expect_budget({"builtin:pole_field", {161, 91}}, rivals()); }

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    for (const char* scene : {"builtin:pole_field", "builtin:corridor", "builtin:sphere_over_mirror"})
        for (const glm::ivec2& size : {glm::ivec2(1, 1), glm::ivec2(161, 91), glm::ivec2(641, 363)})
            cases.push_back({scene, size});
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryTechnique, testing::ValuesIn(all_cases()), case_name);

} // namespace
} // namespace ssrlab::test
