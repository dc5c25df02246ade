// The plan as a pure function: what is left out, and the reason with the number that decided.
#include "gpu/shader.h"
#include "render/effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace ssrlab::test {
namespace {

using testing::HasSubstr;

const FrameFacts with_pyramid{.structures = {"depth_pyramid"}};

/// 1000 pixels in 20 tiles, of which `reflecting` reflect, `rough` of these with roughness.
FrameStatistics picture(uint32_t reflecting, uint32_t rough, uint32_t hits, uint32_t mirror_hits)
{
    FrameStatistics statistics{.pixels = 1000, .tiles = 20, .picture = {}, .trace = {reflecting, hits, mirror_hits}};
    statistics.picture.surface_pixels      = 900;
    statistics.picture.reflecting_pixels   = reflecting;
    statistics.picture.reflecting_tiles    = (reflecting + 49) / 50;
    statistics.picture.roughness_pixels[0] = reflecting - rough;
    statistics.picture.roughness_pixels[8] = rough;
    return statistics;
}

ParameterValues values_with(const ParameterValues& changed)
{
    ParameterValues values = default_effect_values();
    for (const auto& [name, value] : changed) values.at(name) = value;
    return values;
}

std::set<std::string> running(const std::vector<PlannedEffect>& plan)
{
    std::set<std::string> ids;
    for (const PlannedEffect& planned : plan)
        if (planned.runs) ids.insert(planned.effect->id);
    return ids;
}

std::string reason(const std::vector<PlannedEffect>& plan, const std::string& effect)
{
    return std::ranges::find(plan, effect, [](const PlannedEffect& p) { return p.effect->id; })->reason;
}

TEST(Plan, WithoutAnythingThatReflectsNothingIsTraced)
{
    const auto plan = plan_frame(with_pyramid, picture(0, 0, 0, 0), default_effect_values());
    EXPECT_EQ(running(plan), std::set<std::string>{"composite"});
    for (const char* effect : {"classification", "rays", "structures", "trace", "hit_colour", "blur"})
        EXPECT_EQ(reason(plan, effect), "no pixel reflects") << effect;
}

TEST(Plan, ASmoothPictureInWhichEveryRayHitsNeedsTraceAndShadingAlone)
{
    const auto plan = plan_frame(with_pyramid, picture(400, 0, 400, 0), default_effect_values());
    EXPECT_EQ(running(plan),
              (std::set<std::string>{"classification", "rays", "structures", "trace", "hit_colour", "composite"}));
    EXPECT_EQ(reason(plan, "trace"), "400 pixels reflect (40 %)");
    EXPECT_EQ(reason(plan, "classification"), "8 of 20 tiles reflect");
    EXPECT_EQ(reason(plan, "blur"), "every pixel that reflects is smooth");
}

TEST(Plan, TheNumberThatDecidedIsInTheReason)
{
    const auto plan = plan_frame(with_pyramid, picture(400, 100, 350, 10), default_effect_values());
    EXPECT_TRUE(running(plan).contains("blur"));
    EXPECT_THAT(reason(plan, "blur"), HasSubstr("25 %"));
}

TEST(Plan, GlossIsDoneOneWay)
{
    const auto rough = picture(400, 100, 350, 10), smooth = picture(400, 0, 350, 10);
    const auto cones = plan_frame(with_pyramid, rough, values_with({{"gloss", 2}}));
    EXPECT_TRUE(running(cones).contains("cone_pyramid"));
    EXPECT_FALSE(running(cones).contains("blur"));
    EXPECT_THAT(reason(cones, "cone_pyramid"), HasSubstr("25 %"));
    EXPECT_FALSE(running(plan_frame(with_pyramid, rough, default_effect_values())).contains("cone_pyramid"));
    EXPECT_FALSE(running(plan_frame(with_pyramid, smooth, values_with({{"gloss", 2}}))).contains("cone_pyramid"));
}

TEST(Plan, TechniquesWithoutAPyramidBuildNone)
{
    const auto plan = plan_frame({}, picture(400, 0, 400, 0), values_with({{"plan", 0}}));
    EXPECT_FALSE(running(plan).contains("depth_pyramid"));
}

// Switched off stays off; not needed runs.
TEST(Plan, WithoutThePlanEverythingRunsThatIsNotSwitchedOff)
{
    const auto everything = running(plan_frame(with_pyramid, picture(0, 0, 0, 0), values_with({{"plan", 0}})));
    EXPECT_TRUE(everything.contains("trace"));
    EXPECT_TRUE(everything.contains("blur"));
    const auto shading =
        running(plan_frame(with_pyramid, picture(400, 100, 300, 10), values_with({{"plan", 0}, {"effect_set", 1}})));
    EXPECT_EQ(shading,
              (std::set<std::string>{"classification", "rays", "structures", "trace", "hit_colour", "composite"}));
}

// A second layer and further bounces continue rays one by one, whether the picture calls for them or not.
TEST(Plan, FurtherRaysNeedOneRayPerPixelAtFullResolution)
{
    const FrameFacts      drawn{.scene = true, .structures = {"depth_pyramid"}};
    const FrameStatistics mirrors = picture(400, 0, 300, 10);
    const auto            plan    = plan_frame(drawn, mirrors, values_with({{"hidden_layer", 1}}));
    EXPECT_EQ(reason(plan, "hidden_layer"), "25 % of 400 rays found nothing");
    EXPECT_EQ(reason(plan, "bounces"), "3.33 % of 300 hits reflect");
    for (const auto& [name, value] : ParameterValues{{"rays_per_pixel", 2}, {"trace_resolution", 1}})
        for (const double planned : {0.0, 1.0}) {
            const auto without =
                plan_frame(drawn, mirrors, values_with({{"hidden_layer", 1}, {name, value}, {"plan", planned}}));
            for (const char* effect : {"hidden_layer", "bounces"}) {
                EXPECT_FALSE(running(without).contains(effect)) << name;
                EXPECT_EQ(reason(without, effect), "needs one ray per pixel at full resolution") << name;
            }
        }
}

// The filter after a trace without a hit has the second layer's hits to work on.
TEST(Plan, HitsOfTheSecondLayerAreFilteredLikeOthers)
{
    const FrameFacts      drawn{.scene = true, .structures = {}};
    const FrameStatistics misses = picture(400, 0, 0, 0);
    EXPECT_FALSE(running(plan_frame(drawn, misses, values_with({{"kernel", 1}}))).contains("kernel_filter"));
    EXPECT_TRUE(running(plan_frame(drawn, misses, values_with({{"kernel", 1}, {"hidden_layer", 1}})))
                    .contains("kernel_filter"));
}

TEST(Plan, EveryReasonIsThereForEverySetting)
{
    for (const Parameter& parameter : effect_parameters())
        for (const double value : {parameter.min, parameter.max})
            for (const FrameStatistics& statistics :
                 {picture(0, 0, 0, 0), picture(1000, 1000, 0, 0), picture(1, 0, 1, 1)})
                for (const PlannedEffect& planned : plan_frame({}, statistics, values_with({{parameter.name, value}})))
                    EXPECT_FALSE(planned.reason.empty()) << planned.effect->id << " with " << parameter.name;
}

TEST(EffectTable, NamesAreUniqueAndDefaultsInRange)
{
    std::set<std::string> ids, names;
    for (const Effect& effect : all_effects()) {
        EXPECT_TRUE(ids.insert(effect.id).second) << effect.id;
        EXPECT_FALSE(effect.summary.empty()) << effect.id;
    }
    for (const Parameter& parameter : effect_parameters()) {
        EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
        EXPECT_FALSE(parameter.doc.empty()) << parameter.name;
        EXPECT_NO_THROW(check_parameter(parameter, parameter.default_value, "table"));
    }
}

// Every shader file of a row exists, and no shader of the folder is left over.
TEST(EffectTable, ShadersOfTheEffectsFolderAreAllInTheTable)
{
    // Further passes of a row, and the count that plans rest on.
    std::set<std::string> used{"passes/second_layer_hits.comp", "passes/bounce_colour.comp",
                               "passes/bounce_history.comp", "trace/trace_statistics.comp"};
    for (const Effect& effect : all_effects()) {
        EXPECT_TRUE(std::filesystem::exists(shader_folder() / effect.shader)) << effect.shader;
        used.insert(effect.shader);
    }
    for (const auto& file : std::filesystem::directory_iterator(shader_folder() / "passes")) {
        const std::string name = "passes/" + file.path().filename().string();
        if (file.path().extension() != ".comp") continue;
        EXPECT_TRUE(used.contains(name)) << name;
    }
}

} // namespace
} // namespace ssrlab::test
