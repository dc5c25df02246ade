// glTF as other programs write it: skins, instances, hidden nodes, odd accessors, normals and materials.
#include "scene/sequence.h"
#include "scene_files.h"

namespace ssrlab {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr float eps = 1e-5F;

// A grey 1 x 1 PNG: 128 of 255.
constexpr const char* pixel_png =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==";

/// Two triangles over the same quad in the plane z = 0, facing +z, with indices from `accessor`.
GltfFile quad()
{
    GltfFile  file;
    const int positions         = file.positions({-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0});
    file.root["meshes"]         = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}}};
    file.root["nodes"]          = {{{"mesh", 0}}};
    file.primitive()["indices"] = file.add_accessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 1);
    return file;
}

std::vector<glm::vec3> corners_of(const Scene& scene)
{
    std::vector<glm::vec3> corners;
    for (size_t i = 0; i < scene.indices.size(); ++i) corners.push_back(corner(scene, i));
    return corners;
}

TEST(ForeignGltf, IndicesMayBeSparse)
{
    for (const bool has_base : {true, false})
        for (const bool binary : {false, true}) {
            TempFolder folder;
            GltfFile   file     = quad();
            const auto expected = corners_of(load_scene(file.write(folder)));
            json&      accessor = file.root["accessors"][1];
            if (has_base)
                file.primitive()["indices"] = file.add_accessor<uint16_t>({0, 1, 2, 0, 0, 0}, "SCALAR", 1);
            else
                accessor.erase("bufferView"); // all zeros
            const int  places = has_base ? file.add_accessor<uint16_t>({4, 5}, "SCALAR", 1)
                                         : file.add_accessor<uint16_t>({1, 2, 4, 5}, "SCALAR", 1);
            const int  values = has_base ? file.add_accessor<uint16_t>({2, 3}, "SCALAR", 1)
                                         : file.add_accessor<uint16_t>({1, 2, 2, 3}, "SCALAR", 1);
            const auto view   = [&](int number) { return file.root["accessors"][size_t(number)]["bufferView"]; };
            file.root["accessors"][file.primitive()["indices"].get<size_t>()]["sparse"] = {
                {"count", has_base ? 2 : 4},
                {"indices", {{"bufferView", view(places)}, {"componentType", 5123}}},
                {"values", {{"bufferView", view(values)}}}};
            file.root.erase("buffers"); // of before
            const std::string path = binary ? folder.write("q.glb", file.glb()) : file.write(folder);
            EXPECT_EQ(corners_of(load_scene(path)), expected) << has_base << binary;
        }
}

TEST(ForeignGltf, CompressedMeshesNameTheExtensionAndTheCure)
{
    TempFolder folder;
    GltfFile   draco                = quad();
    draco.root["extensionsUsed"]    = {"KHR_draco_mesh_compression"};
    draco.primitive()["extensions"] = {
        {"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", json::object()}}}};
    EXPECT_EQ(load_scene(draco.write(folder)).indices.size(), 6U) << "with a plain copy";
    for (auto& accessor : draco.root["accessors"]) accessor.erase("bufferView");
    EXPECT_THAT(error_of<SpecError>(draco.write(folder)),
                AllOf(HasSubstr("/meshes/0/primitives/0 is compressed by KHR_draco_mesh_compression"),
                      HasSubstr("gltf-transform")));
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        GltfFile meshopt               = quad();
        meshopt.root["extensionsUsed"] = {name};
        meshopt.root["buffers"]        = {{{"uri", "data.bin"}, {"byteLength", meshopt.binary.size()}},
                                          {{"byteLength", 100}, {"extensions", {{name, {{"fallback", true}}}}}}};
        EXPECT_THAT(error_of<SpecError>(meshopt.write(folder)),
                    AllOf(HasSubstr(std::string("/buffers/1 is compressed by ") + name), HasSubstr("gltf-transform")));
    }
}

TEST(ForeignGltf, RequiredExtensionsThatAreMissingNameTheCure)
{
    TempFolder folder;
    for (const auto& [name, cure] :
         {std::pair("KHR_draco_mesh_compression", "decompress"), std::pair("EXT_meshopt_compression", "decompress"),
          std::pair("EXT_texture_webp", "convert the textures to PNG"),
          std::pair("KHR_texture_basisu", "convert the textures to PNG")}) {
        GltfFile file                   = quad();
        file.root["extensionsRequired"] = {name};
        const std::string path          = file.write(folder);
        EXPECT_THAT(error_of<SpecError>(path), AllOf(HasSubstr(path), HasSubstr(name), HasSubstr(cure)));
    }
}

TEST(ForeignGltf, ExtensionsThatAreAppliedGiveNoWarning)
{
    GltfFile file               = quad();
    file.root["extensionsUsed"] = {"KHR_materials_ior",          "KHR_materials_specular",
                                   "KHR_materials_clearcoat",    "KHR_node_visibility",
                                   "KHR_texture_transform",      "EXT_mesh_gpu_instancing",
                                   "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness"};
    EXPECT_THAT(file.load().warnings, IsEmpty());
}

TEST(ForeignGltf, WhatIsLeftOutOfAMaterialIsNamed)
{
    TempFolder folder;
    GltfFile   file              = quad();
    file.primitive()["material"] = 0;
    file.primitive()["attributes"]["COLOR_0"] =
        file.add_accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3", 3);
    file.root["materials"] = {
        {{"extensions", {{"KHR_materials_unlit", json::object()}}}},
        {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
         {"extensions",
          {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", {{"index", 0}}}}}}}}};
    EXPECT_THAT(load_scene(file.write(folder)).warnings,
                ::testing::UnorderedElementsAre(HasSubstr("vertex colours of an unlit material are not supported"),
                                                HasSubstr("textures of KHR_materials_clearcoat are not supported")));
}

TEST(ForeignGltf, ACutoffAboveOneIsKept)
{
    GltfFile file                = quad();
    file.primitive()["material"] = 0;
    file.root["materials"]       = {{{"alphaMode", "MASK"}, {"alphaCutoff", 1.1}}};
    const Scene scene            = file.load();
    EXPECT_FLOAT_EQ(scene.materials.at(scene.draws.at(0).material).alpha_cutoff, 1.1F);
}

// u to the right and v down, as in a picture: the map's x points right and its y up, against v (glTF 2.0, 3.9.3).
TEST(ForeignGltf, TangentsFollowTheTexturesTransform)
{
    const auto tangent_of = [](const json& transform) {
        GltfFile file                                = quad();
        file.primitive()["material"]                 = 0;
        file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
        file.root["images"]                          = {{{"uri", pixel_png}}};
        file.root["textures"]                        = {{{"source", 0}}};
        json texture                                 = {{"index", 0}};
        if (!transform.is_null()) texture["extensions"] = {{"KHR_texture_transform", transform}};
        file.root["materials"] = {{{"normalTexture", texture}}};
        return file.load().vertices.at(0).tangent_ws;
    };
    EXPECT_VEC_NEAR(tangent_of(nullptr), glm::vec4(1, 0, 0, 1), eps);
    EXPECT_VEC_NEAR(tangent_of({{"scale", {-1, 1}}}), glm::vec4(-1, 0, 0, -1), eps);
    EXPECT_VEC_NEAR(tangent_of({{"scale", {1, -1}}}), glm::vec4(1, 0, 0, -1), eps);
    // A quarter turn takes (u, v) to (v, -u) (the extension's README), so u grows where v did: downwards.
    EXPECT_VEC_NEAR(tangent_of({{"rotation", std::numbers::pi / 2}}), glm::vec4(0, -1, 0, 1), eps);
}

/// The quad, normal mapped, with these texture coordinates, and these tangents if there are any.
GltfFile mapped_quad(const std::vector<float>& uv, const std::vector<float>& tangents)
{
    GltfFile file                                = quad();
    file.primitive()["material"]                 = 0;
    file.primitive()["attributes"]["NORMAL"]     = file.positions({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>(uv, "VEC2", 2);
    if (!tangents.empty()) file.primitive()["attributes"]["TANGENT"] = file.add_accessor<float>(tangents, "VEC4", 4);
    file.root["images"]    = {{{"uri", pixel_png}}};
    file.root["textures"]  = {{{"source", 0}}};
    file.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    return file;
}

TEST(ForeignGltf, WhatTexturesLackIsNamed)
{
    GltfFile file = mapped_quad({0, 1, 1, 1, 1, 0, 0, 0}, {});
    EXPECT_THAT(file.load().warnings, IsEmpty());
    GltfFile no_coordinates = file;
    no_coordinates.primitive()["attributes"].erase("TEXCOORD_0");
    EXPECT_THAT(no_coordinates.load().warnings,
                Contains(HasSubstr("/meshes/0/primitives/0/attributes has no TEXCOORD_0")));
    GltfFile no_image         = file;
    no_image.root["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
    EXPECT_THAT(no_image.load().warnings, Contains(HasSubstr("/textures/0 names no PNG or JPEG image")));
    file.root["materials"][0]["occlusionTexture"] = {{"index", 0}};
    EXPECT_THAT(file.load().warnings, Contains(HasSubstr("occlusion textures are not supported")));
}

TEST(ForeignGltf, TangentsAreForNormalMapsAlone)
{
    GltfFile file = mapped_quad({0, 1, 1, 1, 1, 0, 0, 0}, {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1});
    for (const Vertex& vertex : file.load().vertices) EXPECT_VEC_NEAR(vertex.tangent_ws, glm::vec4(0, 1, 0, 1), eps);
    file.root["materials"] = {json::object()};
    for (const Vertex& vertex : file.load().vertices) EXPECT_EQ(vertex.tangent_ws, glm::vec4(0));
}

TEST(ForeignGltf, TangentsWithoutDirectionBecomeThoseOfTheTexture)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const glm::vec4& bad : {glm::vec4(0), glm::vec4(nan), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 1, 1)}) {
        const Scene scene = mapped_quad({0, 1, 1, 1, 1, 0, 0, 0}, {bad.x, bad.y, bad.z, bad.w, 0, 1, 0, -1, 0, 1, 0, -1,
                                                                   bad.x, bad.y, bad.z, bad.w})
                                .load();
        ASSERT_EQ(scene.vertices.size(), 4U);
        for (const Vertex& vertex : scene.vertices)
            EXPECT_VEC_NEAR(vertex.tangent_ws,
                            vertex.position_ws.x < 0 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 1, 0, -1), eps);
        EXPECT_THAT(scene.warnings, Contains(HasSubstr("2 vertices have tangents without direction")));
    }
}

TEST(ForeignGltf, MirroredTexturesHaveTangentsOfBothSides)
{
    // The second triangle shows the texture mirrored; both share two corners.
    const Scene scene = mapped_quad({0, 0, 1, 0, 0, 1, 1, 0}, {}).load();
    ASSERT_EQ(scene.indices.size(), 6U);
    EXPECT_EQ(scene.vertices.size(), 6U);
    for (size_t i = 0; i < 6; ++i) {
        const Vertex& vertex = scene.vertices[scene.indices[i]];
        // u grows along +x in the first and along +y in the second, v towards (2, 1) in both.
        const glm::vec3 expected = i < 3 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
        EXPECT_VEC_NEAR(glm::vec3(vertex.tangent_ws), expected, eps) << i;
        EXPECT_EQ(vertex.tangent_ws.w, i < 3 ? -1.0F : 1.0F) << i;
    }
}

TEST(ForeignGltf, ColoursOfWholeNumbersAreShares)
{
    for (const bool normalized : {true, false}) {
        GltfFile  file     = quad();
        const int accessor = file.add_accessor<uint16_t>(
            {65535, 0, 13107, 65535, 0, 13107, 65535, 0, 13107, 65535, 0, 13107}, "VEC3", 3);
        file.root["accessors"][size_t(accessor)]["normalized"] = normalized;
        file.primitive()["attributes"]["COLOR_0"]              = accessor;
        const Scene scene                                      = file.load();
        for (const Vertex& vertex : scene.vertices) EXPECT_VEC_NEAR(vertex.colour, glm::vec4(1, 0, 0.2F, 1), eps);
        if (normalized)
            EXPECT_THAT(scene.warnings, IsEmpty());
        else
            EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("COLOR_0"), HasSubstr("shares of 65535"))));
    }
}

TEST(ForeignGltf, UnlitIsUnlitWhateverElseAMaterialSays)
{
    GltfFile file                                = quad();
    file.primitive()["material"]                 = 0;
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    file.root["images"]                          = {{{"uri", pixel_png}}};
    file.root["textures"]                        = {{{"source", 0}}};
    file.root["materials"]                       = {
                              {{"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.5, 0.25, 0.125, 1}}, {"metallicRoughnessTexture", {{"index", 0}}}}},
                               {"emissiveFactor", {1, 1, 1}},
                               {"extensions",
                                {{"KHR_materials_unlit", json::object()},
                                 {"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}},
                                 {"KHR_materials_ior", {{"ior", 2}}}}}}};
    const Scene    scene    = file.load();
    const Material material = scene.materials.at(scene.draws.at(0).material);
    EXPECT_VEC_NEAR(material.emissive, glm::vec3(0.5F, 0.25F, 0.125F), eps);
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.metallic_roughness_texture.texture, -1);
    EXPECT_EQ(material.dielectric_f0, 0);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST(ForeignGltf, NormalsWithoutDirectionBecomeTheTriangles)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {0.0F, nan}) {
        GltfFile  file      = GltfFile();
        const int positions = file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1});
        // Both triangles share the first two corners; only the second corner has a normal.
        const int normals =
            file.add_accessor<float>({bad, bad, bad, 0, 0.6F, 0.8F, bad, bad, bad, bad, bad, bad}, "VEC3", 3);
        file.root["nodes"]  = {{{"mesh", 0}}};
        file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}}}}}};
        file.primitive()["indices"] = file.add_accessor<uint16_t>({0, 1, 2, 0, 3, 1}, "SCALAR", 1);
        const Scene scene           = file.load();
        ASSERT_EQ(scene.indices.size(), 6U);
        for (size_t i = 0; i < 6; ++i) {
            const glm::vec3 expected =
                corner(scene, i).x == 1 ? glm::vec3(0, 0.6F, 0.8F) : geometric_normal(scene, i / 3);
            EXPECT_VEC_NEAR(scene.vertices[scene.indices[i]].normal_ws, expected, eps);
        }
        EXPECT_THAT(scene.warnings, Contains(HasSubstr("4 corners of triangles have normals without direction")));
    }
}

TEST(ForeignGltf, FlattenedNodesFaceAlongTheirPlane)
{
    GltfFile file = quad();
    file.primitive()["attributes"]["NORMAL"] =
        file.add_accessor<float>({0, 0, 1, 0.6F, 0, 0.8F, 0, 0, 1, 1, 0, 0}, "VEC3", 3);
    file.root["nodes"] = {{{"mesh", 0}, {"scale", {1, 1, 0}}}};
    const Scene scene  = file.load();
    ASSERT_EQ(scene.indices.size(), 6U);
    for (const Vertex& vertex : scene.vertices) EXPECT_VEC_NEAR(vertex.normal_ws, glm::vec3(0, 0, 1), eps);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("1 corners of triangles"))) << "the one that lay in the plane";
}

Material material_from(GltfFile file, const json& values)
{
    file.primitive()["material"] = 0;
    file.root["materials"]       = {{{"extensions", {{"KHR_materials_pbrSpecularGlossiness", values}}}}};
    const Scene scene            = file.load();
    EXPECT_THAT(scene.warnings, IsEmpty());
    return scene.materials.at(scene.draws.at(0).material);
}

TEST(ForeignGltf, SpecularAndGlossinessBecomeMetalAndRoughness)
{
    const Material plaster = material_from(
        quad(),
        {{"diffuseFactor", {0.8, 0.1, 0.1, 1}}, {"specularFactor", {0.04, 0.04, 0.04}}, {"glossinessFactor", 0.1}});
    EXPECT_VEC_NEAR(plaster.base_colour, glm::vec4(0.8F, 0.1F, 0.1F, 1), eps);
    EXPECT_NEAR(plaster.metallic, 0, eps);
    EXPECT_NEAR(plaster.roughness, 0.9F, eps);
    EXPECT_NEAR(plaster.dielectric_f0, 0.04F, eps);
    const Material gold = material_from(
        quad(), {{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1, 0.8, 0.3}}, {"glossinessFactor", 1}});
    EXPECT_VEC_NEAR(gold.base_colour, glm::vec4(1, 0.8F, 0.3F, 1), eps);
    EXPECT_EQ(glm::vec2(gold.metallic, gold.roughness), glm::vec2(1, 0));
    const Material chalk = material_from(quad(), {{"specularFactor", {0, 0, 0}}, {"glossinessFactor", 0}});
    EXPECT_EQ(glm::vec3(chalk.metallic, chalk.roughness, chalk.dielectric_f0), glm::vec3(0, 1, 0))
        << "reflects nothing";
}

// The texture is 128 of 255 in all channels but alpha, which is 1: 0.2159 linear.
TEST(ForeignGltf, TexturesOfSpecularAndGlossinessAreConverted)
{
    GltfFile file                                = quad();
    file.root["images"]                          = {{{"uri", pixel_png}}};
    file.root["textures"]                        = {{{"source", 0}}};
    file.primitive()["material"]                 = 0;
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    file.root["materials"]                       = {{{"extensions",
                                                      {{"KHR_materials_pbrSpecularGlossiness",
                                                        {{"diffuseFactor", {0, 0, 0, 1}},
                                                         {"glossinessFactor", 0.75},
                                                         {"specularGlossinessTexture", {{"index", 0}}}}}}}}};
    const Scene     scene                        = file.load();
    const Material& material                     = scene.materials.at(scene.draws.at(0).material);
    const auto      texel                        = [&](const TextureUse& use, size_t c) {
        return int(scene.textures.at(size_t(use.texture)).rgba.at(c));
    };
    const double f0 = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), metallic = (f0 - 0.04) / 0.96;
    EXPECT_EQ(glm::vec2(material.metallic, material.roughness), glm::vec2(1, 1)) << "the textures say it";
    EXPECT_NEAR(texel(material.metallic_roughness_texture, 1), 255 * 0.25, 1);
    EXPECT_NEAR(texel(material.metallic_roughness_texture, 2), 255 * metallic, 1);
    const double base = metallic * f0; // of a black surface
    EXPECT_NEAR(texel(material.base_colour_texture, 0), 255 * (1.055 * std::pow(base, 1 / 2.4) - 0.055), 1);
    EXPECT_TRUE(scene.textures.at(size_t(material.base_colour_texture.texture)).srgb);
    EXPECT_FALSE(scene.textures.at(size_t(material.metallic_roughness_texture.texture)).srgb);
}

TEST(ForeignGltf, HiddenNodesShowNothingBelowThemButCameras)
{
    GltfFile file        = quad();
    file.root["cameras"] = {{{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.root["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "point"}, {"intensity", 7}}}}}}};
    const json hidden       = {{"KHR_node_visibility", {{"visible", false}}}},
               shown        = {{"KHR_node_visibility", {{"visible", true}}}};
    file.root["nodes"]      = {{{"children", {1, 2, 3}}, {"extensions", hidden}},
                               {{"mesh", 0}, {"extensions", shown}}, // its parent is not
                               {{"camera", 0}},
                               {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    const Scene scene       = file.load();
    EXPECT_TRUE(scene.draws.empty());
    EXPECT_EQ(scene.cameras.at(0).name, "eye");
    EXPECT_EQ(scene.lights.at(0).type, LightType::directional) << "the default light";
    file.root["nodes"][0]["extensions"] = shown;
    EXPECT_EQ(file.load().draws.size(), 1U);
}

TEST(ForeignGltf, InstancesAreDrawn)
{
    TempFolder  folder;
    GltfFile    file   = quad();
    const int   at     = file.add_accessor<float>({10, 0, 0, 0, 20, 0}, "VEC3", 3);
    const float half   = std::numbers::sqrt2_v<float> / 2;
    const int   turned = file.add_accessor<float>({0, 0, 0, 1, 0, 0, half, half}, "VEC4", 4);
    const int   scaled = file.add_accessor<float>({1, 1, 1, 2, 3, 1}, "VEC3", 3);
    file.root["nodes"] = {{{"mesh", 0},
                           {"translation", {0, 0, 5}},
                           {"extensions",
                            {{"EXT_mesh_gpu_instancing",
                              {{"attributes", {{"TRANSLATION", at}, {"ROTATION", turned}, {"SCALE", scaled}}}}}}}}};
    const Scene scene  = load_scene(file.write(folder));
    ASSERT_EQ(scene.draws.size(), 2U);
    const auto second = [&](size_t i) { return corner(scene, scene.draws[1].first_index + i); };
    EXPECT_VEC_NEAR(corner(scene, 0), glm::vec3(9, 0, 5), eps);
    // (1, 1, 0), scaled to (2, 3, 0), turned a quarter about z to (-3, 2, 0), moved.
    EXPECT_VEC_NEAR(second(2), glm::vec3(-3, 22, 5), eps);
    auto& attributes = file.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    file.root["accessors"][size_t(at)]["count"] = 1;
    EXPECT_THAT(error_of<Failure>(file.write(folder)),
                HasSubstr("EXT_mesh_gpu_instancing/attributes/TRANSLATION: 1 rows, expected 2"));
    attributes = {{"_ID", scaled}};
    EXPECT_EQ(load_scene(file.write(folder)).draws.size(), 2U) << "their number is that of any attribute";
    attributes = {{"_ID", "first"}};
    EXPECT_THAT(error_of<Failure>(file.write(folder)), HasSubstr("/_ID: expected the number of an accessor"));
}

/// A quad of 2 m x 1 m that was bound in units of 1 cm, with two joints on top of each other.
GltfFile skinned()
{
    GltfFile  file          = quad();
    const int joints        = file.add_accessor<uint16_t>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    const int weights       = file.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0}, "VEC4", 4);
    auto&     attributes    = file.primitive()["attributes"];
    attributes["JOINTS_0"]  = joints;
    attributes["WEIGHTS_0"] = weights; // those of the upper corners add up to 2: they are shares of their sum
    const int bind =
        file.add_accessor<float>({100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 0,    0, 1,  //
                                  100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, -100, 0, 1}, // its joint is at (0, 1, 0)
                                 "MAT4", 16);
    file.root["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", bind}}};
    file.root["nodes"] = {{{"scale", {0.01, 0.01, 0.01}}, {"children", {1, 2}}},
                          {{"mesh", 0}, {"skin", 0}, {"translation", {500, 500, 500}}}, // which does not count
                          {{"name", "hips"}, {"children", {3}}},
                          {{"name", "head"}, {"translation", {0, 100, 0}}}};
    return file;
}

TEST(ForeignGltf, SkinsAreInTheirJointsPose)
{
    TempFolder        folder;
    GltfFile          file = skinned();
    const Scene       rest = load_scene(file.write(folder));
    const std::vector expected{glm::vec3(-1, 0, 0), glm::vec3(1, 0, 0), glm::vec3(1, 1, 0)};
    for (size_t i = 0; i < 3; ++i) EXPECT_VEC_NEAR(corner(rest, i), expected[i], eps);
    EXPECT_THAT(rest.warnings, IsEmpty());
    EXPECT_FALSE(anything_moves(rest));
    file.root["nodes"][3]["rotation"] = {0, 0, std::numbers::sqrt2 / 2,
                                         std::numbers::sqrt2 / 2}; // the head a quarter about z
    const Scene bent                  = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(corner(bent, 0), glm::vec3(-1, 0, 0), eps);
    EXPECT_VEC_NEAR(corner(bent, 2), glm::vec3(0, 2, 0), eps) << "(1, 0) from the head became (0, 1)";
    file.root["skins"][0]["joints"] = {2, 9};
    EXPECT_THAT(error_of<Failure>(file.write(folder)), HasSubstr("/skins/0: there is no node 9"));
}

TEST(ForeignGltf, WhatNoJointMovesStandsByItsNode)
{
    TempFolder folder;
    GltfFile   file                      = skinned();
    file.root["nodes"][1]["translation"] = {500, 0, 0}; // below a node with a scale of 0.01
    file.primitive()["attributes"].erase("JOINTS_0");
    const Scene scene = load_scene(file.write(folder));
    EXPECT_VEC_NEAR(scene.origin_ws + glm::dvec3(corner(scene, 0)), glm::dvec3(4.99, 0, 0), 1e-6);
}

TEST(ForeignGltf, JointsThatTheSkinLacksAreRefused)
{
    TempFolder folder;
    GltfFile   file                 = skinned();
    file.root["skins"][0]["joints"] = {2};
    EXPECT_THAT(error_of<Failure>(file.write(folder)),
                HasSubstr("a vertex follows joint 1, but the skin has 1 joints"));
}

TEST(ForeignGltf, AnimatedJointsBendTheirMeshInEveryFrame)
{
    GltfFile    file        = skinned();
    const float half        = std::numbers::sqrt2_v<float> / 2;
    const int   times_s     = file.add_accessor<float>({0, 1}, "SCALAR", 1);
    const int   turns       = file.add_accessor<float>({0, 0, 0, 1, half, 0, 0, half}, "VEC4", 4); // a quarter about x
    file.root["animations"] = {{{"samplers", {{{"input", times_s}, {"output", turns}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
    const Scene scene       = file.load();
    EXPECT_TRUE(anything_moves(scene));
    EXPECT_VEC_NEAR(corner(scene, 2), glm::vec3(1, 1, 0), eps);
    const Scene last = scene_at(scene, 30), after = scene_at(scene, 99);
    EXPECT_VEC_NEAR(corner(last, 2), glm::vec3(1, 0, 1), eps);
    EXPECT_VEC_NEAR(corner(last, 0), glm::vec3(-1, 0, 0), eps);
    EXPECT_VEC_NEAR(last.vertices.at(last.indices[2]).normal_ws, glm::vec3(0, -1, 0), eps);
    EXPECT_EQ(corner(after, 2), corner(last, 2));
    EXPECT_NEAR(last.draws.at(0).bounds_max_ws.z, 1, eps);
    const auto motion = motion_at(scene, scene.cameras.at(0).name, {64, 36}, 5);
    ASSERT_TRUE(motion.has_value());
    EXPECT_EQ(motion->moving_draws, 1);
    EXPECT_TRUE(std::isnan(motion->to_previous_ws.at(0)[0][0])) << "no one matrix says where all points were";
}

// A floor of 10,000 km about the origin, and what is looked at far out on it.
TEST(ForeignGltf, FarOutOnALargeSceneTheOriginIsAtTheCamera)
{
    for (const double x_m : {50.0, 5e4, 5e6}) {
        GltfFile  file  = GltfFile::triangle();
        const int floor = file.positions({-1e7F, 0, -1e7F, 0, 0, 1e7F, 1e7F, 0, -1e7F});
        file.root["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", floor}}}}}}});
        file.root["cameras"] = {
            {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
        file.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
        file.root["nodes"]  = {{{"mesh", 0}, {"translation", {x_m, 0.1, 0}}, {"scale", {0.01, 0.01, 0.01}}},
                               {{"mesh", 1}},
                               {{"camera", 0}, {"translation", {x_m, 1, 3}}}};
        const Scene scene   = file.load();
        EXPECT_NEAR(glm::length(scene.origin_ws), x_m < 1000 ? 0 : x_m, 10) << x_m;
        EXPECT_VEC_NEAR(glm::dvec3(corner(scene, 1) - corner(scene, 0)), glm::dvec3(0.01, 0, 0),
                        1e-7 + 1e-7 * std::min(x_m, 100.0));
        EXPECT_THAT(scene.warnings, IsEmpty());
    }
}

TEST(ForeignGltf, ViewsFarFromTheOriginAreNamed)
{
    GltfFile file        = GltfFile::triangle();
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "near"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}},
        {{"type", "perspective"}, {"name", "away"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.root["scenes"] = {{{"nodes", {0, 1, 2}}}};
    file.root["nodes"]  = {
         {{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 3}}}, {{"camera", 1}, {"translation", {9e4, 0, 0}}}};
    EXPECT_THAT(file.load().warnings, testing::ElementsAre(HasSubstr("view 'away' is 9e+04 m away")));
}

} // namespace
} // namespace ssrlab
