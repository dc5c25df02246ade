// Many cameras and lights: in time, or refused with the file's name.
#include "scene_files.h"

#include "core/error.h"
#include "core/stopwatch.h"
#include "scene/load_scene.h"
#include "scene/model.h"

namespace ssrlab {
namespace {

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

Model model_with(size_t cameras, size_t lights)
{
    Model model;
    model.cameras.resize(cameras);
    model.lights.resize(lights);
    return model;
}

TEST(SceneLimits, CamerasOfOneNameAreNumberedInLinearTime)
{
    const Stopwatch stopwatch;
    const Scene     scene = model_to_scene(model_with(50'000, 1), "many.gltf");
    EXPECT_LT(stopwatch.seconds(), 5) << "each one used to be compared with all before it";
    EXPECT_EQ(scene.cameras[0].name, "default");
    EXPECT_EQ(scene.cameras[1].name, "default_2");
    EXPECT_EQ(scene.cameras[49'999].name, "default_50000");
}

TEST(SceneLimits, MoreAreRefusedWithTheFilesName)
{
    EXPECT_THAT([] { model_to_scene(model_with(100'001, 1), "many.gltf"); },
                Throws<SpecError>(Property(&SpecError::what, HasSubstr("many.gltf: 100001 cameras, at most 100000"))));
    EXPECT_THAT([] { model_to_scene(model_with(1, 1025), "many.gltf"); },
                Throws<SpecError>(Property(&SpecError::what, HasSubstr("many.gltf: 1025 lights, at most 1024"))));
}

TEST(SceneLimits, TrianglesAreCountedBeforeTheirBytesAreRead)
{
    const TempFolder folder;
    GltfFile         file = GltfFile::triangle();
    constexpr auto   most = 120'000'000ULL;
    // The buffer's file is shorter: who reads it finds that, and another message.
    file.root["buffers"] = {{{"uri", "data.bin"}, {"byteLength", most + 39}}};
    file.root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 36}, {"byteLength", most + 3}});
    file.root["accessors"].push_back(
        {{"bufferView", 1}, {"componentType", 5121}, {"count", most + 3}, {"type", "SCALAR"}});
    file.primitive()["indices"] = 1;
    const std::string path      = file.write(folder);
    EXPECT_THAT([&] { load_scene(path); },
                Throws<SpecError>(Property(
                    &SpecError::what, HasSubstr(path + ": 40000001 triangles with all instances, at most 40000000"))));
    file.root["accessors"][1]["count"] = most;
    EXPECT_THROW(load_scene(file.write(folder)), Failure) << "as many as may be, but their bytes are not there";
}

} // namespace
} // namespace ssrlab
