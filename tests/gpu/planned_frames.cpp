// Leaving out what a picture does not need leaves every bit of it: planned against everything on, on every scene.
#include "gpu/device.h"

#include <gmock/gmock.h>

namespace ssrlab::test {
namespace {

ParameterValues effects_with(const ParameterValues& changed)
{
    ParameterValues effects = default_effect_values();
    for (const auto& [name, value] : changed) effects.at(name) = value;
    return effects;
}

struct Shown {
    std::vector<float>       pixels;
    std::vector<std::string> ran;
};

Shown show(const Picture& picture, const char* id, const ParameterValues& effects)
{
    const TraceSettings settings{.thickness_m = 0.1, .max_distance_m = 20};
    const auto          frame =
        prepare_frame(device(), picture.buffers, technique(id), values_of(technique(id)), {settings, effects});
    Shown shown;
    for (const auto& [effect, ms] : run_frame(device(), *frame).effects_ms) shown.ran.push_back(effect);
    shown.pixels = read_shaded(device(), *frame).values;
    return shown;
}

size_t different(const std::vector<float>& a, const std::vector<float>& b)
{
    size_t count = a.size() == b.size() ? 0 : a.size();
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += a[i] != b[i];
    return count;
}

class PlannedFrames : public testing::TestWithParam<std::string> {};

TEST_P(PlannedFrames, AreThoseWithEverythingOn)
{
    for (const glm::ivec2& size_px : {glm::ivec2(161, 91), glm::ivec2(320, 180)}) {
        const Picture picture = make_picture(GetParam(), "default", size_px);
        for (const auto& [id, gloss] : {std::pair("hiz", 1), std::pair("linear", 1), std::pair("hiz", 2)}) {
            const Shown planned = show(picture, id, effects_with({{"gloss", gloss}})),
                        all     = show(picture, id, effects_with({{"gloss", gloss}, {"plan", 0}}));
            EXPECT_GE(all.ran.size(), planned.ran.size());
            EXPECT_EQ(different(planned.pixels, all.pixels), 0U)
                << "ssrlab plan " << GetParam() << " -t " << id << " --size " << size_px.x << "x" << size_px.y
                << " -p thickness_m=0.1 -p max_distance_m=20 -p gloss=" << (gloss == 2 ? "cone" : "blur");
        }
    }
}

std::vector<std::string> all_scenes()
{
    std::vector<std::string> names;
    for (const SceneListing& scene : list_scenes()) names.push_back(scene.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, PlannedFrames, testing::ValuesIn(all_scenes()), [](const auto& param) {
    std::string name = param.param;
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
});

TEST(PlannedFrame, LeavesOutWhatThePictureDoesNotNeedUnlessToldOtherwise)
{
    const Picture matte  = make_picture("builtin:matte", "default", {161, 91});
    const auto    leaves = [&](const ParameterValues& changed) {
        return plan_leaves_out(*prepare_frame(device(), matte.buffers, technique("hiz"), values_of(technique("hiz")),
                                                 {{}, effects_with(changed)}));
    };
    EXPECT_TRUE(leaves({}));
    EXPECT_FALSE(leaves({{"plan", 0}}));
    EXPECT_FALSE(leaves({{"effect_set", 1}}));
}

TEST(PlannedFrame, OfNothingThatReflectsOnlyPutsThePictureTogether)
{
    const Picture picture = make_picture("builtin:void", "default", {161, 91});
    EXPECT_THAT(show(picture, "hiz", effects_with({})).ran, testing::ElementsAre("composite"));
}

} // namespace
} // namespace ssrlab::test
