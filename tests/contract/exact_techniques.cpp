// Techniques that claim to be exact, held to it: the pixel walk's answer on every ray, whatever their parameters.
#include "contract/disputed_rays.h"
#include "gpu/device.h"
#include "scene/scene.h"
#include "truth/screen_truth.h"

#include <algorithm>

namespace ssrlab::test {
namespace {

struct Case {
    std::string scene, view;
    glm::ivec2  size_px;
};

void PrintTo(const Case& c, std::ostream* out)
{
    *out << c.scene << " " << c.view << " " << c.size_px.x << "x" << c.size_px.y;
}

std::string case_name(const testing::TestParamInfo<Case>& info)
{
    std::string name = info.param.scene + "_" + info.param.view + "_" + std::to_string(info.param.size_px.x) + "x" +
                       std::to_string(info.param.size_px.y);
    std::ranges::replace_if(
        name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

constexpr glm::ivec2 sizes[] = {{640, 360}, {641, 363}, {1, 1}, {3, 2}, {97, 1}};
/// Each with its views besides the default one; a level one is among them.
const std::pair<const char*, std::vector<std::string>> real_scenes[] = {
    {"animal_on_metal", {"level", "steep"}}, {"teapot_bunnies", {"level", "close"}},
    {"thin_yard", {"level", "close"}},       {"interior", {"mirror", "low"}},
    {"engine", {"level", "close"}},          {"forest_clearing", {"level", "close"}}};

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    const auto        add = [&](const std::string& scene, const std::vector<std::string>& other_views) {
        for (const glm::ivec2& size : sizes) cases.push_back({scene, "default", size});
        cases.push_back({scene, "default", {1919, 1079}});
        for (const std::string& view : other_views) cases.push_back({scene, view, {641, 363}});
    };
    for (const SceneListing& listing : list_scenes()) {
        if (!listing.name.starts_with("builtin:")) continue;
        std::vector<std::string> other_views;
        for (const Camera& camera : load_scene(listing.name).cameras)
            if (camera.name != "default") other_views.push_back(camera.name);
        add(listing.name, other_views);
    }
    for (const auto& [scene, views] : real_scenes) add(scene, views);
    return cases;
}

/// Every setting of the parameters that may change the way a technique walks, and must not change what it finds.
std::vector<ParameterValues> variants(const Technique& technique, const Case& c)
{
    if (technique.id != "hiz") return {default_values(technique)};
    // Every kind of pyramid at its default levels; every level at the sizes with odd borders, which is where a level may go wrong.
    std::vector<std::pair<int, int>> levels{{0, 7}};
    if (c.size_px == glm::ivec2(641, 363) || c.size_px == glm::ivec2(97, 1))
        levels = {{0, 7}, {0, 0}, {0, 14}, {14, 14}, {5, 3}, {1, 5}};
    std::vector<ParameterValues> list;
    const size_t                 kinds = find_parameter(technique, "pyramid", "test").choices.size();
    for (const auto& [start, top] : levels)
        for (size_t kind = 0; kind < kinds; ++kind)
            list.push_back(values_of(
                technique, {{"pyramid", static_cast<double>(kind)}, {"start_level", start}, {"top_level", top}}));
    return list;
}

/// Against double precision only rays may differ that pass within rounding of a corner or a slab's face; at most 100 of a million. Exact ties
/// count, too, except in the views beside the default one.
void expect_rounding_only(const Picture& picture, const TraceSettings& settings, const TraceResult& truth,
                          const TraceResult& walk)
{
    size_t rays = 0, disputed = 0, missed = 0, ties = 0;
    for (size_t i = 0; i < truth.status.size(); ++i) {
        rays += truth.status[i] != TraceStatus::not_traced;
        const bool both_hit = truth.status[i] == TraceStatus::hit && walk.status[i] == TraceStatus::hit;
        if (truth.status[i] == walk.status[i] && (!both_hit || truth.hit_pixel[i] == walk.hit_pixel[i])) continue;
        const Dispute dispute = explain_dispute(picture.image, settings, truth, walk, i);
        EXPECT_TRUE(dispute.explained()) << dispute.text;
        ++disputed;
        missed += dispute.missed;
        ties += dispute.tie();
    }
    const size_t counted = picture.view.name == "default" ? disputed : disputed - ties;
    EXPECT_LE(static_cast<double>(counted), 1e-4 * static_cast<double>(rays));
    testing::Test::RecordProperty("rays", static_cast<int>(rays));
    testing::Test::RecordProperty("disputed", static_cast<int>(disputed));
    testing::Test::RecordProperty("missed", static_cast<int>(missed));
    if (disputed > 0)
        fmt::print(
            "{} of {} rays differ from double precision by rounding: {} pass exactly through a corner, {} miss\n",
            disputed, rays, ties, missed);
}

class ExactTechniques : public testing::TestWithParam<Case> {};

TEST_P(ExactTechniques, EqualThePixelWalkAndTheScreenTruth)
{
    const Case&         c       = GetParam();
    const Picture       picture = make_picture(c.scene, c.view, c.size_px);
    const TraceSettings settings{.thickness_m = 0.1, .max_distance_m = 1e9};
    const Technique&    dda   = technique("dda");
    const TraceResult   walk  = trace(picture, dda, values_of(dda), settings);
    const TraceResult   truth = screen_truth(picture.image, settings);
    std::string         first;

    for (const Technique& t : list_techniques({})) {
        if (!t.exact || t.id == "dda") continue;
        for (const ParameterValues& values : variants(t, c))
            EXPECT_EQ(count_differences(trace(picture, t, values, settings), walk, true, first), 0U)
                << first << "\n"
                << repeat_command(c.scene, c.view, c.size_px, t, values, settings);
    }
    expect_rounding_only(picture, settings, truth, walk);
    if (c.size_px.x > 700 || !device().info.float64) return;
    EXPECT_EQ(count_differences(trace(picture, dda, values_of(dda), settings, Precision::float64), truth, false, first),
              0U)
        << "double twin: " << first;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactTechniques, testing::ValuesIn(all_cases()), case_name);

} // namespace
} // namespace ssrlab::test
