// Truths on disk: equal to computed ones, never trusted when damaged, never required.
#include "truth/truth_cache.h"
#include "truth_scenes.h"

#include <unistd.h>

namespace ssrlab {
namespace {

using namespace test;
namespace fs = std::filesystem;

class TruthCache : public testing::Test {
protected:
    TruthCache() : folder_(fs::temp_directory_path() / ("ssrlab_truth_cache_" + std::to_string(getpid()))) {}
    ~TruthCache() override { fs::remove_all(folder_); }

    std::vector<fs::path> files() const { return {fs::directory_iterator(folder_), fs::directory_iterator()}; }

    fs::path folder_;
};

void expect_equal(const TraceImage& a, const TraceImage& b)
{
    EXPECT_EQ(a.size_px, b.size_px);
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.steps, b.steps);
    EXPECT_EQ(a.hit_pixel, b.hit_pixel);
    EXPECT_EQ(a.hit_layer, b.hit_layer);
    EXPECT_EQ(a.hit_px_depth, b.hit_px_depth);
    EXPECT_EQ(a.hit_t, b.hit_t);
}

TEST_F(TruthCache, ScreenTruthReadsWhatItWrote)
{
    const GBufferImage gbuffer  = random_gbuffer(bench_view({31, 23}), 1);
    const TraceImage   computed = screen_truth(gbuffer, boxes());
    expect_equal(cached_screen_truth(folder_, gbuffer, boxes()), computed);
    ASSERT_EQ(files().size(), 1U);
    const auto written = fs::last_write_time(files()[0]);
    expect_equal(cached_screen_truth(folder_, gbuffer, boxes()), computed);
    EXPECT_EQ(fs::last_write_time(files()[0]), written);
}

TEST_F(TruthCache, EveryInputChangesTheName)
{
    GBufferImage  gbuffer         = random_gbuffer(bench_view({9, 7}), 2);
    TraceSettings settings        = boxes();
    size_t        expected        = 0;
    const auto    expect_new_file = [&](auto change) {
        change();
        cached_screen_truth(folder_, gbuffer, settings);
        EXPECT_EQ(files().size(), ++expected);
    };
    expect_new_file([] {});
    expect_new_file([&] { gbuffer.depth[5] *= 1.5F; });
    expect_new_file([&] { gbuffer.normal_vs[5].x += 0.1F; });
    expect_new_file([&] { gbuffer.metallic[5] = 0; });
    expect_new_file([&] { gbuffer.view.near_m *= 2; });
    expect_new_file([&] { gbuffer.view.centre_px.x += 1; });
    expect_new_file([&] { settings.thickness_m *= 2; });
    expect_new_file([&] { settings.thickness_relative = true; });
    expect_new_file([&] { settings.max_distance_m = 3; });
    expect_new_file([&] { settings.ray_offset_m = 0.1; });
    expect_new_file([&] { settings.behind = Behind::pass; });
    gbuffer.view.name = "another name for the same view";
    cached_screen_truth(folder_, gbuffer, settings);
    EXPECT_EQ(files().size(), expected);
}

TEST_F(TruthCache, DamagedFilesAreComputedAnew)
{
    const GBufferImage gbuffer  = random_gbuffer(bench_view({31, 23}), 3);
    const TraceImage   computed = cached_screen_truth(folder_, gbuffer, boxes());
    const fs::path     file     = files()[0];
    const auto         size     = fs::file_size(file);
    for (const auto cut : {size - 1, size / 2, uintmax_t(20), uintmax_t(0)}) {
        fs::resize_file(file, cut);
        expect_equal(cached_screen_truth(folder_, gbuffer, boxes()), computed);
        EXPECT_EQ(fs::file_size(file), size);
    }
    for (const int place : {0, 9, 20, 40, 500}) {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekg(place);
        const int byte = stream.get();
        stream.seekp(place);
        stream.put(char(byte ^ 0x10));
        stream.close();
        expect_equal(cached_screen_truth(folder_, gbuffer, boxes()), computed);
    }
    EXPECT_EQ(files().size(), 1U); // no temporary file is left
}

TEST_F(TruthCache, FilesUnderEachOthersNamesAreComputedAnew)
{
    const GBufferImage  gbuffer = random_gbuffer(bench_view({31, 23}), 3);
    const TraceSettings other   = boxes({}, Behind::stop);
    const TraceImage    hits    = cached_screen_truth(folder_, gbuffer, boxes());
    const TraceImage    stops   = cached_screen_truth(folder_, gbuffer, other);
    ASSERT_NE(hits.status, stops.status);
    ASSERT_EQ(files().size(), 2U);
    const fs::path first = files()[0], second = files()[1], aside = folder_ / "aside";
    fs::rename(first, aside);
    fs::rename(second, first);
    fs::rename(aside, second);
    for (int i = 0; i < 2; ++i) { // anew, and then as they were written
        expect_equal(cached_screen_truth(folder_, gbuffer, boxes()), hits);
        expect_equal(cached_screen_truth(folder_, gbuffer, other), stops);
    }
    EXPECT_GT(std::ranges::count(stops.status, TraceStatus::stopped), 0) << "their places are kept, too";
    EXPECT_EQ(files().size(), 2U);
}

TEST_F(TruthCache, UnwritableFolderIsNoError)
{
    const GBufferImage gbuffer = random_gbuffer(bench_view({9, 7}), 4);
    expect_equal(cached_screen_truth("/proc/none", gbuffer, boxes()), screen_truth(gbuffer, boxes()));
}

TEST_F(TruthCache, SceneTruthReadsWhatItWrote)
{
    Scene scene;
    add_floor(scene, add_material(scene, {1, 1, 1}, 1));
    add_quad(scene, add_material(scene, {0.5F, 0, 0}, 0), {-5, -2, -10}, {10, 0, 0}, {0, 4, 0});
    const GBufferImage gbuffer  = floor_and_wall(bench_view({33, 20}), 100);
    const SceneTruth   computed = scene_truth(SceneBvh(scene), scene, gbuffer, {});
    for (int i = 0; i < 2; ++i) {
        const SceneTruth cached = cached_scene_truth(folder_, scene, gbuffer, {});
        EXPECT_EQ(cached.cls, computed.cls);
        EXPECT_EQ(cached.point_vs, computed.point_vs);
        EXPECT_EQ(cached.point_px, computed.point_px);
        EXPECT_EQ(cached.distance_m, computed.distance_m);
        EXPECT_EQ(cached.off_surface, computed.off_surface);
        EXPECT_EQ(cached.radiance, computed.radiance);
    }
    EXPECT_EQ(files().size(), 1U);
    scene.materials[1].base_colour.g = 0.25F;
    cached_scene_truth(folder_, scene, gbuffer, {});
    scene.vertices[6].position_ws.x += 0.125F;
    cached_scene_truth(folder_, scene, gbuffer, {});
    EXPECT_EQ(files().size(), 3U);
    scene.environment.size_px  = {2, 1};
    scene.environment.radiance = {glm::vec3(1), glm::vec3(2)};
    cached_scene_truth(folder_, scene, gbuffer, {});
    scene.environment.radiance[1].b = 3;
    cached_scene_truth(folder_, scene, gbuffer, {});
    EXPECT_EQ(files().size(), 5U);
    scene.materials[1].alpha_cutoff = 0.75F;
    cached_scene_truth(folder_, scene, gbuffer, {});
    cached_scene_truth(folder_, scene, gbuffer, {.max_distance_m = 3});
    EXPECT_EQ(files().size(), 7U);
}

TEST_F(TruthCache, GlossyTruthReadsWhatItWrote)
{
    Scene scene;
    add_floor(scene, add_material(scene, {1, 1, 1}, 1));
    add_quad(scene, add_material(scene, {0.5F, 0, 0}, 0), {-5, -2, -10}, {10, 0, 0}, {0, 4, 0});
    GBufferImage gbuffer = floor_and_wall(bench_view({33, 20}), 100);
    for (size_t i = 0; i < gbuffer.roughness.size(); ++i) gbuffer.roughness[i] = float(i % 3) * 0.2F;
    const GlossySettings glossy{.rays = 8};
    const GlossyTruth    computed = glossy_truth(SceneBvh(scene), scene, gbuffer, {}, glossy);
    for (int i = 0; i < 2; ++i) {
        const GlossyTruth cached = cached_glossy_truth(folder_, scene, gbuffer, {}, glossy);
        EXPECT_EQ(cached.rays, computed.rays);
        EXPECT_EQ(cached.radiance, computed.radiance);
        EXPECT_EQ(cached.noise, computed.noise);
        EXPECT_EQ(cached.albedo, computed.albedo);
    }
    EXPECT_EQ(files().size(), 1U);
    cached_glossy_truth(folder_, scene, gbuffer, {}, {.rays = 10});
    cached_glossy_truth(folder_, scene, gbuffer, {}, {.rays = 8, .seed = 1});
    gbuffer.roughness[0] = 0.7F;
    cached_glossy_truth(folder_, scene, gbuffer, {}, glossy);
    EXPECT_EQ(files().size(), 4U);
    for (const float exponent : {3.0F, 3.0F, 0.0F}) // one file: the rays are the same
        EXPECT_EQ(cached_glossy_truth(folder_, scene, gbuffer, {}, {.rays = 8, .metallic_exponent = exponent})
                      .metallic_exponent,
                  exponent);
    EXPECT_EQ(files().size(), 5U);
}

} // namespace
} // namespace ssrlab
