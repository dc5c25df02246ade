// Techniques that claim to be exact, held to it: the pixel walk's answer on every ray, whatever their parameters.
#include "core/error.h"
#include "gpu/device.h"
#include "truth/screen_truth.h"

#include <fmt/ranges.h>

#include <algorithm>

namespace ssrlab::test {
namespace {

struct Case {
    std::string scene, view;
    glm::ivec2  size_px;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene << " " << c.view << " " << c.size_px.x << "x" << c.size_px.y; }

std::string case_name(const testing::TestParamInfo<Case>& info)
{
    std::string name = info.param.scene + "_" + info.param.view + "_" + std::to_string(info.param.size_px.x) + "x" + std::to_string(info.param.size_px.y);
    std::ranges::replace_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
    return name;
}

constexpr glm::ivec2 sizes[] = {{640, 360}, {641, 363}, {1, 1}, {3, 2}, {97, 1}};
const char* const    built_in_scenes[] = {"builtin:mirror_floor_wall", "builtin:sphere_over_mirror", "builtin:pole_field",
                                          "builtin:stairs",            "builtin:corridor",           "builtin:void"};
const char* const    real_scenes[]     = {"animal_on_metal", "teapot_bunnies", "thin_yard", "interior", "engine"};

std::vector<Case> all_cases()
{
    std::vector<Case> cases;
    for (const char* scene : built_in_scenes) {
        for (const Camera& camera : load_scene(scene).cameras)
            for (const glm::ivec2& size : sizes) cases.push_back({scene, camera.name, size});
        cases.push_back({scene, "default", {1919, 1079}});
    }
    for (const char* scene : real_scenes) {
        for (const glm::ivec2& size : sizes) cases.push_back({scene, "default", size});
        cases.push_back({scene, "level", {641, 363}});
        cases.push_back({scene, "default", {1919, 1079}});
    }
    return cases;
}

/// Every setting of the parameters that may change the way a technique walks, and must not change what it finds.
std::vector<ParameterValues> variants(const Technique& technique, glm::ivec2 size_px)
{
    std::vector<ParameterValues> list{default_values(technique)};
    if (technique.id != "hiz") return list;
    list.push_back(values_of(technique, {{"pyramid", 1}}));
    if (size_px.x * size_px.y > 700 * 400) return list; // the larger sizes: both pyramids at their defaults
    for (const auto& [start, top] : {std::pair(0, 0), std::pair(0, 14), std::pair(14, 14), std::pair(5, 3), std::pair(1, 5)})
        for (const double pyramid : {0.0, 1.0}) list.push_back(values_of(technique, {{"pyramid", pyramid}, {"start_level", start}, {"top_level", top}}));
    return list;
}

class ExactTechniques : public testing::TestWithParam<Case> {};

TEST_P(ExactTechniques, EqualThePixelWalkAndTheScreenTruth)
{
    const Case&         c = GetParam();
    const Picture       picture = make_picture(c.scene, c.view, c.size_px);
    const TraceSettings settings{.thickness_m = 0.1, .max_distance_m = 1e9};
    const TraceResult   walk  = trace(picture, technique("dda"), values_of(technique("dda")), settings);
    const TraceResult   truth = screen_truth(picture.image, settings);
    std::string         first;

    for (const Technique& t : list_techniques({})) {
        if (!t.exact) continue;
        for (const ParameterValues& values : variants(t, c.size_px)) {
            EXPECT_EQ(count_differences(trace(picture, t, values, settings), walk, true, first), 0)
                << first << "\n" << repeat_command(c.scene, c.view, c.size_px, t, values, settings);
        }
    }

    // Against double precision: only rays that pass within rounding of a corner or a slab's face may differ, at most 100 of a million.
    const size_t rays = static_cast<size_t>(std::ranges::count_if(truth.status, [](TraceStatus s) { return s != TraceStatus::not_traced; }));
    EXPECT_LE(count_differences(walk, truth, false, first), static_cast<size_t>(1e-4 * static_cast<double>(rays))) << first;
    const TraceResult twin = trace(picture, technique("dda"), values_of(technique("dda")), settings, Precision::float64);
    EXPECT_EQ(count_differences(twin, truth, false, first), 0) << "double twin: " << first;
    RecordProperty("rays", static_cast<int>(rays));
    fmt::print("{} {} {}x{}: {} rays, {} float rays differ from the screen truth\n", c.scene, c.view, c.size_px.x, c.size_px.y, rays,
               count_differences(walk, truth, false, first));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactTechniques, testing::ValuesIn(all_cases()), case_name);

} // namespace
} // namespace ssrlab::test
