#include "scene_files.h"

namespace ssrlab {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr float eps = 1e-6F;

// A grey 1 x 1 PNG.
constexpr const char* pixel_png =
    "data:image/"
    "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==";

TEST(SceneGltf, TransformsMultiplyDownTheHierarchy)
{
    GltfFile    file   = GltfFile::triangle();
    const float half   = std::numbers::sqrt2_v<float> / 2;
    file.root["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, half, 0, half}}},
                          {{"mesh", 0}, {"translation", {0, 2, 3}}, {"scale", {2, 2, 2}}}};
    const Scene scene  = file.load();
    ASSERT_EQ(scene.indices.size(), 3U);
    // Turning about y by 90 degrees takes x to -z and z to x.
    EXPECT_VEC_NEAR(corner(scene, 0), glm::vec3(13, 2, 0), 1e-5F);
    EXPECT_VEC_NEAR(corner(scene, 1), glm::vec3(13, 2, -2), 1e-5F);
    EXPECT_VEC_NEAR(corner(scene, 2), glm::vec3(13, 4, 0), 1e-5F);
}

TEST(SceneGltf, MatricesAreColumnMajor)
{
    GltfFile file      = GltfFile::triangle();
    file.root["nodes"] = {{{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
    EXPECT_VEC_NEAR(corner(file.load(), 0), glm::vec3(5, 6, 7), eps);
}

TEST(SceneGltf, IndexedAndUnindexedGiveTheSameTriangles)
{
    TempFolder  folder;
    GltfFile    file    = GltfFile::triangle();
    const Scene plain   = load_scene(file.write(folder, "plain.gltf"));
    file                = GltfFile();
    const int positions = file.positions({0, 1, 0, 9, 9, 9, 0, 0, 0, 1, 0, 0});
    const int indices   = file.add_accessor<uint16_t>({2, 3, 0}, "SCALAR", 1);
    file.root["nodes"]  = {{{"mesh", 0}}};
    file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
    const Scene indexed = load_scene(file.write(folder, "indexed.gltf"));
    ASSERT_EQ(plain.indices.size(), indexed.indices.size());
    EXPECT_EQ(indexed.vertices.size(), 3U) << "unused vertices are dropped";
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(corner(plain, i), corner(indexed, i));
}

TEST(SceneGltf, PrimitivesTakeOfASharedListWhatTheyUse)
{
    GltfFile  file;
    const int positions = file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 3, 0, 0, 2, 1, 0});
    const int red =
        file.add_accessor<float>({0, 0, 0, .1F, 0, 0, .2F, 0, 0, .3F, 0, 0, .4F, 0, 0, .5F, 0, 0}, "VEC3", 3);
    const int      right      = file.add_accessor<uint16_t>({4, 5, 3}, "SCALAR", 1);
    nlohmann::json attributes = {{"POSITION", positions}, {"COLOR_0", red}};
    file.root["nodes"]        = {{{"mesh", 0}}};
    file.root["meshes"]       = {
              {{"primitives", {{{"attributes", attributes}, {"indices", right}}, {{"attributes", attributes}}}}}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.indices.size(), 9U);
    EXPECT_EQ(scene.vertices.size(), 9U);
    for (size_t i = 0; i < 9; ++i) {
        const float at_x   = std::array<float, 9>{3, 2, 2, 0, 1, 0, 2, 3, 2}[i],
                    vertex = std::array<float, 9>{4, 5, 3, 0, 1, 2, 3, 4, 5}[i];
        EXPECT_EQ(corner(scene, i).x, at_x) << i;
        EXPECT_NEAR(scene.vertices[scene.indices[i]].colour.r, 0.1F * vertex, eps) << i;
    }
}

TEST(SceneGltf, StripsAndFansKeepTheirFronts)
{
    for (int mode : {5, 6}) {
        GltfFile  file;
        const int positions = mode == 5 ? file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0})
                                        : file.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0});
        file.root["nodes"]  = {{{"mesh", 0}}};
        file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"mode", mode}}}}}};
        const Scene scene   = file.load();
        ASSERT_EQ(scene.indices.size(), 9U) << "mode " << mode;
        for (size_t i = 0; i < 3; ++i) EXPECT_VEC_NEAR(geometric_normal(scene, i), glm::vec3(0, 0, 1), eps);
    }
}

TEST(SceneGltf, MissingNormalsBecomeFlat)
{
    GltfFile  file      = GltfFile();
    const int positions = file.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    const int indices   = file.add_accessor<uint16_t>({0, 1, 2, 0, 3, 1}, "SCALAR", 1);
    file.root["nodes"]  = {{{"mesh", 0}}};
    file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}}};
    const Scene scene   = file.load();
    ASSERT_EQ(scene.vertices.size(), 6U);
    for (size_t i = 0; i < 6; ++i)
        EXPECT_VEC_NEAR(scene.vertices[scene.indices[i]].normal_ws, geometric_normal(scene, i / 3), eps);
}

TEST(SceneGltf, MirroringNodesKeepFrontsOutside)
{
    GltfFile file                            = GltfFile::triangle();
    file.primitive()["attributes"]["NORMAL"] = file.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    file.root["nodes"]                       = {{{"mesh", 0}, {"scale", {-1, 1, 1}}}};
    const Scene scene                        = file.load();
    EXPECT_VEC_NEAR(geometric_normal(scene, 0), glm::vec3(0, 0, 1), eps);
    EXPECT_VEC_NEAR(scene.vertices[0].normal_ws, glm::vec3(0, 0, 1), eps);
}

TEST(SceneGltf, NonUniformScaleTurnsNormalsByTheInverseTranspose)
{
    GltfFile  file      = GltfFile();
    const int positions = file.positions({0, 0, 0, 1, -1, 0, 0, 0, -1});
    const int normals   = file.add_accessor<float>(
        {0.70710678F, 0.70710678F, 0, 0.70710678F, 0.70710678F, 0, 0.70710678F, 0.70710678F, 0}, "VEC3", 3);
    file.root["nodes"]  = {{{"mesh", 0}, {"scale", {4, 1, 1}}}};
    file.root["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}}}}}};
    const Scene scene   = file.load();
    EXPECT_NEAR(std::abs(glm::dot(scene.vertices[0].normal_ws, geometric_normal(scene, 0))), 1, 1e-5);
}

TEST(SceneGltf, MaterialsHaveTheSpecifiedDefaults)
{
    GltfFile file                = GltfFile::triangle();
    file.root["materials"]       = {{{"name", "bare"}}};
    file.primitive()["material"] = 0;
    const Scene     scene        = file.load();
    const Material& material     = scene.materials[scene.draws[0].material];
    EXPECT_EQ(material.name, "bare");
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.base_colour, glm::vec4(1));
    EXPECT_FALSE(material.double_sided);
    EXPECT_FALSE(material.alpha_mask);
}

TEST(SceneGltf, MaterialsTexturesAndExtensions)
{
    GltfFile file                                = GltfFile::triangle();
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.primitive()["material"]                 = 0;
    file.root["images"]                          = {{{"uri", pixel_png}}};
    file.root["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9729}, {"wrapS", 33071}, {"wrapT", 33648}}};
    file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    const json transform  = {
         {"KHR_texture_transform",
          {{"offset", {0.25, 0.5}}, {"rotation", std::numbers::pi / 2}, {"scale", {2, 3}}, {"texCoord", 1}}}};
    file.root["materials"]   = {{{"pbrMetallicRoughness",
                                  {{"baseColorTexture", {{"index", 0}, {"extensions", transform}}},
                                   {"metallicRoughnessTexture", {{"index", 0}}},
                                   {"metallicFactor", 0.5},
                                   {"roughnessFactor", -2.5}}},
                                 {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                                 {"emissiveFactor", {1, 0.5, 0}},
                                 {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}},
                                 {"alphaMode", "MASK"},
                                 {"alphaCutoff", 0.25},
                                 {"doubleSided", true}}};
    const Scene     scene    = file.load();
    const Material& material = scene.materials[scene.draws[0].material];
    EXPECT_FLOAT_EQ(material.metallic, 0.5F);
    EXPECT_EQ(material.roughness, 0) << "negative roughness is clamped";
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("clamped")));
    EXPECT_EQ(material.emissive, glm::vec3(4, 2, 0));
    file.root["materials"][0]["emissiveFactor"] = {2, 0.5, 0};
    const Scene brighter                        = file.load();
    EXPECT_EQ(brighter.materials[brighter.draws[0].material].emissive, glm::vec3(4, 2, 0));
    EXPECT_THAT(brighter.warnings, Contains(HasSubstr("emissive factors outside [0, 1] were clamped")));
    EXPECT_TRUE(material.double_sided);
    EXPECT_TRUE(material.alpha_mask);
    EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.25F);
    EXPECT_FLOAT_EQ(material.normal_scale, 0.5F);

    const TextureUse& use = material.base_colour_texture;
    EXPECT_EQ(use.uv_set, 1);
    // The matrix of the extension's specification: u' = sx cos u + sy sin v + ox, v' = -sx sin u + sy cos v + oy.
    EXPECT_VEC_NEAR(use.uv_transform * glm::vec3(1, 0, 1), glm::vec3(0.25F, 0.5F - 2, 1), 1e-5F);
    EXPECT_VEC_NEAR(use.uv_transform * glm::vec3(0, 1, 1), glm::vec3(0.25F + 3, 0.5F, 1), 1e-5F);

    ASSERT_GE(use.texture, 0);
    const Texture& texture = scene.textures[static_cast<size_t>(use.texture)];
    EXPECT_TRUE(texture.srgb);
    EXPECT_TRUE(texture.nearest);
    EXPECT_FALSE(texture.mipmaps);
    EXPECT_EQ(texture.wrap_u, Wrap::clamp_to_edge);
    EXPECT_EQ(texture.wrap_v, Wrap::mirrored_repeat);
    EXPECT_EQ(texture.rgba.size(), 4U);
    EXPECT_EQ(texture.rgba[3], 255);
    EXPECT_FALSE(scene.textures[static_cast<size_t>(material.metallic_roughness_texture.texture)].srgb);
    for (const Vertex& vertex : scene.vertices) {
        EXPECT_VEC_NEAR(glm::vec3(vertex.tangent_ws), glm::vec3(1, 0, 0), eps) << "tangents are made for normal maps";
        EXPECT_EQ(std::abs(vertex.tangent_ws.w), 1);
    }
}

TEST(SceneGltf, TransparencyFollowsTheStatedRule)
{
    GltfFile file                = GltfFile::triangle();
    file.primitive()["material"] = 0;
    for (double alpha : {0.4, 0.6}) {
        file.root["materials"] = {{{"name", "glass"},
                                   {"alphaMode", "BLEND"},
                                   {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}}}}};
        const Scene scene      = file.load();
        EXPECT_EQ(scene.draws.size(), alpha < 0.5 ? 0U : 1U);
        EXPECT_THAT(scene.warnings, Contains(HasSubstr(alpha < 0.5 ? "left out" : "drawn opaque")));
    }
}

TEST(SceneGltf, VertexColoursAndNormalizedIntegers)
{
    GltfFile  file = GltfFile::triangle();
    const int colours =
        file.add_accessor<uint16_t>({65535, 0, 0, 65535, 0, 65535, 0, 65535, 0, 0, 65535, 0}, "VEC4", 4);
    file.root["accessors"][colours]["normalized"] = true;
    file.primitive()["attributes"]["COLOR_0"]     = colours;
    const Scene scene                             = file.load();
    EXPECT_EQ(scene.vertices[scene.indices[0]].colour, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.vertices[scene.indices[2]].colour, glm::vec4(0, 0, 1, 0));
}

TEST(SceneGltf, SparseAccessorsReplaceElements)
{
    GltfFile  file                      = GltfFile::triangle();
    const int indices                   = file.add_accessor<uint16_t>({1}, "SCALAR", 1);
    const int values                    = file.positions({3, 0, 0});
    file.root["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                           {"values", {{"bufferView", values}}}};
    EXPECT_VEC_NEAR(corner(file.load(), 1), glm::vec3(3, 0, 0), eps);
}

TEST(SceneGltf, LightsArePlacedByTheirNodes)
{
    GltfFile file               = GltfFile::triangle();
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]     = {{"KHR_lights_punctual",
                                    {{"lights",
                                      {{{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}},
                                       {{"type", "spot"},
                                        {"intensity", 7},
                                        {"range", 4},
                                        {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}}}}}};
    const float half            = std::numbers::sqrt2_v<float> / 2;
    file.root["nodes"]          = {
                 {{"mesh", 0}, {"children", {1, 2}}},
                 {{"rotation", {-half, 0, 0, half}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                 {{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.lights.size(), 2U);
    EXPECT_EQ(scene.lights[0].type, LightType::directional);
    EXPECT_VEC_NEAR(scene.lights[0].direction_ws, glm::vec3(0, -1, 0), 1e-5F);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3, 1.5F, 0));
    EXPECT_EQ(scene.lights[1].type, LightType::spot);
    EXPECT_VEC_NEAR(scene.lights[1].position_ws, glm::vec3(1, 2, 3), eps);
    EXPECT_FLOAT_EQ(scene.lights[1].outer_angle_rad, 0.6F);
    EXPECT_FLOAT_EQ(scene.lights[1].range_m, 4);
}

TEST(SceneGltf, Cameras)
{
    GltfFile file        = GltfFile::triangle();
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 1}, {"znear", 0.25}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0.5}, {"zfar", 50}}}}};
    file.root["nodes"]  = {{{"mesh", 0}, {"children", {1, 2}}},
                           {{"camera", 0}, {"translation", {0, 1, 5}}},
                           {{"camera", 1}, {"name", "plan"}}};
    const Scene   scene = file.load();
    const Camera& eye   = find_camera(scene, "eye");
    EXPECT_VEC_NEAR(eye.position_ws, glm::dvec3(0, 1, 5), 1e-9);
    EXPECT_VEC_NEAR(eye.target_ws, glm::dvec3(0, 1, 4), 1e-9);
    EXPECT_NEAR(eye.fov_y_deg, 180 / std::numbers::pi, 1e-9);
    EXPECT_EQ(eye.near_m, 0.25);
    const Camera& plan = find_camera(scene, "plan");
    EXPECT_EQ(plan.projection, Projection::orthographic);
    EXPECT_EQ(plan.height_m, 6);
    EXPECT_EQ(plan.far_m, 50);
    EXPECT_EQ(&find_camera(scene, "default"), &scene.cameras.front()) << "a file's first camera is its default view";
    EXPECT_THROW(find_camera(scene, "nose"), SpecError);
}

// Along the view axis: the triangle's farthest corner is 5 m away, if 5.1 m from the eye.
TEST(SceneGltf, GeometryBeyondZfarIsNamed)
{
    GltfFile file       = GltfFile::triangle();
    file.root["nodes"]  = {{{"mesh", 0}}, {{"camera", 0}, {"translation", {0, 0, 5}}}};
    file.root["scenes"] = {{{"nodes", {0, 1}}}};
    for (const auto& [zfar, named] : {std::pair(4.5, true), {5.05, false}}) {
        file.root["cameras"] = {{{"type", "perspective"},
                                 {"name", "eye"},
                                 {"perspective", {{"yfov", 1}, {"znear", 0.25}, {"zfar", zfar}}}}};
        const auto about_it  = Contains(HasSubstr("camera 'eye': zfar (4.5 m) is not supported"));
        if (named)
            EXPECT_THAT(file.load().warnings, about_it);
        else
            EXPECT_TRUE(file.load().warnings.empty());
    }
}

TEST(SceneGltf, ViewsBesideTheSceneComeFirst)
{
    TempFolder        folder;
    const std::string path = GltfFile::triangle().write(folder);
    folder.write("scene.gltf.views.toml", "[[view]]\nname = 'mine'\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n"
                                          "size = '64x48'\nhard_for = 'nothing'\n");
    const Scene scene = load_scene(path);
    ASSERT_EQ(scene.cameras.size(), 1U);
    EXPECT_EQ(scene.cameras[0].name, "mine");
    EXPECT_EQ(scene.cameras[0].hard_for, "nothing");
    EXPECT_EQ(scene.cameras[0].size_px, glm::ivec2(64, 48));
    folder.write("scene.gltf.views.toml",
                 "[[view]]\nname = 'mine'\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\nfov = 3\n");
    EXPECT_THAT(error_of<SpecError>(path),
                HasSubstr("views.toml:5: unknown key of [[view]] 'fov' (known: far_m, fov_y_deg, "));
}

TEST(SceneGltf, ViewsAreNamedWithoutReadingTriangles)
{
    const TempFolder folder;
    GltfFile         file = GltfFile::triangle();
    file.root["cameras"]  = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
    file.root["nodes"]    = {{{"mesh", 0}},
                             {{"camera", 0}, {"name", "eye"}, {"translation", {0, 0, 5}}},
                             {{"camera", 0}, {"name", "eye"}, {"translation", {0, 1, 5}}}};
    file.root["scenes"]   = {{{"nodes", {0, 1, 2}}}};
    EXPECT_THAT(view_names(file.write(folder)).cameras, testing::ElementsAre("eye", "eye_2"));
    folder.write("scene.gltf.views.toml", "[[view]]\nname = 'mine'\nposition = [0, 0, 3]\ntarget = [0, 0, 0]\n");
    const std::string        sound = file.write(folder);
    std::vector<std::string> loaded;
    for (const Camera& camera : load_scene(sound).cameras) loaded.push_back(camera.name);
    EXPECT_EQ(view_names(sound).cameras, loaded);
    file.root["accessors"][0]["count"] = 4; // more than there are
    const std::string broken           = file.write(folder);
    EXPECT_THROW(load_scene(broken), Failure);
    EXPECT_EQ(view_names(broken).cameras, loaded);
    EXPECT_EQ(view_names("builtin:stairs").cameras.front(), "default");
    EXPECT_TRUE(view_names(broken).has("default"));
    EXPECT_FALSE(view_names(broken).has("nose"));
}

TEST(SceneGltf, AFittedCameraSeesTheBounds)
{
    GltfFile file      = GltfFile::triangle();
    file.root["nodes"] = {{{"mesh", 0}, {"scale", {30, 2, 1}}, {"translation", {-7, 3, 2}}}};
    const Scene scene  = file.load();
    for (const glm::ivec2& size_px : {glm::ivec2(1280, 720), glm::ivec2(512, 512)}) {
        const View view = camera_to_view(scene.cameras.at(0), size_px);
        for (const Vertex& vertex : scene.vertices) {
            const glm::dvec3 px = vs_to_px(view, glm::dvec3(view.world_to_view * glm::dvec4(vertex.position_ws, 1)));
            EXPECT_TRUE(px.x > 0 && px.x < size_px.x && px.y > 0 && px.y < size_px.y);
            EXPECT_TRUE(px.z > 0 && px.z < 1) << "between the near plane and infinity";
        }
    }
}

TEST(SceneGltf, FarFromTheOriginPositionsStayAccurate)
{
    GltfFile file      = GltfFile::triangle();
    file.root["nodes"] = {{{"mesh", 0}, {"translation", {5e6, 100, -3e6}}, {"scale", {0.01, 0.01, 0.01}}}};
    const Scene scene  = file.load();
    EXPECT_GT(glm::length(scene.origin_ws), 1e6);
    const glm::dvec3 expected = glm::dvec3(5e6 + 0.01, 100, -3e6) - scene.origin_ws;
    EXPECT_VEC_NEAR(glm::dvec3(corner(scene, 1)), expected, 1e-8);
    EXPECT_LT(glm::length(scene.cameras[0].position_ws), 1) << "cameras are relative to the origin, too";
}

TEST(SceneGltf, TheOriginMovesSixteenRadiiAway)
{
    // The triangle's bounds have a radius of sqrt(1 / 2), their middle lies at (0.5 + x, 0.5, 0): 16 radii are 11.3.
    for (double x : {10.0, 11.5}) {
        GltfFile file      = GltfFile::triangle();
        file.root["nodes"] = {{{"mesh", 0}, {"translation", {x, 0, 0}}}};
        EXPECT_VEC_NEAR(file.load().origin_ws, x < 11 ? glm::dvec3(0) : glm::dvec3(x + 0.5, 0.5, 0), 1e-6);
    }
}

TEST(SceneGltf, GlbWithItsBinaryChunk)
{
    TempFolder  folder;
    GltfFile    file = GltfFile::triangle();
    std::string glb  = file.glb();
    EXPECT_EQ(load_scene(folder.write("scene.glb", glb)).indices.size(), 3U);
    EXPECT_THAT(error_of<Failure>(folder.write("cut.glb", glb.substr(0, glb.size() - 8))), HasSubstr("truncated"));
    glb[4] = 1;
    EXPECT_THAT(error_of<Failure>(folder.write("old.glb", glb)), HasSubstr("version 1"));
}

TEST(SceneGltf, NodesTurnTheirCameras)
{
    GltfFile file        = GltfFile::triangle();
    file.root["cameras"] = {
        {{"type", "perspective"}, {"name", "first"}, {"perspective", {{"yfov", 1}, {"znear", 0.25}}}},
        {{"type", "orthographic"},
         {"name", "second"},
         {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0.5}, {"zfar", 50}}}}};
    const float half    = std::numbers::sqrt2_v<float> / 2;
    file.root["nodes"]  = {{{"mesh", 0}, {"children", {1, 2}}, {"scale", {2, 2, 2}}},
                           // By 90 degrees about z, and about y.
                           {{"camera", 0}, {"rotation", {0, 0, half, half}}},
                           {{"camera", 1}, {"rotation", {0, half, 0, half}}}};
    const Scene   scene = file.load();
    const Camera &first = find_camera(scene, "first"), &second = find_camera(scene, "second");
    EXPECT_VEC_NEAR(first.up_ws, glm::dvec3(-1, 0, 0), 1e-6);
    EXPECT_VEC_NEAR(first.target_ws, glm::dvec3(0, 0, -1), 1e-6);
    EXPECT_VEC_NEAR(second.up_ws, glm::dvec3(0, 1, 0), 1e-6);
    EXPECT_VEC_NEAR(second.target_ws, glm::dvec3(-1, 0, 0), 1e-6);
    EXPECT_EQ(second.near_m, 0.5);
    EXPECT_EQ(&find_camera(scene, "default"), &first) << "nodes are visited in their order";
}

TEST(SceneGltf, KindsOfLightsAndTheSceneThatIsShown)
{
    GltfFile file               = GltfFile::triangle();
    file.root["scene"]          = 1;
    file.root["scenes"]         = {{{"nodes", {1}}}, {{"nodes", {0, 2}}}};
    file.root["extensionsUsed"] = {"KHR_lights_punctual"};
    file.root["extensions"]     = {
            {"KHR_lights_punctual",
             {{"lights",
               {{{"type", "point"}, {"intensity", 2}, {"range", 3}},
                {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.6}}}}}}}}};
    file.root["nodes"] = {{{"mesh", 0}, {"children", {3}}},
                          {{"mesh", 0}, {"translation", {9, 9, 9}}},
                          {{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                          {{"rotation", {0, 1, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
    const Scene scene  = file.load();
    ASSERT_EQ(scene.draws.size(), 1U);
    EXPECT_EQ(corner(scene, 0), glm::vec3(0)) << "scene 1 is shown, not scene 0";
    ASSERT_EQ(scene.lights.size(), 2U);
    const Light &spot = scene.lights[0], &point = scene.lights[1];
    EXPECT_EQ(point.type, LightType::point);
    EXPECT_EQ(point.intensity, glm::vec3(2));
    EXPECT_EQ(point.position_ws, glm::vec3(1, 2, 3));
    EXPECT_EQ(spot.type, LightType::spot);
    EXPECT_VEC_NEAR(spot.direction_ws, glm::vec3(0, 0, 1), eps);
    EXPECT_FLOAT_EQ(spot.inner_angle_rad, 0.2F);
    EXPECT_FLOAT_EQ(spot.outer_angle_rad, 0.6F);
}

/// Material 0 of a triangle.
Material material_of(const json& description)
{
    GltfFile file                = GltfFile::triangle();
    file.primitive()["material"] = 0;
    file.root["images"]          = {{{"uri", pixel_png}}};
    file.root["textures"]        = {{{"source", 0}}};
    file.root["materials"]       = {description};
    const Scene scene            = file.load();
    return scene.materials.at(scene.draws.at(0).material);
}

json with_extension(json material, const char* name, const json& values)
{
    material["extensions"][name] = values;
    return material;
}

TEST(SceneGltf, ExtensionsOfMaterials)
{
    const json plastic = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {0.1, 0.2, 0.3, 0.75}}, {"metallicFactor", 0}, {"roughnessFactor", 0.8}}}};
    const Material plain = material_of(plastic);
    EXPECT_VEC_NEAR(plain.base_colour, glm::vec4(0.1F, 0.2F, 0.3F, 0.75F), eps);
    EXPECT_EQ(plain.metallic, 0);
    EXPECT_FLOAT_EQ(plain.roughness, 0.8F);
    EXPECT_EQ(plain.dielectric_f0, common_dielectric_f0);
    // ((n - 1) / (n + 1))^2 is 1 / 9 for n = 2; an index of 0 means that all is reflected.
    const json glassy = with_extension(plastic, "KHR_materials_ior", {{"ior", 2}});
    EXPECT_FLOAT_EQ(material_of(glassy).dielectric_f0, 1.0F / 9);
    EXPECT_EQ(material_of(with_extension(plastic, "KHR_materials_ior", {{"ior", 0}})).dielectric_f0, 1);
    // The strongest of the colour's factors counts, at most all is reflected.
    const json specular = with_extension(glassy, "KHR_materials_specular",
                                         {{"specularFactor", 0.5}, {"specularColorFactor", {0.25, 3, 0.5}}});
    EXPECT_FLOAT_EQ(material_of(specular).dielectric_f0, 0.5F * 3 / 9);
    // Half a coat: half way to its roughness and to the reflectance of an index of 1.5.
    const json     coat   = {{"clearcoatFactor", 0.5}, {"clearcoatRoughnessFactor", 0.2}};
    const Material coated = material_of(with_extension(glassy, "KHR_materials_clearcoat", coat));
    EXPECT_FLOAT_EQ(coated.roughness, 0.5F);
    EXPECT_FLOAT_EQ(coated.dielectric_f0, 0.5F * (1.0F / 9 + common_dielectric_f0));
    json metal                                      = plastic;
    metal["pbrMetallicRoughness"]["metallicFactor"] = 1;
    EXPECT_FLOAT_EQ(material_of(with_extension(metal, "KHR_materials_clearcoat", coat)).roughness, 0.8F);
    const Material unlit = material_of(with_extension(plastic, "KHR_materials_unlit", json::object()));
    EXPECT_VEC_NEAR(unlit.emissive, glm::vec3(0.1F, 0.2F, 0.3F), eps);
    EXPECT_VEC_NEAR(unlit.base_colour, glm::vec4(0, 0, 0, 0.75F), eps);
    EXPECT_EQ(glm::vec3(unlit.metallic, unlit.roughness, unlit.dielectric_f0), glm::vec3(0, 1, 0));
}

TEST(SceneGltf, ColoursAreEncodedAndNormalsAreNot)
{
    GltfFile file                                = GltfFile::triangle();
    file.primitive()["material"]                 = 0;
    file.primitive()["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.root["images"]                          = {{{"uri", pixel_png}}};
    file.root["samplers"]                        = {{{"minFilter", 9987}, {"wrapS", 33648}, {"wrapT", 33071}}};
    file.root["textures"]                        = {{{"source", 0}, {"sampler", 0}}};
    const json texture                           = {{"index", 0}};
    file.root["materials"]                       = {
                              {{"emissiveTexture", texture}, {"emissiveFactor", {1, 1, 1}}, {"normalTexture", texture}}};
    const Scene     scene    = file.load();
    const Material& material = scene.materials[scene.draws[0].material];
    const Texture & emissive = scene.textures.at(size_t(material.emissive_texture.texture)),
                  &normals   = scene.textures.at(size_t(material.normal_texture.texture));
    EXPECT_TRUE(emissive.srgb);
    EXPECT_FALSE(normals.srgb);
    EXPECT_FALSE(normals.nearest);
    EXPECT_TRUE(normals.mipmaps);
    EXPECT_EQ(normals.wrap_u, Wrap::mirrored_repeat);
    EXPECT_EQ(normals.wrap_v, Wrap::clamp_to_edge);
}

TEST(SceneGltf, VerticesKeepWhatTheFileSays)
{
    GltfFile  file               = GltfFile::triangle();
    auto&     attributes         = file.primitive()["attributes"];
    const int normals            = file.add_accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    const int tangents           = file.add_accessor<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4", 4);
    const int first              = file.add_accessor<float>({1, 2, 3, 4, 5, 6}, "VEC2", 2);
    const int second             = file.add_accessor<float>({7, 8, 9, 10, 11, 12}, "VEC2", 2);
    const int colours            = file.add_accessor<float>({.1F, .2F, .3F, 0, 0, 0, 0, 0, 0}, "VEC3", 3);
    attributes["NORMAL"]         = normals;
    attributes["TANGENT"]        = tangents;
    attributes["TEXCOORD_0"]     = first;
    attributes["TEXCOORD_1"]     = second;
    attributes["COLOR_0"]        = colours;
    file.root["images"]          = {{{"uri", pixel_png}}};
    file.root["textures"]        = {{{"source", 0}}};
    file.root["materials"]       = {{{"normalTexture", {{"index", 0}}}}}; // else nothing needs tangents
    file.primitive()["material"] = 0;
    const auto placed            = [&](const json& scale) {
        file.root["nodes"] = {{{"mesh", 0}, {"scale", scale}}};
        return file.load().vertices;
    };
    const std::vector<Vertex> vertices = placed({1, 1, 1});
    EXPECT_EQ(vertices[0].colour, glm::vec4(.1F, .2F, .3F, 1));
    EXPECT_EQ(vertices[2].uv0, glm::vec2(5, 6));
    EXPECT_EQ(vertices[2].uv1, glm::vec2(11, 12));
    EXPECT_EQ(vertices[1].tangent_ws, glm::vec4(0, 1, 0, -1));
    EXPECT_EQ(placed({1, 3, 1})[1].tangent_ws, glm::vec4(0, 1, 0, -1)) << "tangents stay units";
    EXPECT_EQ(placed({-1, 1, 1})[1].tangent_ws, glm::vec4(0, 1, 0, 1)) << "a mirror changes their hand";
}

// Eight bytes a vertex: a colour of four unsigned bytes, coordinates of two signed ones, and two that nobody reads.
TEST(SceneGltf, InterleavedBytesAreSharesOfTheirLargest)
{
    GltfFile      file      = GltfFile::triangle();
    const uint8_t bytes[]   = {255, 0,    51, 204, 0x80, 127, 9, 9,   0, 255, 0, 255,
                               64,  0x81, 9,  9,   0,    102, 0, 255, 0, 1,   9, 9};
    const auto    attribute = [&](const char* name, int component, const char* type, size_t offset) {
        file.root["accessors"].push_back({{"bufferView", file.root["bufferViews"].size() - 1},
                                          {"byteOffset", offset},
                                          {"componentType", component},
                                          {"normalized", true},
                                          {"count", 3},
                                          {"type", type}});
        file.primitive()["attributes"][name] = file.root["accessors"].size() - 1;
    };
    file.root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", file.binary.size()}, {"byteLength", sizeof(bytes)}, {"byteStride", 8}});
    file.binary.append(reinterpret_cast<const char*>(bytes), sizeof(bytes));
    attribute("COLOR_0", 5121, "VEC4", 0);
    attribute("TEXCOORD_0", 5120, "VEC2", 4);
    const std::vector<Vertex> vertices = file.load().vertices;
    EXPECT_VEC_NEAR(vertices[0].colour, glm::vec4(1, 0, 0.2F, 0.8F), eps);
    EXPECT_VEC_NEAR(vertices[2].colour, glm::vec4(0, 0.4F, 0, 1), eps);
    EXPECT_EQ(vertices[0].uv0, glm::vec2(-1, 1)) << "-128 is no less than -1";
    EXPECT_NEAR(vertices[1].uv0.x, 64.0F / 127, eps);
    EXPECT_EQ(vertices[1].uv0.y, -1);
}

TEST(SceneGltf, ATextureMakesAMaterialTransparentWithItsFactor)
{
    // The grey pixel is opaque: half of it is drawn, less is left out.
    for (double alpha : {0.45, 0.55}) {
        GltfFile file                = GltfFile::triangle();
        file.primitive()["material"] = 0;
        file.root["images"]          = {{{"uri", pixel_png}}};
        file.root["textures"]        = {{{"source", 0}}};
        file.root["materials"]       = {
                  {{"alphaMode", "BLEND"},
                   {"alphaCutoff", 0.1},
                   {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, alpha}}, {"baseColorTexture", {{"index", 0}}}}}}};
        const Scene scene = file.load();
        ASSERT_EQ(scene.draws.size(), alpha < 0.5 ? 0U : 1U);
        if (alpha < 0.5) continue;
        const Material& material = scene.materials[scene.draws[0].material];
        EXPECT_TRUE(material.alpha_mask);
        EXPECT_EQ(material.alpha_cutoff, 0.5F);
    }
}

} // namespace
} // namespace ssrlab
