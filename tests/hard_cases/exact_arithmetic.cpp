// arithmetic = exact beyond the campaign: on every hard case, and on a device that cannot.
#include "check/run_check.h"
#include "core/pixel_index.h"
#include "gpu/device.h"
#include "scene/scene.h"
#include "trace/lab.h"

namespace ssrlab::test {
namespace {

TEST(ExactArithmetic, HoldsOnEveryHardCase)
{
    if (const std::string missing = missing_for_exact(); !missing.empty()) GTEST_SKIP() << missing;
    for (const std::string id : {"dda", "hiz", "quadtree"})
        for (const CaseFamily& family : hard_cases())
            for (const HardCase& hard_case : family.cases) {
                const CaseRow row =
                    run_case(device(), catalogue(), technique(id), values_of(technique(id), {{"arithmetic", 1}}),
                             family.name, hard_case, {.double_precision = false});
                EXPECT_EQ(row.wrong, 0U) << hard_case.name;
                // At twice the resolution ends lie on a finer grid: the same pixels, but other last bits of t.
                if (hard_case.name == "resolution_doubling") continue;
                // Its rays pass a border nearer than that grid is fine: placed on it, some cross elsewhere.
                if (hard_case.name == "beside_a_border") continue;
                EXPECT_EQ(row.breaks, 0U) << hard_case.name << " " << (row.findings.empty() ? "" : row.findings[0]);
            }
}

// On the rays of the float shader: made by it, they are exact in double precision, too.
TEST(ExactArithmetic, IsTheSameInFloatAndDouble)
{
    if (const std::string missing = missing_for_exact(); !missing.empty()) GTEST_SKIP() << missing;
    const TraceSettings settings = boxes({.thickness_m = 0.1, .max_distance_m = 1e9});
    for (const std::string& scene : made_scenes_and({"interior", "thin_yard"})) {
        const Picture picture = make_picture(scene, "default", {321, 181});
        const size_t  pixels  = picture.image.depth.size();
        for (const std::string id : {"dda", "hiz", "quadtree"}) {
            const Technique&      t      = technique(id);
            const ParameterValues values = values_of(t, {{"arithmetic", 1}});
            const auto            single = tracer_on(picture.gbuffer, t, values, settings, pixels);
            const auto            twin = tracer_on(picture.gbuffer, t, values, settings, pixels, NumberFormat::float64);
            const std::vector<RayInput>   rays  = set_up_rays(device(), *single);
            const std::vector<RayOutcome> found = trace_rays(device(), *single, rays),
                                          exact = trace_rays(device(), *twin, rays);
            size_t differ                       = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                differ += found[i].status != exact[i].status ||
                          (found[i].status == TraceStatus::hit && found[i].hit_pixel != exact[i].hit_pixel);
            EXPECT_EQ(differ, 0U) << scene << ", " << id << ": of " << rays.size() << " rays";
        }
    }
}

// The nearest float to the way down to the border leads one step beyond it: there the picture has no row, and 512 is the number of the first one's
// place, too, which holds an object.
TEST(ExactArithmetic, RaysEndAtTheBorderOfTheImage)
{
    if (const std::string missing = missing_for_exact(); !missing.empty()) GTEST_SKIP() << missing;
    const View         view = bench_view({8, 512});
    std::vector<float> depth(pixel_count(view.size_px));
    for (size_t x = 0; x < 8; ++x) depth[x] = 0.5F;
    const auto     gbuffer = upload_depth(device(), view, depth);
    const float    y       = 100.5F + 1.0F / 65536;
    const double   to_end  = 512.0 - static_cast<double>(y);
    const RayInput ray{{3.5, y, 0.5}, {1, static_cast<float>(to_end), 0}, 1, TraceStatus::left_screen, {3, 100}};
    ASSERT_EQ(ray.delta_px_depth.y - to_end, 1.0 / 65536);
    for (const char* id : {"dda", "hiz", "quadtree"}) {
        const auto tracer =
            tracer_on(gbuffer, technique(id), values_of(technique(id), {{"arithmetic", 1}}), boxes(), 1);
        EXPECT_EQ(trace_rays(device(), *tracer, {&ray, 1})[0].status, TraceStatus::left_screen) << id;
    }
}

TEST(ExactArithmetic, IsRefusedWhereTheDeviceHasNoIntegersForIt)
{
    const Technique& walk    = technique("dda");
    const auto       gbuffer = upload_depth(device(), bench_view(), std::vector<float>(64 * 64, 0.0F));
    Gpu              without = device();
    without.info.int64       = false;
    EXPECT_NO_THROW(
        make_tracer(without, make_lab(without, catalogue(), gbuffer, walk, default_values(walk), boxes()), 1));
    EXPECT_THAT(
        [&] {
            make_tracer(without,
                        make_lab(without, catalogue(), gbuffer, walk, values_of(walk, {{"arithmetic", 1}}), boxes()),
                        1);
        },
        testing::ThrowsMessage<Failure>(
            testing::AllOf(testing::HasSubstr("arithmetic = exact"), testing::HasSubstr("shaderInt64"))));
}

} // namespace
} // namespace ssrlab::test
