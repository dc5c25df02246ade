// What shaders store 64 bits at a time is what they store as texels where the device cannot.
#include "gpu/device.h"
#include "render/frame_passes.h"

namespace ssrlab::test {
namespace {

struct Stored {
    std::vector<char>  cells, rays, hits;
    std::vector<float> shaded;
};

/// All that a frame stores in texels, by a device that is said to have 64-bit integers or not. An odd size: cells stand beside the picture.
Stored frame_of(const ParameterValues& changed, bool int64)
{
    Gpu gpu        = device();
    gpu.info.int64 = int64;
    FrameSettings settings{.trace = {.thickness_m = 0.1, .max_distance_m = 100}};
    for (const auto& [name, value] : changed) settings.passes.at(name) = value;
    const Picture    picture = make_picture("builtin:everything", "default", {163, 91});
    const Technique& hiz     = technique("hiz");
    const auto       frame   = prepare_frame(gpu, picture.buffers, hiz, values_of(hiz), settings);
    run_frame(gpu, *frame);
    const size_t rays = download_as<uint32_t>(gpu, frame->rays->count, 1).front();
    EXPECT_GT(rays, 0U);
    const Buffer& cells = picture.gbuffer->depth.cells;
    return {download_as<char>(gpu, cells, cells.bytes),
            download_as<char>(gpu, frame->rays->list, rays * sizeof(PackedRay<float>)),
            download_as<char>(gpu, frame->rays->hits, rays * sizeof(PackedHit<float>)),
            read_shaded(gpu, *frame).values};
}

TEST(StoredTexels, AreTheSame64BitsAtATime)
{
    for (const ParameterValues& passes :
         {ParameterValues{{"hidden_layer", 1}}, {chosen(BounceMode::direct), {"bounces", 2}}}) {
        const Stored wide = frame_of(passes, true), words = frame_of(passes, false);
        EXPECT_EQ(wide.cells, words.cells);
        EXPECT_EQ(wide.rays, words.rays);
        EXPECT_EQ(wide.hits, words.hits);
        EXPECT_EQ(wide.shaded, words.shaded);
    }
}

} // namespace
} // namespace ssrlab::test
