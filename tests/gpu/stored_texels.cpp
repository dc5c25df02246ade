// Whatever way a device stores texels in, it stores the same bits: words, 64 bits at a time, or plain storage buffers.
#include "gpu/device.h"
#include "render/frame_passes.h"
#include "render/gbuffer.h"

namespace ssrlab::test {
namespace {

struct Stored {
    std::vector<char>  cells, rays, hits;
    std::vector<float> shaded;
};

struct Way {
    bool int64, plain_buffers;
};

/// All that a frame stores in texels, by a device that is said to store so. An odd size: cells stand beside the picture.
Stored frame_of(const Technique& technique, const FrameSettings& settings, const Way& way)
{
    Gpu gpu                = device();
    gpu.info.int64         = way.int64 && gpu.info.int64;
    gpu.info.plain_buffers = way.plain_buffers || gpu.info.plain_buffers;
    const Scene scene      = load_scene("builtin:everything");
    const auto  gbuffer =
        render_gbuffer(gpu, upload_scene(gpu, scene), camera_to_view(find_camera(scene, "default"), {163, 91}));
    const auto buffers = make_frame_buffers(gpu, gbuffer);
    const auto frame   = prepare_frame(gpu, buffers, technique, values_of(technique), settings);
    run_frame(gpu, *frame);
    const size_t rays = download_as<uint32_t>(gpu, frame->rays->count, 1).front();
    EXPECT_GT(rays, 0U);
    const Buffer& cells = gbuffer->depth.cells;
    return {download_as<char>(gpu, cells, cells.bytes),
            download_as<char>(gpu, frame->rays->list, rays * sizeof(PackedRay<float>)),
            download_as<char>(gpu, frame->rays->hits, rays * sizeof(PackedHit<float>)),
            read_shaded(gpu, *frame).values};
}

void expect_alike(const std::string& id, const FrameSettings& settings)
{
    SCOPED_TRACE(id);
    const Stored words = frame_of(technique(id), settings, {false, false});
    for (const Way way : {Way{true, false}, Way{false, true}}) {
        const Stored stored = frame_of(technique(id), settings, way);
        EXPECT_EQ(stored.cells, words.cells) << way.plain_buffers;
        EXPECT_EQ(stored.rays, words.rays) << way.plain_buffers;
        EXPECT_EQ(stored.hits, words.hits) << way.plain_buffers;
        EXPECT_EQ(stored.shaded, words.shaded) << way.plain_buffers;
    }
}

TEST(StoredTexels, AreTheSameInEveryWayOfStoringThem)
{
    for (const ParameterValues& passes :
         {ParameterValues{{"hidden_layer", 1}}, {chosen(BounceMode::direct), {"bounces", 2}}}) {
        FrameSettings settings{.trace = {.thickness_m = 0.1, .max_distance_m = 100}}; // boxes
        for (const auto& [name, value] : passes) settings.passes.at(name) = value;
        expect_alike("hiz", settings);
    }
}

TEST(StoredTexels, AreTheSameInStructuresAndLayers)
{
    FrameSettings settings;
    settings.trace.layers = 3;
    for (const char* id : {"hiz_packets", "quadtree"}) expect_alike(id, settings);
}

} // namespace
} // namespace ssrlab::test
