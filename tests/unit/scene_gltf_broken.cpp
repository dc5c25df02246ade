// Files that lie. Each must end in a message that says what is wrong: never a crash, a hang, or bytes from elsewhere.
#include "errors.h"
#include "scene_files.h"

#include <sys/stat.h>

namespace ssrlab {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

struct BrokenFile {
    const char*                    name;
    std::function<void(GltfFile&)> damage;
    const char*                    message;
};

class SceneGltfBroken : public ::testing::TestWithParam<BrokenFile> {};

TEST_P(SceneGltfBroken, IsRefusedWithAMessage)
{
    TempFolder folder;
    GltfFile   file = GltfFile::triangle();
    GetParam().damage(file);
    const std::string path    = file.write(folder);
    const std::string message = error_of<Failure>(path);
    EXPECT_THAT(message, HasSubstr(GetParam().message));
    EXPECT_THAT(message, HasSubstr(path)) << "every message names the file";
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line";
}

void add_indices(GltfFile& file, std::vector<uint16_t> indices)
{
    file.primitive()["indices"] = file.add_accessor<uint16_t>(indices, "SCALAR", 1);
}

void use_image(GltfFile& file, const json& image)
{
    file.root["images"]          = {image};
    file.root["textures"]        = {{{"source", 0}}};
    file.root["materials"]       = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.primitive()["material"] = 0;
}

void chain(GltfFile& file, int length)
{
    file.root["nodes"] = json::array();
    for (int i = 0; i < length; ++i) file.root["nodes"].push_back({{"children", {i + 1}}});
    file.root["nodes"].push_back({{"mesh", 0}});
}

/// Every level has the next one ten times.
void bomb(GltfFile& file)
{
    file.root["nodes"] = json::array();
    for (int i = 0; i < 30; ++i) file.root["nodes"].push_back({{"children", std::vector<int>(10, i + 1)}});
    file.root["nodes"].push_back({{"mesh", 0}});
}

/// Puts JSON in the place that the pointer names.
std::function<void(GltfFile&)> put(const char* place, const char* text)
{
    return [=](GltfFile& file) { file.root[json::json_pointer(place)] = json::parse(text); };
}

std::function<void(GltfFile&)> put_buffer(const char* uri, int bytes = 36)
{
    return [=](GltfFile& file) { file.root["buffers"] = {{{"uri", uri}, {"byteLength", bytes}}}; };
}

const std::vector<BrokenFile> broken_files = {
    {"version_1", put("/asset/version", "\"1.0\""), "version 1.0 is not supported"},
    {"version_missing", [](GltfFile& f) { f.root.erase("asset"); }, "/asset/version is missing"},
    {"index_out_of_range",
     [](GltfFile& f) {
         add_indices(f, {0, 1, 3});
     },
     "/meshes/0/primitives/0/indices: index 3 is out of range"},
    {"accessor_count_4e9", [](GltfFile& f) { f.root["accessors"][0]["count"] = 4'000'000'000; }, "accessor 0"},
    {"accessor_count_2_62", [](GltfFile& f) { f.root["accessors"][0]["count"] = 1ULL << 62U; }, "accessor 0"},
    {"accessor_count_too_large", put("/accessors/0/count", "4"), "reach beyond buffer view 0"},
    {"accessor_offset", put("/accessors/0/byteOffset", "4"), "reach beyond buffer view 0"},
    {"accessor_view", put("/accessors/0/bufferView", "77"), "there is no buffer view 77"},
    {"accessor_type", put("/accessors/0/type", "\"VEC2\""), "has 2 components, 3 are expected"},
    {"accessor_missing", [](GltfFile& f) { f.primitive()["attributes"]["POSITION"] = 9; }, "there is no accessor 9"},
    {"attribute_counts_differ",
     [](GltfFile& f) {
         f.primitive()["attributes"]["NORMAL"] = f.positions({0, 0, 1});
     },
     "1 elements for 3 positions"},
    {"no_data",
     [](GltfFile& f) {
         f.root["accessors"][0].erase("bufferView");
         f.root["accessors"][0]["count"] = 200'000'000;
     },
     "but no data"},
    {"view_beyond_buffer", put("/bufferViews/0/byteOffset", "4"), "/bufferViews/0 reaches beyond its buffer"},
    {"view_offset_overflows", [](GltfFile& f) { f.root["bufferViews"][0]["byteOffset"] = ~0ULL - 8; },
     "/bufferViews/0 reaches beyond its buffer"},
    {"view_negative", put("/bufferViews/0/byteLength", "-1"), "must be a whole number >= 0"},
    {"view_buffer", put("/bufferViews/0/buffer", "9"), "there is no such buffer"},
    {"sparse_beyond",
     [](GltfFile& f) {
         const int i                      = f.add_accessor<uint16_t>({3}, "SCALAR", 1);
         const int v                      = f.positions({3, 0, 0});
         f.root["accessors"][0]["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", i}, {"componentType", 5123}}}, {"values", {{"bufferView", v}}}};
     },
     "sparse index 3 is out of range"},
    {"material", [](GltfFile& f) { f.primitive()["material"] = 5; }, "there is no material 5"},
    {"mesh", put("/nodes/0/mesh", "5"), "there is no mesh 5"},
    {"node", put("/nodes/0/children", "[55]"), "there is no node 55"},
    {"scene", put("/scene", "42"), "there is no scene 42"},
    {"camera", put("/nodes/0/camera", "4"), "there is no camera 4"},
    {"node_is_its_own_child", put("/nodes/0/children", "[0]"), "nodes contain each other"},
    {"node_cycle", put("/nodes", R"([{"children": [1]}, {"children": [0]}])"), "nodes contain each other"},
    {"node_chain", [](GltfFile& f) { chain(f, 5000); }, "nested deeper than 256"},
    {"node_bomb", bomb, "more than"},
    {"texture",
     [](GltfFile& f) {
         use_image(f, {{"uri", "a.png"}});
         f.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 3;
     },
     "there is no texture 3"},
    {"accessor_of_doubles", put("/accessors/0/componentType", "5130"),
     "accessor 0: expected componentType 5120 to 5123, 5125 or 5126, got 5130"},
    {"accessor_of_signed_integers", put("/accessors/0/componentType", "5124"), "got 5124"},
    {"sparse_count",
     put("/accessors/0/sparse", "{\"count\": -1, \"indices\": {\"bufferView\": 0, \"componentType\": 5123}, "
                                "\"values\": {\"bufferView\": 0}}"),
     "expected a sparse count above 0, got -1"},
    {"buffer_outside", put_buffer("../secret.bin"), "/buffers/0/uri: '../secret.bin' leads out"},
    {"buffer_outside_encoded", put_buffer("%2e%2e/secret.bin"), "leads out"},
    {"buffer_absolute", put_buffer("/etc/passwd"), "not a relative path"},
    {"buffer_scheme", put_buffer("http://localhost/a.bin"), "not a relative path"},
    {"buffer_shell", put_buffer("`touch made_by_shell`"), "touch"},
    {"buffer_missing", put_buffer("none.bin"), "/buffers/0/uri: there is no file 'none.bin'"},
    {"buffer_short", put_buffer("data.bin", 1 << 20), "/buffers/0: expected data of 1048576 bytes, got a size of 36"},
    {"data_not_in_base64", put_buffer("data:,%00%00"),
     "/buffers/0/uri: expected a data URI in base64, got 'data:,%00%00"},
    {"image_outside",
     [](GltfFile& f) {
         use_image(f, {{"uri", "a/../../secret.png"}});
     },
     "/images/0/uri: 'a/../../secret.png' leads out"},
    {"node_matrix", put("/nodes/0/translation", "[1, 2]"), "/nodes/0/translation"},
    {"not_objects", put("/nodes", "[1, 2]"), "/nodes/0 is no object"},
    {"not_an_array", put("/accessors", "\"x\""), "/accessors is no array"},
};

INSTANTIATE_TEST_SUITE_P(Corpus, SceneGltfBroken, ::testing::ValuesIn(broken_files),
                         [](const auto& file) { return std::string(file.param.name); });

TEST(SceneGltfHostile, DeepJsonIsRefusedBeforeItIsParsed)
{
    TempFolder        folder;
    const std::string deep(20'000, '[');
    const std::string path =
        folder.write("deep.gltf", R"({"asset":{"version":"2.0"},"extras":)" + deep + std::string(20'000, ']') + "}");
    EXPECT_THAT(error_of<Failure>(path), HasSubstr("nested deeper than 128"));
}

TEST(SceneGltfHostile, JsonThatIsNone)
{
    TempFolder folder;
    for (const char* text :
         {"", "{", "[]", "{\"asset\":", "\xFF\xFE", "{\"asset\":{\"version\":\"2.0\"},\"a\":1e400}", "NaN"})
        EXPECT_THAT(error_of<Failure>(folder.write("broken.gltf", text)), HasSubstr("broken.gltf")) << text;
}

TEST(SceneGltfHostile, OnlyRegularFilesAreRead)
{
    TempFolder folder;
    ASSERT_EQ(::mkfifo((folder / "pipe.bin").c_str(), 0600), 0);
    std::filesystem::create_directory(folder / "folder.bin");
    for (const char* uri : {"pipe.bin", "folder.bin"}) {
        GltfFile file        = GltfFile::triangle();
        file.root["buffers"] = {{{"uri", uri}, {"byteLength", 36}}};
        EXPECT_THAT(error_of<Failure>(file.write(folder)), HasSubstr(uri));
    }
    std::filesystem::create_directory(folder / "folder.glb");
    EXPECT_THAT(error_of<Failure>((folder / "folder.glb").string()), HasSubstr("not a regular file"));
}

TEST(SceneGltfHostile, LinksOutOfTheFolderAreRefused)
{
    TempFolder folder;
    folder.write("secret.bin", std::string(36, '\0'));
    std::filesystem::create_directory(folder / "asset");
    std::filesystem::create_symlink(folder / "secret.bin", folder / "asset/link.bin");
    GltfFile file        = GltfFile::triangle();
    file.root["buffers"] = {{{"uri", "link.bin"}, {"byteLength", 36}}};
    EXPECT_THAT(error_of<Failure>(file.write(folder, "asset/scene.gltf")), HasSubstr("leads out"));
}

TEST(SceneGltfHostile, BadPositionsAreDroppedAndCounted)
{
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    GltfFile    file;
    const int   positions = file.positions({0, 0, 0, 1,   0, 0, 0, 1,     0,   // good
                                            0, 0, 0, nan, 0, 0, 0, 1,     0,   // not a number
                                            0, 0, 0, 1,   0, 0, 0, inf,   0,   // infinite
                                            0, 0, 0, 1,   0, 0, 2, 0,     0,   // without area
                                            0, 0, 0, 1,   0, 0, 0, 3e38F, 0}); // beyond what can be computed with
    file.root["nodes"]    = {{{"mesh", 0}}};
    file.root["meshes"]   = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    const Scene scene     = file.load();
    EXPECT_EQ(scene.indices.size(), 3U);
    EXPECT_EQ(scene.vertices.size(), 3U) << "no bad vertex stays behind";
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("3 triangles dropped")));
    for (const Vertex& vertex : scene.vertices) EXPECT_LE(glm::length(vertex.position_ws), 1);
}

TEST(SceneGltfHostile, FlatteningNodesLeaveNothing)
{
    GltfFile file      = GltfFile::triangle();
    file.root["nodes"] = {{{"mesh", 0}, {"scale", {0, 0, 0}}}};
    const Scene scene  = file.load();
    EXPECT_TRUE(scene.draws.empty());
    EXPECT_EQ(scene.cameras.size(), 1U);
}

TEST(SceneGltfHostile, UnusableImagesLeaveTheShape)
{
    TempFolder folder;
    folder.write("broken.png", "\x89PNG not really");
    for (const char* uri : {"missing.png", "broken.png"}) {
        GltfFile file = GltfFile::triangle();
        use_image(file, {{"uri", uri}});
        const Scene scene = load_scene(file.write(folder));
        EXPECT_EQ(scene.draws.size(), 1U);
        EXPECT_EQ(scene.textures.size(), 0U);
        EXPECT_THAT(scene.warnings, Contains(HasSubstr("texture left out")));
        EXPECT_THAT(scene.warnings, Contains(HasSubstr(uri)));
    }
}

TEST(SceneGltfHostile, TooLargeAnImageIsRefused)
{
    TempFolder folder;
    // A header that claims 30000 x 30000 pixels: refused by its size, before anything is decoded.
    folder.write("bomb.png",
                 std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30\x08\x06\0\0\0\x66\x27\xf8\xba"
                             "\0\0\0\x04"
                             "IDAT\0\0\0\0\0\0\0\0\0\0\0\0IEND\xAE\x42\x60\x82",
                             61));
    GltfFile file = GltfFile::triangle();
    use_image(file, {{"uri", "bomb.png"}});
    const auto path = file.write(folder);
    EXPECT_THAT(message_of<SpecError>([&] { static_cast<void>(load_scene(path)); }),
                testing::AllOf(HasSubstr(path), HasSubstr("/images/0 'bomb.png'"),
                               HasSubstr("30000x30000 pixels, at most 16384 a side")));
}

TEST(SceneGltfHostile, UnsupportedThingsAreNamedOnce)
{
    GltfFile file               = GltfFile::triangle();
    file.root["extensionsUsed"] = {"KHR_materials_sheen", "VENDOR_thing"};
    file.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
    file.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    const Scene scene = file.load();
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("KHR_materials_sheen")).Times(1));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("VENDOR_thing")).Times(1));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("points and lines are not drawn")).Times(1));
}

} // namespace
} // namespace ssrlab
