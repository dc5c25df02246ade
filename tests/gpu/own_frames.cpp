// What `ssrlab gbuffer` writes and what is read again are the same bits, and so are the hits.
#include "compare/image_io.h"
#include "gpu/device.h"
#include "scene/scene.h"
#include "unit/temp_folder.h"

namespace ssrlab::test {
namespace {

constexpr glm::ivec2 size_px{97, 55};

template <typename T> void expect_same_bits(const std::vector<T>& a, const std::vector<T>& b, const char* what)
{
    ASSERT_EQ(a.size(), b.size()) << what;
    for (size_t i = 0; i < a.size(); ++i) {
        const auto *x = reinterpret_cast<const float*>(&a[i]), *y = reinterpret_cast<const float*>(&b[i]);
        for (size_t c = 0; c < sizeof(T) / sizeof(float); ++c)
            ASSERT_TRUE(std::bit_cast<uint32_t>(x[c]) == std::bit_cast<uint32_t>(y[c]) ||
                        (std::isnan(x[c]) && std::isnan(y[c])))
                << what << " of pixel " << i << ": " << x[c] << " against " << y[c];
    }
}

void expect_same(const GBufferImage& a, const GBufferImage& b)
{
    expect_same_bits(a.depth, b.depth, "depth");
    expect_same_bits(a.normal_vs, b.normal_vs, "normal");
    expect_same_bits(a.roughness, b.roughness, "roughness");
    expect_same_bits(a.metallic, b.metallic, "metallic");
    expect_same_bits(a.dielectric_f0, b.dielectric_f0, "dielectric_f0");
    expect_same_bits(a.base_colour, b.base_colour, "base colour");
    expect_same_bits(a.radiance, b.radiance, "radiance");
    expect_same_bits(a.highlight, b.highlight, "highlight");
    expect_same_bits(a.emission, b.emission, "emission");
    expect_same_bits(a.diffuse_share, b.diffuse_share, "diffuse share");
    expect_same_bits(a.gradient, b.gradient, "gradient");
    expect_same_bits(a.solid_back, b.solid_back, "solid");
    EXPECT_EQ(a.object_id, b.object_id);
    EXPECT_EQ(a.view.world_to_view, b.view.world_to_view);
    EXPECT_EQ(a.view.focal_px, b.view.focal_px);
    EXPECT_EQ(a.view.centre_px, b.view.centre_px);
    EXPECT_EQ(a.view.projection, b.view.projection);
    EXPECT_EQ(a.view.near_m, b.view.near_m);
}

GBufferImage written_and_read(const GBufferImage& image)
{
    const TempFolder folder;
    write_image(folder / "frame.exr", frame_image(image));
    return load_scene((folder / "frame.exr").string()).frame->gbuffer;
}

TEST(OwnFrames, ExportImportAndTraceGiveTheSameBits)
{
    for (const std::string& scene : made_scenes_and({"interior", "thin_yard"})) {
        SCOPED_TRACE(scene);
        const Picture drawn    = make_picture(scene, "default", size_px);
        const Picture imported = make_picture(written_and_read(drawn.image));
        expect_same(drawn.image, imported.image);
        for (const std::string surface : {"box", "plane_solid"}) {
            const TraceSettings settings{
                .thickness_m = 0.2, .max_distance_m = 20, .behind = Behind::hit, .surface = surface};
            const ParameterValues values = values_of(technique("hiz"));
            std::string           first;
            EXPECT_EQ(count_differences(trace(drawn, technique("hiz"), values, settings),
                                        trace(imported, technique("hiz"), values, settings), bit_equal_t, first),
                      0)
                << first;
        }
        if (HasFatalFailure()) return;
    }
}

TEST(OwnFrames, AnOrthographicViewComesBackToo)
{
    Scene  scene        = load_scene("builtin:stairs");
    Camera camera       = scene.cameras.front();
    camera.projection   = Projection::orthographic;
    camera.height_m     = 6;
    camera.far_m        = 60;
    const Picture drawn = make_picture(scene, camera, size_px);
    expect_same(drawn.image, make_picture(written_and_read(drawn.image)).image);
}

} // namespace
} // namespace ssrlab::test
