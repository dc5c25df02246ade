// Whatever way a device stores texels in, it stores the same bits: words, 64 bits at a time, or plain storage buffers. The same holds for whether
// the passes before the trace are serial or parallel.
#include "frame/drawing.h"
#include "frame/frame_inputs.h"
#include "gpu/device.h"

namespace ssrlab::test {
namespace {

struct Stored {
    std::vector<char>  cells, rays, hits, intervals;
    std::vector<float> shaded;
    GBufferCounts      counts;
};

struct Way {
    bool int64, plain_buffers, parallel;
};

/// All that a frame stores in texels, by a device that is said to store so. An odd size: cells stand beside the picture.
Stored frame_of(const Technique& technique, const FrameSettings& settings, const Way& way)
{
    Gpu gpu                = device();
    gpu.info.int64         = way.int64 && gpu.info.int64;
    gpu.info.plain_buffers = way.plain_buffers || gpu.info.plain_buffers;
    gpu.info.lanes         = way.parallel ? gpu.info.most_lanes : 1;
    const Scene scene      = load_scene("builtin:everything");
    const auto  drawing =
        draw_gbuffer(gpu, upload_scene(gpu, scene), camera_to_view(find_camera(scene, "default"), {163, 91}));
    draw_layers(gpu, *drawing, settings.trace.layers);
    const GBufferPtr gbuffer = drawing->gbuffer;
    const auto       buffers = make_frame_buffers(gpu, drawing);
    const LabPtr     lab     = make_lab(gpu, catalogue(), gbuffer, technique, values_of(technique), settings.trace);
    const FramePtr   frame   = make_frame(gpu, lab, buffers, plan_frame(gpu, catalogue(), lab, buffers, settings));
    run_frame(gpu, *frame);
    const size_t rays = download_as<uint32_t>(gpu, frame->inputs.rays->count, 1).front();
    EXPECT_GT(rays, 0U);
    const Buffer& cells      = gbuffer->depth.cells;
    const auto&   structures = frame->inputs.rays->structures;
    const auto    intervals  = structures ? structures->find("ray_packets.intervals") : decltype(structures->end()){};
    const bool    packets    = structures && intervals != structures->end();
    const size_t  groups     = (rays - 1) / RAYS_PER_GROUP + 1;
    const size_t  ray_bytes  = frame->inputs.rays->rays_of_pixels > 0 ? sizeof(uint32_t) : sizeof(PackedRay<float>);
    return {.cells     = download_as<char>(gpu, cells, cells.bytes),
            .rays      = download_as<char>(gpu, frame->inputs.rays->list, rays * ray_bytes),
            .hits      = download_as<char>(gpu, frame->inputs.rays->hits, rays * sizeof(PackedHit<float>)),
            .intervals = packets ? download_as<char>(gpu, intervals->second, groups * 4 * sizeof(glm::vec2))
                                 : std::vector<char>{},
            .shaded    = read_shaded(gpu, *frame).values,
            .counts    = frame->inputs.plan.statistics.gbuffer};
}

void expect_alike(const std::string& id, const FrameSettings& settings)
{
    SCOPED_TRACE(id);
    const Stored words = frame_of(technique(id), settings, {false, false, false});
    for (const Way way : {Way{true, false, false}, Way{false, true, false}, Way{false, false, true}}) {
        SCOPED_TRACE(way.parallel ? "parallel passes" : way.plain_buffers ? "plain buffers" : "64 bits at a time");
        const Stored stored = frame_of(technique(id), settings, way);
        EXPECT_EQ(stored.cells, words.cells);
        EXPECT_EQ(stored.rays, words.rays);
        EXPECT_EQ(stored.hits, words.hits);
        EXPECT_EQ(stored.intervals, words.intervals);
        EXPECT_EQ(stored.shaded, words.shaded);
        EXPECT_EQ(stored.counts, words.counts);
    }
}

TEST(StoredTexels, AreTheSameInEveryWayOfStoringThem)
{
    for (const ParameterValues& passes :
         {ParameterValues{{"hidden_layer", 1}}, {chosen(BounceMode::direct), {"bounces", 2}}}) {
        FrameSettings settings{.trace = boxes({.thickness_m = 0.1, .max_distance_m = 100})};
        for (const auto& [name, value] : passes) settings.passes.at(name) = value;
        expect_alike("hiz", settings);
    }
}

TEST(StoredTexels, AreTheSameOfBlocksAndOfSeveralRays)
{
    for (const ParameterValues& passes : {ParameterValues{{"rays_per_pixel", 3}},
                                          {{"skip_unneeded_passes", 0}},
                                          {chosen(TraceResolution::half)},
                                          {chosen(TraceResolution::quarter)}}) {
        FrameSettings settings{.trace = boxes({.thickness_m = 0.1, .max_distance_m = 100})};
        for (const auto& [name, value] : passes) settings.passes.at(name) = value;
        expect_alike("hiz_packets", settings);
    }
}

TEST(StoredTexels, AreTheSameInStructuresAndLayers)
{
    FrameSettings settings;
    settings.trace.layers = std::min(3, most_layers());
    for (const char* id : {"hiz_packets", "quadtree"}) expect_alike(id, settings);
}

TEST(StoredTexels, OfHitsAreTheSameWhateverTheListOfRaysHolds)
{
    const auto alike = [](const std::string& id, const ParameterValues& passes, bool parallel, int layers = 1) {
        FrameSettings settings;
        settings.trace.layers                   = layers;
        settings.trace.dielectric_max_roughness = 1;
        for (const auto& [name, value] : passes) settings.passes.at(name) = value;
        const Way    way{true, false, parallel};
        const Stored rays = frame_of(technique(id), settings, way);
        settings.passes.insert_or_assign("ray_list", choice_value(RayList::pixels));
        const Stored pixels = frame_of(technique(id), settings, way);
        EXPECT_EQ(pixels.rays.size() * sizeof(PackedRay<float>), rays.rays.size() * sizeof(uint32_t));
        EXPECT_EQ(pixels.hits, rays.hits);
        EXPECT_EQ(pixels.intervals, rays.intervals);
        EXPECT_EQ(pixels.shaded, rays.shaded);
    };
    // SwiftShader takes minutes to compile a loop that makes rays.
    const double several = draws_exactly() ? 3 : 1;
    alike("hiz", {}, false);
    alike("hiz_packets", {{"rays_per_pixel", several}}, true, std::min(2, most_layers()));
    alike("hiz_waves", {chosen(Gloss::stochastic), {"rays_per_pixel", several}}, false);
    alike("linear", {chosen(BounceMode::direct), {"bounces", 2}, chosen(Gloss::stochastic)}, false);
    alike("dda", {{"hidden_layer", 1}, chosen(TraceResolution::half)}, false);
    alike("quadtree", {chosen(BounceMode::history)}, false);
}

} // namespace
} // namespace ssrlab::test
