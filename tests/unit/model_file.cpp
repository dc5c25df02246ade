// Models over which assimp falls: each must end in a message that names the file, and in time.
#include "scene/model_file.h"

#include "errors.h"
#include "scene_files.h"

#include "core/error.h"

#include <sys/stat.h>

namespace ssrlab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string obj = "mtllib model.mtl\nv -1 0 0\nv 1 0 0\nv 1 1 0\nusemtl paint\nf 1 2 3\n";
const std::string mtl = "newmtl paint\nKd 0.8 0.4 0.2\nNs 50\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

std::string refused(const std::string& file)
{
    return message_of<Failure>([&] { read_model_file(file); });
}

TEST(ModelFile, HoldsWhatTheFileSays)
{
    TempFolder folder;
    folder.write("model.mtl", mtl + "map_Kd image.png\nd 0.25\n");
    const FileModel model = read_model_file(folder.write("model.obj", obj));
    ASSERT_EQ(model.meshes.size(), 1U);
    const Mesh& mesh = model.meshes[0];
    EXPECT_EQ(mesh.positions_ws.size(), 3U);
    EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
    EXPECT_FALSE(mesh.has_normals);
    const FileMaterial& material = model.materials.at(mesh.material);
    EXPECT_EQ(material.name, "paint");
    EXPECT_EQ(material.texture, "image.png");
    EXPECT_EQ(material.diffuse, glm::vec3(0.8F, 0.4F, 0.2F));
    EXPECT_EQ(material.opacity, 0.25F);
}

TEST(ModelFile, LinesOfObjMayBeIndentedAndNumbersBeginWithTheirPoint)
{
    TempFolder      folder;
    const FileModel model = read_model_file(folder.write(
        "model.obj",
        "v 9 9 9\n  v .5 0 0\nv\t-.25\t+.5 1.\r\nv 0 \\\n 1 .125\nv 7 7 7\nvn .6 0 .8\nf 2//1 3//1 4//1\n"));
    ASSERT_EQ(model.meshes.size(), 1U);
    const Mesh& mesh = model.meshes[0];
    ASSERT_EQ(mesh.positions_ws.size(), 3U);
    EXPECT_EQ(mesh.positions_ws[mesh.indices[0]], glm::dvec3(0.5, 0, 0));
    EXPECT_EQ(mesh.positions_ws[mesh.indices[1]], glm::dvec3(-0.25, 0.5, 1));
    EXPECT_EQ(mesh.positions_ws[mesh.indices[2]], glm::dvec3(0, 1, 0.125));
    EXPECT_NEAR(mesh.vertices[0].normal_ws.x, 0.6, 1e-6);
}

TEST(ModelFile, CommentsStandBehindNumbersAndNotInNames)
{
    TempFolder folder;
    folder.write("model.mtl", "newmtl red#2\nKd 1 0 0\n");
    const FileModel model =
        read_model_file(folder.write("model.obj", "# first\nmtllib model.mtl\nv 0 0 0 # a\nv 1 0 0 #b\r\nv 0 1 .5# c\n"
                                                  "usemtl red#2\nf 1 2 3 # d\n"));
    ASSERT_EQ(model.meshes.size(), 1U);
    const Mesh& mesh = model.meshes[0];
    ASSERT_EQ(mesh.indices.size(), 3U);
    EXPECT_EQ(mesh.positions_ws[mesh.indices[1]], glm::dvec3(1, 0, 0));
    EXPECT_EQ(mesh.positions_ws[mesh.indices[2]], glm::dvec3(0, 1, 0.5));
    EXPECT_EQ(model.materials.at(mesh.material).name, "red#2");
}

TEST(ModelFile, ACrashOfAssimpIsAnError)
{
    TempFolder folder;
    folder.write("model.mtl", "map_Kd image.png\n" + mtl); // of no material
    const std::string file = folder.write("model.obj", obj);
    EXPECT_THAT(refused(file), AllOf(HasSubstr(file), HasSubstr("assimp fell over it")));
}

TEST(ModelFile, AnEndlessReadIsAnError)
{
    TempFolder        folder;
    const std::string file = folder.write("model.ply", ply.substr(0, 60));
    EXPECT_THAT(refused(file), AllOf(HasSubstr(file), HasSubstr("took more than 5 s")));
}

TEST(ModelFile, APipeBesideTheModelIsNotWaitedFor)
{
    TempFolder folder;
    ASSERT_EQ(::mkfifo((folder.path() / "model.mtl").c_str(), 0600), 0);
    EXPECT_EQ(read_model_file(folder.write("model.obj", obj)).meshes.size(), 1U);
}

TEST(ModelFile, CornersThatAreNotThereAreNamed)
{
    TempFolder        folder;
    const std::string file = folder.write("model.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    EXPECT_THAT(refused(file), AllOf(HasSubstr(file), HasSubstr("out of range")));
}

} // namespace
} // namespace ssrlab
