// Which files decide how a scene looks: a sweep must not go on when one of them changed.
#include "core/files.h"
#include "harness/environment.h"
#include "scene/load_scene.h"
#include "scene_files.h"

namespace ssrlab {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> names(const TempFolder& folder, const std::string& scene)
{
    std::vector<std::string> names;
    for (const auto& file : scene_files(scene)) names.push_back(file.lexically_relative(folder.path()).string());
    return names;
}

TEST(SceneFiles, ARecipeHasItsModelsTheirMaterialsAndTheirTextures)
{
    const TempFolder folder;
    folder.write("models/a.obj", "# a.mtl\nmtllib my materials.mtl\r\nv 0 0 0\nvn 0 0 1\nf 1 1 1\n");
    folder.write(
        "models/my materials.mtl",
        "newmtl x\n\tmap_Kd -s 1 1 1 tex\\wood.png\nmap_Ks gone.png\nbump bump.png\nmap_Kd C:\\my models\\oak.png \n");
    folder.write("models/tex/wood.png", "");
    folder.write("models/bump.png", "");
    folder.write("models/oak.png", "");
    folder.write("models/other.png", "");
    const std::string recipe = folder.write("r.toml", "[[part]]\nfile = 'models/a.obj'\n[[part]]\nshape = 'box'\n");
    EXPECT_THAT(names(folder, recipe), ElementsAre("r.toml", "models/a.obj", "models/my materials.mtl",
                                                   "models/tex/wood.png", "models/bump.png", "models/oak.png"));
}

TEST(SceneFiles, AGltfHasItsBuffersImagesAndViews)
{
    const TempFolder  folder;
    const std::string scene =
        folder.write("s.gltf", R"({"buffers": [{"uri" : "a%20b.bin"}, {"uri": "data:;base64,AA=="}],
                                   "images": [{"name": "uri"}, {"uri": "t/i.png"}, {"uri": "gone.png"}]})");
    folder.write("a b.bin", "");
    folder.write("t/i.png", "");
    folder.write("s.gltf.views.toml", "");
    EXPECT_THAT(names(folder, scene), ElementsAre("s.gltf", "a b.bin", "t/i.png", "s.gltf.views.toml"));
}

TEST(SceneFiles, AGltfMayWriteItsNamesInAnyWayThatJsonHas)
{
    const TempFolder  folder;
    const std::string scene =
        folder.write("s.gltf", R"({"images": [{"uri": "t\/i.png"}, {"uri": "\u0061.png"}, {"\u0075ri": "b.png"}]})");
    for (const char* name : {"t/i.png", "a.png", "b.png"}) folder.write(name, "");
    EXPECT_THAT(names(folder, scene), ElementsAre("s.gltf", "t/i.png", "a.png", "b.png"));
}

TEST(SceneFiles, NothingForWhatIsBuiltInUnknownOrDamaged)
{
    const TempFolder folder;
    EXPECT_THAT(scene_files("builtin:stairs"), IsEmpty());
    EXPECT_THAT(scene_files("no such scene"), IsEmpty());
    EXPECT_THAT(scene_files((folder / "none.glb").string()), IsEmpty());
    EXPECT_THAT(names(folder, folder.write("broken.toml", "[[part")), ElementsAre("broken.toml"));
    EXPECT_THAT(names(folder, folder.write("out.gltf", R"({"uri": "../../etc/passwd"})")), ElementsAre("out.gltf"));
}

TEST(SceneFiles, AShippedRecipeIsFound) { EXPECT_GT(scene_files("thin_yard").size(), 1U); }

TEST(SceneFiles, EveryByteOfThemIsPartOfTheIdentity)
{
    const TempFolder folder;
    Experiment       experiment;
    experiment.scenes   = {folder.write("r.toml", "[[part]]\nfile = 'a.obj'\n")};
    const auto identity = [&] {
        return describe_identity(experiment, {}, GpuInfo()).at("scene " + experiment.scenes[0]);
    };
    std::set<std::string> seen;
    for (const auto& [name, text] : {std::pair("a.obj", "mtllib a.mtl\n"), std::pair("a.mtl", "map_Kd t.png\n"),
                                     std::pair("t.png", "1"), std::pair("t.png", "2")}) {
        folder.write(name, text);
        EXPECT_TRUE(seen.insert(identity()).second) << name;
        EXPECT_FALSE(seen.insert(identity()).second) << name;
    }
}

} // namespace
} // namespace ssrlab
