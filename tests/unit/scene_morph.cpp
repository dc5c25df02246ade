// Morph targets against their sums worked out by hand.
#include "scene_files.h"

namespace ssrlab {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float eps = 1e-6F;

/// The first target moves corner 1 by (0, 0, 2), the second corner 2 by (4, 0, 0).
struct MorphingFile : GltfFile {
    MorphingFile() : GltfFile(GltfFile::triangle())
    {
        const int up = positions({0, 0, 0, 0, 0, 2, 0, 0, 0}), aside = positions({0, 0, 0, 0, 0, 0, 4, 0, 0});
        primitive()["targets"] = {{{"POSITION", up}}, {{"POSITION", aside}}};
    }

    void animate(const std::vector<float>& times_s, const std::vector<float>& weights, const char* interpolation)
    {
        root.erase("buffers"); // an earlier file's
        const int input = add_accessor(times_s, "SCALAR", 1), output = add_accessor(weights, "SCALAR", 1);
        root["animations"] = {{{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                               {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    }
};

TEST(SceneMorph, TargetsAreAddedByTheWeightsOfTheMeshOrTheNode)
{
    TempFolder   folder;
    MorphingFile file;
    EXPECT_VEC_NEAR(corner(load_scene(file.write(folder)), 1), glm::vec3(1, 0, 0), eps) << "without weights: at rest";
    file.root["meshes"][0]["weights"] = {0.5, 0};
    const Scene half                  = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(corner(half, 1), glm::vec3(1, 0, 1), eps);
    EXPECT_VEC_NEAR(corner(half, 2), glm::vec3(0, 1, 0), eps);
    EXPECT_THAT(half.warnings, IsEmpty());
    // A second node with weights of its own shows another shape of the same mesh.
    file.root["nodes"].push_back({{"mesh", 0}, {"weights", {0, 0.25}}});
    file.root["scenes"][0]["nodes"] = {0, 1};
    const Scene both                = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(corner(both, 1), glm::vec3(1, 0, 1), eps);
    EXPECT_VEC_NEAR(corner(both, 3 + 1), glm::vec3(1, 0, 0), eps);
    EXPECT_VEC_NEAR(corner(both, 3 + 2), glm::vec3(1, 1, 0), eps);
}

TEST(SceneMorph, NormalsTurnWithTheirTargets)
{
    TempFolder   folder;
    MorphingFile file;
    file.primitive()["attributes"]["NORMAL"] = file.positions({0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.primitive()["targets"][0]["NORMAL"] = file.positions({3, 0, 3, 3, 0, 3, 3, 0, 3});
    file.root["meshes"][0]["weights"]        = {1, 0};
    const Scene scene                        = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(scene.vertices[0].normal_ws, glm::vec3(0.6F, 0, 0.8F), eps); // (3, 0, 4), of length 1
}

TEST(SceneMorph, ColoursAndTextureCoordinatesAreAddedToo)
{
    MorphingFile file;
    json&        attributes           = file.primitive()["attributes"];
    json&        target               = file.primitive()["targets"][0];
    attributes["COLOR_0"]             = file.add_accessor<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
    target["COLOR_0"]                 = file.add_accessor<float>({-1, 1, 2, 0, -1, 1, 0, 0, -1, 1, 0, -1}, "VEC4", 4);
    attributes["TEXCOORD_0"]          = file.add_accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    target["TEXCOORD_0"]              = file.add_accessor<float>({0, 0, 2, 4, 0, 0}, "VEC2", 2);
    attributes["TEXCOORD_1"]          = file.add_accessor<float>({0, 0, 0, 0, 0, 0}, "VEC2", 2);
    target["TEXCOORD_1"]              = file.add_accessor<float>({8, 0, 0, 0, 0, 0}, "VEC2", 2);
    file.root["meshes"][0]["weights"] = {0.5, 0};
    const Scene scene                 = file.load();
    EXPECT_VEC_NEAR(scene.vertices[0].colour, glm::vec4(0.5F, 0.5F, 1, 1), eps);
    EXPECT_VEC_NEAR(scene.vertices[2].colour, glm::vec4(0.5F, 0.5F, 0, 0.5F), eps);
    EXPECT_EQ(scene.vertices[1].uv0, glm::vec2(2, 2));
    EXPECT_EQ(scene.vertices[0].uv1, glm::vec2(4, 0));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(SceneMorph, AnimatedOnesHaveTheWeightsOfTheirFirstKey)
{
    TempFolder   folder;
    MorphingFile file;
    file.animate({0.5, 1}, {1, 0, 0, 1}, "LINEAR");
    const Scene linear = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(corner(linear, 1), glm::vec3(1, 0, 2), eps);
    EXPECT_THAT(linear.warnings,
                Contains(HasSubstr("animated morph targets are not supported: they stay as in frame 0")));
    file.animate({0}, {9, 9, 0, 0.5, 9, 9}, "CUBICSPLINE"); // arriving tangents, values, leaving tangents
    const Scene cubic = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(corner(cubic, 1), glm::vec3(1, 0, 0), eps);
    EXPECT_VEC_NEAR(corner(cubic, 2), glm::vec3(2, 1, 0), eps);
}

TEST(SceneMorph, BrokenOnesAreRefusedWithTheirPlace)
{
    TempFolder   folder;
    MorphingFile file;
    file.root["meshes"][0]["weights"] = {1};
    EXPECT_THAT(error_of<Failure>(file.write(folder)),
                HasSubstr("/meshes/0/primitives/0/targets: 2 targets, expected 1 as there are weights"));
    file.root["meshes"][0]["weights"] = {1, 1};
    file.root.erase("buffers");
    file.primitive()["targets"][1]["POSITION"] = file.positions({0, 0, 0});
    EXPECT_THAT(error_of<Failure>(file.write(folder)),
                HasSubstr("/meshes/0/primitives/0/targets/1/POSITION: 1 elements for 3 positions"));
    file.animate({0, 1}, {1, 0, 0}, "LINEAR");
    EXPECT_THAT(error_of<Failure>(file.write(folder)),
                HasSubstr("/animations/0/samplers/0/output: 3 values cannot be shared among 2 keys"));
}

} // namespace
} // namespace ssrlab
