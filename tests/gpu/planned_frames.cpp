// Skipping passes leaves every bit of the image: the planned against the unculled frame, on every scene.
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

ParameterValues passes_with(const ParameterValues& changed)
{
    ParameterValues passes = default_pass_values();
    for (const auto& [name, value] : changed) passes.at(name) = value;
    return passes;
}

struct Shown {
    std::vector<float>       pixels;
    std::vector<std::string> ran;
};

Shown show(const Picture& picture, const char* id, const ParameterValues& passes)
{
    const TraceSettings settings = boxes({.thickness_m = 0.1, .max_distance_m = 20});
    const auto          frame =
        prepared_frame(picture.buffers, technique(id), values_of(technique(id)), {settings, "plane", passes});
    Shown shown;
    for (const auto& [pass, ms] : run_frame(device(), *frame).passes_ms) shown.ran.push_back(pass);
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

TEST_P(PlannedFrames, AreBitIdenticalToUnculledOnes)
{
    struct Shot {
        glm::ivec2  size_px;
        const char* technique;
        Gloss       gloss;
        const char* gloss_name;
    };
    for (const Shot& shot : {Shot{{161, 91}, "hiz", Gloss::blur, "blur"},
                             {{161, 91}, "hiz", Gloss::stochastic, "stochastic"},
                             {{320, 180}, "linear", Gloss::blur, "blur"},
                             {{320, 180}, "hiz", Gloss::cone, "cone"}}) {
        const Picture picture = make_picture(GetParam(), "default", shot.size_px);
        const Shown   planned = show(picture, shot.technique, passes_with({chosen(shot.gloss)})),
                    all = show(picture, shot.technique, passes_with({chosen(shot.gloss), {"skip_unneeded_passes", 0}}));
        EXPECT_GE(all.ran.size(), planned.ran.size());
        EXPECT_EQ(different(planned.pixels, all.pixels), 0U)
            << "ssrlab plan " << GetParam() << " -t " << shot.technique << " --size " << shot.size_px.x << "x"
            << shot.size_px.y << " -p thickness_m=0.1 -p max_distance_m=20 -p gloss=" << shot.gloss_name;
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

TEST(PlannedFrame, SkipsUnneededPassesUnlessToldNotTo)
{
    const Picture matte  = make_picture("builtin:matte", "default", {161, 91});
    const auto    leaves = [&](const ParameterValues& changed) {
        return skips_work(plan_of(*prepared_frame(matte.buffers, technique("hiz"), values_of(technique("hiz")),
                                                     {{}, "plane", passes_with(changed)})));
    };
    EXPECT_TRUE(leaves({}));
    EXPECT_FALSE(leaves({{"skip_unneeded_passes", 0}}));
    EXPECT_FALSE(leaves({chosen(PassSet::shading)}));
}

TEST(PlannedFrame, WithoutReflectionsOnlyComposites)
{
    const Picture picture = make_picture("builtin:void", "default", {161, 91});
    EXPECT_THAT(show(picture, "hiz", passes_with({})).ran, testing::ElementsAre("composite"));
}

} // namespace
} // namespace ssrlab::test
