// Where a glTF's bytes may come from: files and data URIs that the parser by itself refuses, against the plain file.
#include "scene_files.h"

namespace ssrlab {
namespace {

// 36 bytes: (0, 0, 0), (1, 0, 0), (0, 1, 0).
constexpr const char* triangle_base64 = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";

void expect_the_triangle(const std::string& path)
{
    const Scene scene = load_scene(path);
    ASSERT_EQ(scene.indices.size(), 3U) << path;
    EXPECT_EQ(corner(scene, 1), glm::vec3(1, 0, 0)) << path;
    EXPECT_EQ(corner(scene, 2), glm::vec3(0, 1, 0)) << path;
}

TEST(GltfData, UrisOfAnyMediaType)
{
    TempFolder folder;
    for (const char* type : {"", "application/gltf-buffer", "application/octet-stream", "model/x;charset=utf-8"}) {
        GltfFile file        = GltfFile::triangle();
        file.root["buffers"] = {
            {{"uri", std::string("data:") + type + ";base64," + triangle_base64}, {"byteLength", 36}}};
        expect_the_triangle(file.write(folder));
    }
}

TEST(GltfData, MayBeLongerThanTheBufferSays)
{
    TempFolder folder;
    GltfFile   file      = GltfFile::triangle();
    file.root["buffers"] = {{{"uri", "long.bin"}, {"byteLength", 36}}};
    folder.write("long.bin", file.binary + std::string(9, '!'));
    expect_the_triangle(file.write(folder));
    file.root["buffers"] = {{{"uri", std::string("data:;base64,") + triangle_base64 + "AAA="}, {"byteLength", 36}}};
    expect_the_triangle(file.write(folder));
}

TEST(GltfData, NamesAreDecodedOnce)
{
    TempFolder folder;
    for (const auto& [uri, name] : {std::pair("a%20b.bin", "a b.bin"), std::pair("a%2520b.bin", "a%20b.bin"),
                                    std::pair("a+b.bin", "a+b.bin"), std::pair("a%2Bc.bin", "a+c.bin")}) {
        GltfFile file        = GltfFile::triangle();
        file.root["buffers"] = {{{"uri", uri}, {"byteLength", 36}}};
        folder.write(name, file.binary);
        expect_the_triangle(file.write(folder));
    }
}

} // namespace
} // namespace ssrlab
