// The plan as a pure function: what is left out, and the reason with the number that decided.
#include "frame/frame_plan.h"
#include "core/files.h"
#include "gpu/shader.h"
#include "test.h"

namespace ssrlab::test {
namespace {

using testing::HasSubstr;

FrameFacts facts_with_pyramid(bool scene = false)
{
    FrameFacts facts;
    facts.scene      = scene;
    facts.structures = {"depth_pyramid"};
    return facts;
}

const FrameFacts with_pyramid = facts_with_pyramid();

/// 1000 pixels in 20 tiles, of which `reflecting` reflect, `rough` of these with roughness.
FrameStatistics frame(uint32_t reflecting, uint32_t rough, uint32_t hits, uint32_t mirror_hits)
{
    FrameStatistics statistics{
        .pixels = 1000, .tiles = 20, .gbuffer = {}, .trace = {reflecting, hits, mirror_hits}, .misses = {}};
    statistics.gbuffer.surface_pixels      = 900;
    statistics.gbuffer.reflecting_pixels   = reflecting;
    statistics.gbuffer.reflecting_tiles    = (reflecting + 49) / 50;
    statistics.gbuffer.roughness_pixels[0] = reflecting - rough;
    statistics.gbuffer.roughness_pixels[8] = rough;
    return statistics;
}

ParameterValues values_with(const ParameterValues& changed)
{
    ParameterValues values = default_pass_values();
    for (const auto& [name, value] : changed) values.at(name) = value;
    return values;
}

std::set<std::string> running(const std::vector<PlannedPass>& plan)
{
    std::set<std::string> ids;
    for (const PlannedPass& planned : plan)
        if (planned.runs) ids.insert(planned.id);
    return ids;
}

std::string reason(const std::vector<PlannedPass>& plan, const std::string& pass)
{
    return std::ranges::find(plan, pass, &PlannedPass::id)->reason;
}

TEST(Plan, WithoutAnythingThatReflectsNothingIsTraced)
{
    const auto plan = plan_passes(with_pyramid, frame(0, 0, 0, 0), values_with({chosen(Gloss::blur)}));
    EXPECT_EQ(running(plan), std::set<std::string>{"composite"});
    for (const char* pass : {"classification", "rays", "depth_pyramid", "trace", "hit_colour", "blur"})
        EXPECT_EQ(reason(plan, pass), "no pixel reflects") << pass;
}

TEST(Plan, ASmoothPictureInWhichEveryRayHitsNeedsTraceAndShadingAlone)
{
    const auto plan = plan_passes(with_pyramid, frame(400, 0, 400, 0), values_with({chosen(Gloss::blur)}));
    EXPECT_EQ(running(plan),
              (std::set<std::string>{"classification", "rays", "depth_pyramid", "trace", "hit_colour", "composite"}));
    EXPECT_EQ(reason(plan, "trace"), "400 pixels reflect (40 %)");
    EXPECT_EQ(reason(plan, "classification"), "8 of 20 tiles reflect");
    EXPECT_EQ(reason(plan, "blur"), "every reflecting pixel is smooth");
}

TEST(Plan, TheNumberThatDecidedIsInTheReason)
{
    const auto plan = plan_passes(with_pyramid, frame(400, 100, 350, 10), values_with({chosen(Gloss::blur)}));
    EXPECT_TRUE(running(plan).contains("blur"));
    EXPECT_THAT(reason(plan, "blur"), HasSubstr("25 %"));
}

TEST(Plan, GlossIsDoneOneWay)
{
    const auto rough = frame(400, 100, 350, 10), smooth = frame(400, 0, 350, 10);
    const auto cones = plan_passes(with_pyramid, rough, values_with({chosen(Gloss::cone)}));
    EXPECT_TRUE(running(cones).contains("cone_pyramid"));
    EXPECT_FALSE(running(cones).contains("blur"));
    EXPECT_THAT(reason(cones, "cone_pyramid"), HasSubstr("25 %"));
    EXPECT_FALSE(running(plan_passes(with_pyramid, rough, default_pass_values())).contains("cone_pyramid"));
    EXPECT_FALSE(
        running(plan_passes(with_pyramid, smooth, values_with({chosen(Gloss::cone)}))).contains("cone_pyramid"));
}

TEST(Plan, LobesAreDrawnAndReusedWhereAnythingIsRough)
{
    const FrameFacts drawn = facts_with_pyramid(true);
    const auto       plan  = plan_passes(drawn, frame(400, 100, 350, 10), values_with({chosen(Gloss::stochastic)}));
    EXPECT_TRUE(running(plan).contains("ray_reuse"));
    EXPECT_FALSE(running(plan).contains("blur") || running(plan).contains("environment"));
    EXPECT_THAT(reason(plan, "ray_reuse"), HasSubstr("25 %"));
    EXPECT_FALSE(running(plan_passes(drawn, frame(400, 0, 350, 10), values_with({chosen(Gloss::stochastic)})))
                     .contains("ray_reuse"));
}

TEST(Plan, MissedRaysAreFollowedWhereTheyMeetATriangle)
{
    const ParameterValues values  = values_with({chosen(MissLight::triangles)});
    FrameFacts            facts   = facts_with_pyramid(true);
    FrameStatistics       closed  = frame(400, 100, 350, 10);
    const auto            verdict = [&] { return plan_passes(facts, closed, values); };
    EXPECT_THAT(reason(verdict(), "missed_rays"), HasSubstr("triangles are not on the device"));
    facts.world = true;
    EXPECT_THAT(reason(verdict(), "missed_rays"), HasSubstr("no ray missed"));
    closed.misses = {.followed = 12, .met = 0};
    EXPECT_FALSE(running(verdict()).contains("missed_rays"));
    closed.misses.met = 7;
    EXPECT_TRUE(running(verdict()).contains("missed_rays"));
    EXPECT_THAT(reason(verdict(), "missed_rays"), HasSubstr("7 of 12"));
    const ParameterValues environment = values_with({chosen(MissLight::environment)});
    EXPECT_FALSE(running(plan_passes(facts, closed, environment)).contains("missed_rays"));
}

TEST(Plan, RoomsAreFollowedWhereOneOfAThousandRaysMeetsATriangle)
{
    ParameterValues values  = values_with({chosen(MissLight::rooms)});
    FrameFacts      facts   = facts_with_pyramid(true);
    FrameStatistics counts  = frame(400, 100, 350, 10);
    const auto      verdict = [&] { return plan_passes(facts, counts, values); };
    EXPECT_FALSE(running(verdict()).contains("missed_rays"));
    facts.world = true;
    // To follow rays of which few meet something changes the picture: the unculled frame leaves them alone, too.
    for (const double skips : {1.0, 0.0}) {
        values.at("skip_unneeded_passes") = skips;
        counts.misses                     = {.followed = 4000, .met = 3};
        EXPECT_FALSE(running(verdict()).contains("missed_rays"));
        EXPECT_THAT(reason(verdict(), "missed_rays"),
                    HasSubstr("3 of 4000 followed rays meet a triangle, below 0.1 %"));
        counts.misses.met = 4;
        EXPECT_TRUE(running(verdict()).contains("missed_rays"));
    }
}

// S3's order: the blur works on what was traced, and up-sampling comes after it.
TEST(Plan, TheBlurComesBeforeUpsamplingWhereItIsToldTo)
{
    const ParameterValues s3   = {chosen(Gloss::blur), chosen(BlurOrder::before_upsampling),
                                  chosen(TraceResolution::half)};
    const auto            plan = plan_passes({}, frame(400, 100, 350, 10), values_with(s3));
    EXPECT_TRUE(running(plan).contains("ray_blur"));
    EXPECT_FALSE(running(plan).contains("blur"));
    const auto place = [&](const char* id) { return std::ranges::find(plan, id, &PlannedPass::id); };
    EXPECT_LT(place("ray_blur"), place("upsampling"));
    const auto full = plan_passes({}, frame(400, 100, 350, 10),
                                  values_with({chosen(Gloss::blur), chosen(BlurOrder::before_upsampling)}));
    EXPECT_TRUE(running(full).contains("blur") && !running(full).contains("ray_blur"));
}

TEST(Plan, TechniquesWithoutAPyramidBuildNone)
{
    const auto plan = plan_passes({}, frame(400, 0, 400, 0), values_with({{"skip_unneeded_passes", 0}}));
    EXPECT_FALSE(running(plan).contains("depth_pyramid"));
}

// Switched off stays off; not needed runs.
TEST(Plan, WithoutSkippingEveryPassRunsThatIsNotOff)
{
    const auto unculled = running(
        plan_passes(with_pyramid, frame(0, 0, 0, 0), values_with({{"skip_unneeded_passes", 0}, chosen(Gloss::blur)})));
    EXPECT_TRUE(unculled.contains("trace"));
    EXPECT_TRUE(unculled.contains("blur"));
    const auto shading = running(plan_passes(with_pyramid, frame(400, 100, 300, 10),
                                             values_with({{"skip_unneeded_passes", 0}, chosen(PassSet::shading)})));
    EXPECT_EQ(shading,
              (std::set<std::string>{"classification", "rays", "depth_pyramid", "trace", "hit_colour", "composite"}));
}

// A second layer and further bounces continue rays one by one, whether the picture calls for them or not.
TEST(Plan, FurtherRaysNeedOneRayPerPixelAtFullResolution)
{
    const FrameFacts      drawn   = facts_with_pyramid(true);
    const FrameStatistics mirrors = frame(400, 0, 300, 10);
    const auto            plan    = plan_passes(drawn, mirrors, values_with({{"hidden_layer", 1}}));
    EXPECT_EQ(reason(plan, "hidden_layer"), "25 % of 400 rays missed");
    EXPECT_EQ(reason(plan, "bounces"), "3.33 % of 300 hits reflect");
    for (const auto& [name, value] : ParameterValues{{"rays_per_pixel", 2}, chosen(TraceResolution::half)})
        for (const double skips : {0.0, 1.0}) {
            const auto without = plan_passes(
                drawn, mirrors, values_with({{"hidden_layer", 1}, {name, value}, {"skip_unneeded_passes", skips}}));
            for (const char* pass : {"hidden_layer", "bounces"}) {
                EXPECT_FALSE(running(without).contains(pass)) << name;
                EXPECT_EQ(reason(without, pass), "needs one ray per pixel at full resolution") << name;
            }
        }
}

// The filter after a trace without a hit has the second layer's hits to work on.
TEST(Plan, HitsOfTheSecondLayerAreFilteredLikeOthers)
{
    const FrameFacts      drawn{.scene = true, .structures = {}};
    const FrameStatistics misses = frame(400, 0, 0, 0);
    EXPECT_FALSE(running(plan_passes(drawn, misses, values_with({chosen(Filter3x3::box3)}))).contains("filter_3x3"));
    EXPECT_TRUE(running(plan_passes(drawn, misses, values_with({chosen(Filter3x3::box3), {"hidden_layer", 1}})))
                    .contains("filter_3x3"));
}

TEST(Plan, EveryReasonIsThereForEverySetting)
{
    for (const Parameter& parameter : pass_parameters())
        for (const double value : {parameter.min, parameter.max})
            for (const FrameStatistics& statistics : {frame(0, 0, 0, 0), frame(1000, 1000, 0, 0), frame(1, 0, 1, 1)})
                for (const PlannedPass& planned : plan_passes({}, statistics, values_with({{parameter.name, value}})))
                    EXPECT_FALSE(planned.reason.empty()) << planned.id << " with " << parameter.name;
}

TEST(PassList, NamesAreUniqueAndDefaultsInRange)
{
    std::set<std::string> ids, names;
    for (const Pass& pass : all_passes()) {
        EXPECT_TRUE(ids.insert(pass.id).second) << pass.id;
        EXPECT_FALSE(pass.summary.empty()) << pass.id;
    }
    for (const Parameter& parameter : pass_parameters()) {
        EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
        EXPECT_FALSE(parameter.doc.empty()) << parameter.name;
        EXPECT_NO_THROW(check_parameter(parameter, parameter.default_value, "table"));
    }
}

// Each file of the folder is one pass or what several share; shaders that no pass names are left over.
TEST(PassList, EveryShaderOfTheFolderIsNamedByAPass)
{
    std::string sources;
    for (const auto& file : std::filesystem::directory_iterator(data_root() / "framework/frame/passes"))
        sources += read_file(file.path());
    size_t shaders = 0;
    for (const auto& file : std::filesystem::directory_iterator(shader_folder() / "passes")) {
        if (file.path().extension() != ".comp") continue;
        ++shaders;
        const std::string name = "\"passes/" + file.path().filename().string() + "\"";
        EXPECT_NE(sources.find(name), std::string::npos) << name;
    }
    EXPECT_GT(shaders, 0U);
}

TEST(PassChoices, AreEnumsByTheNamesOfTheParameter)
{
    const auto is = [](const std::string& name, size_t count, const std::string& choice, double value) {
        const auto parameter = std::ranges::find(pass_parameters(), name, &Parameter::name);
        ASSERT_NE(parameter, pass_parameters().end()) << name;
        EXPECT_EQ(parameter->choices.size(), count) << name;
        EXPECT_EQ(parse_parameter(*parameter, choice, "here"), value) << name;
    };
    is("gloss", 4, "cone", choice_value(Gloss::cone));
    is("filter_3x3", 3, "median3", choice_value(Filter3x3::median3));
    is("blur_order", 2, "before_upsampling", choice_value(BlurOrder::before_upsampling));
    is("pass_set", 2, "all", choice_value(PassSet::all));
    EXPECT_EQ(choice<Gloss>(default_pass_values()), Gloss::stochastic);
    EXPECT_EQ(choice<BounceMode>(values_with({chosen(BounceMode::history)})), BounceMode::history);
}

} // namespace
} // namespace ssrlab::test
