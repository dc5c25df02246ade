#include "core/environment_variable.h"
#include "scene_files.h"

#include "core/files.h"
#include "scene/mesh_repair.h"
#include "scene/recipe.h"
#include "scene/shapes.h"

namespace ssrlab {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;

// A pyramid of 2 x 3 x 2 units, with two materials, quads and no normals.
constexpr const char* pyramid_obj = R"(mtllib pyramid.mtl
v -1 0 -1
v 1 0 -1
v 1 0 1
v -1 0 1
v 0 3 0
usemtl stone
f 1 2 3 4
usemtl gold_leaf
f 4 3 5
f 3 2 5
f 2 1 5
f 1 4 5
)";
constexpr const char* pyramid_mtl = R"(newmtl stone
Kd 0.5 0.4 0.3
newmtl gold_leaf
Kd 0.9 0.7 0.1
Ks 0.5 0.5 0.5
Ns 30
)";

TempFolder& folder_with_pyramid()
{
    static TempFolder folder;
    folder.write("pyramid.obj", pyramid_obj);
    folder.write("pyramid.mtl", pyramid_mtl);
    return folder;
}

Scene load_text(const std::string& recipe) { return load_scene(folder_with_pyramid().write("recipe.toml", recipe)); }

std::string mistake(const std::string& recipe)
{
    return error_of<SpecError>(folder_with_pyramid().write("recipe.toml", recipe));
}

const Material& material_named(const Scene& scene, const std::string& name)
{
    for (const Material& material : scene.materials)
        if (material.name == name) return material;
    throw Failure("no material " + name);
}

TEST(SceneRecipe, ModelsFarFromTheirOriginAreNamed)
{
    TempFolder folder;
    folder.write("far.obj", "v 450000 120 5400000\nv 450001 120 5400000\nv 450000 121 5400000\nf 1 2 3\n");
    const Scene scene = load_scene(folder.write("far.toml", "[[part]]\nfile = 'far.obj'\n"));
    EXPECT_THAT(scene.warnings, testing::Contains(HasSubstr("it lies 5.4e+06 units from its origin")));
}

TEST(SceneRecipe, TenLinesAreEnough)
{
    const Scene scene = load_text("summary = 'A golden pyramid'\n"
                                  "[[part]]\n"
                                  "file = 'pyramid.obj'\n"
                                  "height_m = 1.5\n"
                                  "[[part]]\n"
                                  "shape = 'plane'\n"
                                  "size_m = [8, 0, 8]\n"
                                  "material = { metallic = 0.9, roughness = 0.1 }\n"
                                  "[[material]]\n"
                                  "name = 'gold*'\n"
                                  "metallic = 1\n");
    ASSERT_EQ(scene.draws.size(), 3U);
    EXPECT_EQ(scene.indices.size() / 3, 2U + 4 + 2);
    EXPECT_FLOAT_EQ(material_named(scene, "gold_leaf").metallic, 1);
    EXPECT_FLOAT_EQ(material_named(scene, "stone").metallic, 0);
    EXPECT_FLOAT_EQ(material_named(scene, "plane").metallic, 0.9F);
    EXPECT_EQ(scene.cameras.size(), 1U) << "a camera is fitted";
    EXPECT_EQ(scene.lights.size(), 1U) << "a light is added";
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_THAT(scene.draws[0].name, HasSubstr("pyramid/"));
}

TEST(SceneRecipe, PartsStandWhereTheyAreTold)
{
    const Scene scene = load_text("[[part]]\nfile = 'pyramid.obj'\nheight_m = 1.5\n"
                                  "position = [[3, 0.5, -2], [-3, 0, 0]]\n");
    glm::vec3   low(1e9F);
    glm::vec3   high(-1e9F);
    for (const Draw& draw : scene.draws)
        if (draw.bounds_min_ws.x > 0) {
            low  = glm::min(low, draw.bounds_min_ws);
            high = glm::max(high, draw.bounds_max_ws);
        }
    EXPECT_VEC_NEAR(low, glm::vec3(2.5F, 0.5F, -2.5F), 1e-5F);
    EXPECT_VEC_NEAR(high, glm::vec3(3.5F, 2, -1.5F), 1e-5F);
    EXPECT_EQ(scene.draws.size(), 4U);
    EXPECT_EQ(scene.materials.size(), 2U) << "equal materials of repeated parts are one";
}

TEST(SceneRecipe, UpAxisRotationAndUnits)
{
    const Scene scene =
        load_text("[[part]]\nfile = 'pyramid.obj'\nup = 'z'\nunit_m = 0.1\nrotation_deg = [90, 0, 0]\n");
    // z up means a quarter turn back about x, which the rotation undoes.
    glm::vec3 low(1e9F);
    glm::vec3 high(-1e9F);
    for (const Vertex& vertex : scene.vertices) {
        low  = glm::min(low, vertex.position_ws);
        high = glm::max(high, vertex.position_ws);
    }
    EXPECT_VEC_NEAR(high - low, glm::vec3(0.2F, 0.3F, 0.2F), 1e-5F);
    EXPECT_NEAR(low.y, 0, 1e-6);
}

TEST(SceneRecipe, ModelsWithoutNormalsGetThemOutwards)
{
    const Scene scene = load_text("[[part]]\nfile = 'pyramid.obj'\n");
    for (size_t i = 0; i < scene.indices.size(); i += 3) {
        const glm::vec3 normal = geometric_normal(scene, i / 3);
        for (size_t k = i; k < i + 3; ++k)
            EXPECT_GT(glm::dot(scene.vertices[scene.indices[k]].normal_ws, normal), 0.99F)
                << "edges of a pyramid are sharp";
    }
}

TEST(SceneRecipe, LightsViewsAndColours)
{
    const Scene scene =
        load_text("ambient = 0.1\nbackground = [0.1, 0.2, 0.3]\n"
                  "[[part]]\nshape = 'box'\nsize_m = [1, 2, 3]\n"
                  "[[light]]\ntype = 'spot'\nposition = [0, 4, 0]\ntarget = [0, 0, 0]\nangle_deg = 60\nintensity = 5\n"
                  "[[light]]\ndirection = [0, -2, 0]\nintensity = [1, 2, 3]\nshadow = false\n"
                  "[[view]]\nname = 'a'\nposition = [0, 1, 5]\ntarget = [0, 1, 0]\nsize = '320x200'\n"
                  "[[view]]\nname = 'b'\nposition = [0, 9, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\n"
                  "projection = 'orthographic'\nheight_m = 4\n");
    EXPECT_EQ(scene.ambient, glm::vec3(0.1F));
    EXPECT_EQ(scene.background, glm::vec3(0.1F, 0.2F, 0.3F));
    ASSERT_EQ(scene.lights.size(), 2U);
    EXPECT_EQ(scene.lights[0].type, LightType::spot);
    EXPECT_VEC_NEAR(scene.lights[0].direction_ws, glm::vec3(0, -1, 0), 1e-6F);
    EXPECT_NEAR(scene.lights[0].outer_angle_rad, 0.5236, 1e-3);
    EXPECT_EQ(scene.lights[1].intensity, glm::vec3(1, 2, 3));
    EXPECT_FALSE(scene.lights[1].casts_shadow);
    EXPECT_EQ(find_camera(scene, "a").size_px, glm::ivec2(320, 200));
    EXPECT_EQ(find_camera(scene, "b").projection, Projection::orthographic);
    EXPECT_VEC_NEAR(scene.draws[0].bounds_max_ws - scene.draws[0].bounds_min_ws, glm::vec3(1, 2, 3), 1e-6F);
}

TEST(SceneRecipe, PatternsRepeatByTheMetre)
{
    const Scene scene = load_text("[[part]]\nshape = 'plane'\nsize_m = [6, 0, 4]\npattern = 'marble'\ntile_m = 2\n");
    const Material& material = material_named(scene, "plane");
    ASSERT_GE(material.base_colour_texture.texture, 0);
    ASSERT_GE(material.metallic_roughness_texture.texture, 0);
    EXPECT_NE(material.base_colour_texture.texture, material.metallic_roughness_texture.texture);
    float most = 0;
    for (const Vertex& vertex : scene.vertices) most = std::max({most, std::abs(vertex.uv0.x), std::abs(vertex.uv0.y)});
    EXPECT_FLOAT_EQ(most, 3);
}

// A wave is a repeat of the texture, whose normals lean by at most the slope: by as much to both sides.
TEST(SceneRecipe, RipplesAreANormalMapOfWaves)
{
    const Scene scene = load_text("[[part]]\nshape = 'box'\nsize_m = [4, 1, 2]\nripple_m = 0.5\nripple_slope = 0.2\n");
    const Material& material = scene.materials[scene.draws[0].material];
    ASSERT_EQ(material.normal_texture.texture, 0);
    EXPECT_FLOAT_EQ(material.normal_scale, 0.2F);
    glm::vec2 least(1e9F), most(-1e9F);
    for (const Vertex& vertex : scene.vertices)
        if (vertex.normal_ws.y > 0.5F) least = glm::min(least, vertex.uv0), most = glm::max(most, vertex.uv0);
    EXPECT_VEC_NEAR(glm::vec3(most - least, 0), glm::vec3(8, 4, 0), 1e-5F);
    glm::vec3 mean(0);
    for (size_t i = 0; i < scene.textures[0].rgba.size(); i += 4) {
        const uint8_t* texel  = &scene.textures[0].rgba[i];
        const auto     normal = glm::vec3(texel[0], texel[1], texel[2]) / 127.5F - 1.0F;
        EXPECT_LE(std::max(std::abs(normal.x), std::abs(normal.y)), normal.z + 0.02F);
        mean += normal;
    }
    EXPECT_NEAR(mean.x / mean.z, 0, 0.01);
    EXPECT_NEAR(mean.y / mean.z, 0, 0.01);
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\nripple_m = 1\ntile_colours = [[1, 1, 1], [0, 0, 0]]\n"),
                HasSubstr("recipe.toml:3: [[part]]: 'ripple_m' cannot stand beside tile_colours"));
}

TEST(SceneRecipe, MistakesNameFileLineAndWhatIsAccepted)
{
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\npattern = 'silk'\n"), HasSubstr("recipe.toml:3: "));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\npattern = 'marble'\ntile_colours = [[0, 0, 0], [1, 1, 1]]\n"),
                HasSubstr("'pattern' cannot stand beside tile_colours or ripple_m"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\npattern = 'marble'\nripple_m = 1\n"),
                HasSubstr("'pattern' cannot stand beside tile_colours or ripple_m"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\nhieght_m = 1\n"),
                HasSubstr("recipe.toml:3: unknown key of [[part]] 'hieght_m': did you mean 'height_m'? (known: "));
    EXPECT_THAT(mistake("sumary = 'x'\n[[part]]\nshape = 'box'\n"),
                HasSubstr("recipe.toml:1: unknown key of recipe 'sumary': did you mean 'summary'?"));
    EXPECT_THAT(
        mistake("[[part]]\nshape = 'cube'\n"),
        AllOf(HasSubstr("recipe.toml:2: [[part]]: 'shape' must be one of box, "), EndsWith("got the string \"cube\"")));
    EXPECT_THAT(mistake("[[part]]\nposition = [0, 0, 0]\n"),
                HasSubstr("recipe.toml:1: [[part]]: needs either 'file' or 'shape'"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\nposition = [0, nan, 0]\n"),
                HasSubstr("recipe.toml:3: [[part]]: 'position' must be"));
    EXPECT_THAT(
        mistake("[[part]]\nshape = 'box'\nheight_m = -1\n"),
        AllOf(HasSubstr("recipe.toml:3: [[part]]: 'height_m' must be a number in"), EndsWith("got the integer -1")));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\nheight_m = nan\n"),
                AllOf(HasSubstr("recipe.toml:3"), EndsWith("got nan, which is not a number")));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\nmaterial = { metallic = 2 }\n"),
                HasSubstr("recipe.toml:3: material: 'metallic' must be a number in [0, 1]"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\nmaterial = { colour = 2 }\n"),
                HasSubstr("unknown key of material 'colour'"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\n[[material]]\nname = 'wood*'\n"),
                HasSubstr("matches nothing; the materials are: box"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\n[[light]]\nintensity = 1\n"),
                HasSubstr("recipe.toml:3: [[light]]: 'direction'"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\n[[view]]\nposition = [0, 0, 0]\ntarget = [0, 0, 0]\n"),
                HasSubstr("recipe.toml:3: view 'default': target"));
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\n[[view]]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\nsize = '0x5'\n"),
                HasSubstr("recipe.toml:6: [[view]]: 'size'"));
    const std::string view = "[[view]]\nname = 'a'\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\n";
    EXPECT_THAT(mistake("[[part]]\nshape = 'box'\n" + view + view),
                HasSubstr("recipe.toml:7: [[view]]: 'name' must differ from the other views', got 'a' again"));
    EXPECT_THAT(mistake("[[part]\nshape = 'box'\n"), HasSubstr("recipe.toml:1: "));
    EXPECT_THAT(mistake(""), HasSubstr("needs at least one [[part]]"));
    EXPECT_THAT(mistake("part = 3\n"), HasSubstr("'part' must be tables, [[part]], got the integer 3"));
}

TEST(SceneRecipe, MissingDataSaysHowToGetIt)
{
    TempFolder& folder = folder_with_pyramid();
    EXPECT_THAT(
        error_of<SpecError>(folder.write("a.toml", "[[part]]\nfile = 'package:no-such-package/usr/share/a.obj'\n")),
        HasSubstr("run ./experiments/prepare_scenes"));
    EXPECT_THAT(error_of<SpecError>(folder.write("a.toml", "[[part]]\nfile = 'sweethome3d:noSuchChair'\n")),
                HasSubstr("run ./experiments/prepare_scenes"));
    EXPECT_THAT(error_of<SpecError>(folder.write("a.toml", "[[part]]\nfile = 'none.obj'\n")), HasSubstr("none.obj"));
    EXPECT_THAT(error_of<SpecError>(folder.write("a.toml", "[[part]]\nfile = 'package:a/../../b'\n")),
                HasSubstr("must look like"));
}

TEST(SceneRecipe, DataAndRecipesAreFoundThroughTheEnvironment)
{
    TempFolder folder;
    folder.write("data/pkg/usr/share/ssrlab-test/pyramid.obj", pyramid_obj);
    folder.write("data/pkg/usr/share/ssrlab-test/pyramid.mtl", pyramid_mtl);
    folder.write("data/sweethome3d/stool/stool.obj", "v 0 0 0\nv 10 0 0\nv 0 40 0\nf 1 2 3\n");
    folder.write("mine/my_scene.toml",
                 "summary = 'Mine'\n[[part]]\nfile = 'package:pkg/usr/share/ssrlab-test/pyramid.obj'\n"
                 "[[part]]\nfile = 'sweethome3d:stool'\nposition = [5, 0, 0]\n");
    const EnvironmentVariable data("SSRLAB_DATA", (folder / "data").string());
    const EnvironmentVariable scenes("SSRLAB_SCENES", "/nowhere:" + (folder / "mine").string());
    const Scene               scene = load_scene("my_scene");
    EXPECT_EQ(scene.name, "my_scene");
    EXPECT_NEAR(scene.draws.back().bounds_max_ws.y, 0.4, 1e-6) << "furniture is in centimetres";
    bool listed = false;
    for (const SceneListing& listing : list_scenes())
        listed = listed || (listing.name == "my_scene" && listing.summary == "Mine");
    EXPECT_TRUE(listed);
}

TEST(SceneRecipe, ShippedRecipesAreWellFormed)
{
    for (const SceneListing& listing : list_scenes()) {
        if (listing.name.starts_with("builtin:")) continue;
        const Recipe recipe = read_recipe(data_root() / "experiments/scenes" / (listing.name + ".toml"));
        EXPECT_FALSE(listing.summary.empty()) << listing.name;
        EXPECT_GE(recipe.views.size(), 2U) << listing.name;
        EXPECT_EQ(recipe.views.at(0).name, "default") << listing.name;
        for (const Camera& view : recipe.views) EXPECT_FALSE(view.hard_for.empty()) << listing.name;
    }
}

TEST(SceneRecipe, TransparentMaterialsFollowTheStatedRule)
{
    TempFolder folder;
    folder.write("glass.obj",
                 "mtllib glass.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl thin\nf 1 2 3\nusemtl thick\nf 3 2 1\n");
    folder.write("glass.mtl", "newmtl thin\nKd 1 1 1\nd 0.3\nnewmtl thick\nKd 1 1 1\nd 0.7\n");
    const Scene scene = load_scene(folder.write("glass.toml", "[[part]]\nfile = 'glass.obj'\n"));
    EXPECT_EQ(scene.indices.size(), 3U);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("'thin' is 30 % opaque: left out")));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("'thick' is 70 % opaque: drawn opaque")));
}

TEST(SceneRecipe, WhyAnObjHasNothingToDrawOrNoMaterialIsSaid)
{
    TempFolder        folder;
    const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl thin\nf 1 2 3\n";
    const std::string recipe   = folder.write("s.toml", "summary = 'x'\n[[part]]\nfile = 'm.obj'\n");
    folder.write("m.obj", "mtllib lost.mtl\n" + triangle);
    EXPECT_THAT(load_scene(recipe).warnings, Contains(HasSubstr("there is no material file 'lost.mtl'")));
    folder.write("m.obj", "mtllib found.mtl\n" + triangle);
    folder.write("found.mtl", "newmtl thin\nd 0.3\n");
    EXPECT_THAT(error_of<Failure>(recipe),
                HasSubstr("no triangle that can be drawn; m.obj: material 'thin' is 30 % opaque"));
}

/// The materials and warnings of a triangle in OBJ with these lines in its material file.
Scene obj_scene(const TempFolder& folder, const std::string& material, const std::string& after_corner = "")
{
    folder.write("m.mtl", "newmtl m\nKd 0.5 0.5 0.5\n" + material);
    std::string corners;
    for (const char* corner : {"0 0 0", "1 0 0", "0 1 0"}) corners += std::string("v ") + corner + after_corner + "\n";
    folder.write("t.obj", corners + (material.empty() ? "f 1 2 3\n" : "mtllib m.mtl\nusemtl m\nf 1 2 3\n"));
    return load_scene(folder.write("scene.toml", "[[part]]\nfile = 't.obj'\n"));
}

TEST(SceneRecipe, ObjMayBeMetallicAndRough)
{
    const TempFolder folder;
    const Scene      scene = obj_scene(folder, "Pr 0.25\nPm 0.75\nNs 500\nKs 1 1 1\n");
    EXPECT_EQ(scene.materials.at(0).metallic, 0.75F);
    EXPECT_EQ(scene.materials.at(0).roughness, 0.25F);
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(obj_scene(folder, "Ns 0\n").materials.at(0).metallic, 0) << "where the file does not say";
}

TEST(SceneRecipe, WhatIsLeftOutOfObjIsNamed)
{
    const TempFolder folder;
    const Scene      maps = obj_scene(folder, "map_d a.png\nmap_Bump -bm 1 b.png\nmap_Ke c.png\nmap_Pr d.png\n");
    EXPECT_THAT(maps.warnings, testing::Contains(testing::HasSubstr(
                                   "material 'm': textures of opacity, bump, emission, roughness are not supported")));
    const Scene placed = obj_scene(folder, "map_Kd -s 2 2 1 a.png\n");
    EXPECT_THAT(placed.warnings, testing::Contains(testing::HasSubstr("m.mtl:3: a texture's scale")));
}

TEST(SceneRecipe, TexturesOfObjAreFoundBesideIt)
{
    const TempFolder folder;
    const char       png[] =
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\b\0\0\0\0:~\x9bU\0\0\0\nIDATx\x9c\x63h\0\0\0\x82\0\x81"
        "w\xcdr\xb6\0\0\0\0IEND\xae\x42\x60\x82";
    folder.write("oak.png", std::string(png, sizeof(png) - 1));
    for (const char* name : {"oak.png \t", "C:\\my models\\oak.png", "/home/someone/oak.png"}) {
        const Scene scene = obj_scene(folder, std::string("map_Kd ") + name + "\n");
        EXPECT_EQ(scene.textures.size(), 1U) << name;
        EXPECT_TRUE(scene.warnings.empty()) << name << ": " << scene.warnings.front();
    }
    EXPECT_THAT(obj_scene(folder, "map_Kd elm.png\n").warnings, testing::Contains(testing::HasSubstr("elm.png")));
}

TEST(SceneRecipe, VerticesHaveTheirColours)
{
    const TempFolder folder;
    const Scene      scene = obj_scene(folder, "", " 1 0 0.5"); // 0.5 in sRGB is 0.214 in linear light
    EXPECT_VEC_NEAR(scene.vertices.at(0).colour, glm::vec4(1, 0, 0.21404F, 1), 1e-4F);
    EXPECT_EQ(scene.materials.at(0).base_colour, glm::vec4(1)) << "no material: the colours are those of the vertices";
    EXPECT_EQ(obj_scene(folder, "Ns 0\n", " 1 0 0.5").materials.at(0).base_colour, glm::vec4(0.5F, 0.5F, 0.5F, 1));
}

TEST(SceneRecipe, EndingsOfFilesMayBeInCapitals)
{
    TempFolder folder;
    GltfFile   file              = GltfFile::triangle();
    file.primitive()["material"] = 0;
    file.root["materials"]       = {{{"pbrMetallicRoughness", {{"roughnessFactor", 0.25}}}}};
    folder.write("PART.GLB", file.glb());
    const Scene scene = load_scene(folder.write("scene.toml", "[[part]]\nfile = 'PART.GLB'\n"));
    EXPECT_EQ(scene.materials.at(scene.draws.at(0).material).metallic, 1) << "as the loader of glTF has it";
    EXPECT_EQ(scene.materials.at(scene.draws.at(0).material).roughness, 0.25F);
}

TEST(SceneRecipe, BrokenModelsFailWithTheirName)
{
    TempFolder folder;
    folder.write("broken.obj", "v 0 0 0\nf 1 2 9\n");
    folder.write("empty.obj", "");
    for (const char* file : {"broken.obj", "empty.obj"}) {
        const std::string recipe = folder.write("a.toml", fmt::format("[[part]]\nfile = '{}'\n", file));
        EXPECT_THAT(error_of<Failure>(recipe), HasSubstr(file));
    }
}

TEST(SceneRecipe, PatternsMatch)
{
    EXPECT_TRUE(matches("*", ""));
    EXPECT_TRUE(matches("*chrome*", "Dark_Chrome_2"));
    EXPECT_TRUE(matches("a?c", "abc"));
    EXPECT_FALSE(matches("a?c", "ac"));
    EXPECT_FALSE(matches("chrome", "chrome2"));
    EXPECT_TRUE(matches("*a*b", "xaxxab"));
}

TEST(SceneShapes, TheTeapotIsClosedAndFacesOutwards)
{
    Model model;
    model.meshes.push_back(make_teapot(8));
    const Bounds bounds = bounds_of(model);
    EXPECT_VEC_NEAR(bounds.size_m(), glm::dvec3(6.43, 3.15, 4.0), 0.05);
    EXPECT_NEAR(bounds.min_ws.y, 0, 1e-9);
    const Mesh& mesh   = model.meshes[0];
    size_t      wrong  = 0;
    double      volume = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a = mesh.positions_ws[mesh.indices[i]];
        const glm::dvec3 b = mesh.positions_ws[mesh.indices[i + 1]];
        const glm::dvec3 c = mesh.positions_ws[mesh.indices[i + 2]];
        volume += glm::dot(a, glm::cross(b, c)) / 6;
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        for (size_t k = i; k < i + 3; ++k)
            if (glm::dot(normal, glm::dvec3(mesh.vertices[mesh.indices[k]].normal_ws)) < 0.3) ++wrong;
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(volume, 20) << "fronts face outwards";
    EXPECT_LT(volume, 32);
}

TEST(SceneShapes, SmoothNormalsIgnoreHowVerticesAreShared)
{
    Mesh sphere = make_sphere({0, 0, 0}, 1, 64, 32);
    for (Vertex& vertex : sphere.vertices) vertex.normal_ws = {0, 1, 0};
    sphere.has_normals = false;
    make_smooth_normals(sphere, 60);
    for (size_t i = 0; i < sphere.vertices.size(); ++i)
        ASSERT_VEC_NEAR(glm::dvec3(sphere.vertices[i].normal_ws), glm::normalize(sphere.positions_ws[i]), 0.06);

    Mesh box        = make_box({0, 0, 0}, {1, 1, 1});
    box.has_normals = false;
    weld_equal_vertices(box);
    make_smooth_normals(box, 60);
    for (const Vertex& vertex : box.vertices)
        EXPECT_FLOAT_EQ(
            std::max({std::abs(vertex.normal_ws.x), std::abs(vertex.normal_ws.y), std::abs(vertex.normal_ws.z)}), 1)
            << "edges stay sharp";
}

TEST(SceneRecipe, RotationsAreAboutXThenYThenZ)
{
    const auto size_m = [](const char* rotation_deg) {
        const Draw draw =
            load_text(fmt::format("[[part]]\nshape = 'box'\nsize_m = [1, 2, 3]\nrotation_deg = {}\n", rotation_deg))
                .draws.at(0);
        return draw.bounds_max_ws - draw.bounds_min_ws;
    };
    // A quarter turn exchanges two of the three sizes.
    EXPECT_VEC_NEAR(size_m("[90, 0, 90]"), glm::vec3(3, 1, 2), 1e-5F);
    EXPECT_VEC_NEAR(size_m("[0, 90, 90]"), glm::vec3(2, 3, 1), 1e-5F);
    EXPECT_VEC_NEAR(size_m("[90, 90, 0]"), glm::vec3(2, 3, 1), 1e-5F);
    // The pyramid's top, 1.5 m from the middle, turns from y to z, to -x, and to x by way of z.
    const auto top = [](const char* rotation_deg) {
        glm::vec3   far(0);
        const Scene scene = load_text(fmt::format("[[part]]\nfile = 'pyramid.obj'\nrotation_deg = {}\n", rotation_deg));
        for (const Vertex& vertex : scene.vertices) {
            const glm::vec3 from_middle = vertex.position_ws - glm::vec3(0, 1, 0);
            if (std::abs(from_middle.y) < 1e-4F) far = from_middle; // the others are corners
        }
        return far;
    };
    EXPECT_VEC_NEAR(top("[90, 0, 0]"), glm::vec3(0, 0, 1.5F), 1e-5F);
    EXPECT_VEC_NEAR(top("[0, 0, 90]"), glm::vec3(-1.5F, 0, 0), 1e-5F);
    EXPECT_VEC_NEAR(top("[90, 90, 0]"), glm::vec3(1.5F, 0, 0), 1e-5F);
}

TEST(SceneRecipe, MaterialsChangeAsTold)
{
    const Material box = load_text("[[part]]\nshape = 'box'\n[part.material]\nmetallic = 0.5\nroughness = 0.25\n"
                                   "ior = 2\nbase_colour = [0.1, 0.2, 0.3]\nemissive = [1, 2, 3]\n"
                                   "double_sided = true\n")
                             .materials.at(0);
    EXPECT_EQ(box.metallic, 0.5F);
    EXPECT_EQ(box.roughness, 0.25F);
    EXPECT_FLOAT_EQ(box.dielectric_f0, 1.0F / 9);
    EXPECT_VEC_NEAR(box.base_colour, glm::vec4(0.1F, 0.2F, 0.3F, 1), 1e-6F);
    EXPECT_EQ(box.emissive, glm::vec3(1, 2, 3));
    EXPECT_TRUE(box.double_sided);

    const Scene changed = load_text("[[part]]\nfile = 'pyramid.obj'\n[[part]]\nshape = 'box'\nposition = [9, 0, 0]\n"
                                    "[[material]]\nname = 'stone'\nleave_out = true\n"
                                    "[[material]]\npart = 'pyramid'\nmetallic = 1\ndouble_sided = false\n");
    ASSERT_EQ(changed.draws.size(), 2U) << "stone is left out";
    const Material &gold = material_named(changed, "gold_leaf"), &other = material_named(changed, "box");
    EXPECT_EQ(gold.metallic, 1);
    EXPECT_FALSE(gold.double_sided);
    EXPECT_EQ(other.metallic, 0) << "another part";
    // Of the file: Phong's exponent 30 is alpha^2 = 2 / 32, and roughness the root of alpha.
    EXPECT_NEAR(gold.roughness, 0.5, 1e-6);
    EXPECT_VEC_NEAR(gold.base_colour, glm::vec4(0.9F, 0.7F, 0.1F, 1), 1e-6F);
    const Scene plain = load_text("[[part]]\nfile = 'pyramid.obj'\n");
    EXPECT_FLOAT_EQ(material_named(plain, "stone").roughness, 0.9F) << "no highlight";
    EXPECT_TRUE(material_named(plain, "stone").double_sided);
}

TEST(SceneRecipe, LightsHaveAKindARangeAndASoftEdge)
{
    const Scene scene = load_text("[[part]]\nshape = 'box'\n"
                                  "[[light]]\ntype = 'point'\nposition = [1, 2, 3]\nintensity = 5\nrange_m = 7\n"
                                  "[[light]]\ntype = 'spot'\nposition = [0, 0, 9]\ntarget = [0, 0, 5]\n"
                                  "angle_deg = 120\nintensity = 5\n");
    EXPECT_EQ(scene.lights.at(0).type, LightType::point);
    EXPECT_EQ(scene.lights[0].position_ws, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[0].range_m, 7);
    EXPECT_TRUE(scene.lights[0].casts_shadow);
    EXPECT_EQ(scene.lights.at(1).direction_ws, glm::vec3(0, 0, -1));
    EXPECT_NEAR(scene.lights[1].outer_angle_rad, std::acos(-1.0) / 3, 1e-6);
    EXPECT_NEAR(scene.lights[1].inner_angle_rad, std::acos(-1.0) / 4, 1e-6) << "three quarters of the outer angle";
    EXPECT_EQ(scene.lights[1].range_m, 0);
}

TEST(SceneRecipe, TilesAlternateByTheMetre)
{
    const Scene scene = load_text("[[part]]\nshape = 'checker_floor'\nsize_m = [6, 0, 4]\ntile_m = 0.5\n"
                                  "tile_colours = [[1, 0, 0], [0, 0, 1]]\n");
    glm::vec2   least(1e9F), most(-1e9F);
    for (const Vertex& vertex : scene.vertices) {
        least = glm::min(least, vertex.uv0), most = glm::max(most, vertex.uv0);
        // The texture's u runs along x, its v away from the far edge.
        EXPECT_NEAR(vertex.uv0.x, vertex.position_ws.x + 3, 1e-5);
        EXPECT_NEAR(vertex.uv0.y, vertex.position_ws.z + 2, 1e-5);
    }
    EXPECT_VEC_NEAR(glm::vec3(most - least, 0), glm::vec3(6, 4, 0), 1e-5F); // a repeat is two tiles
    const Texture& texture = scene.textures.at(0);
    const auto     texel   = [&](int x, int y) {
        const uint8_t* rgba = &texture.rgba[4 * size_t(x + y * texture.size_px.x)];
        return glm::ivec3(rgba[0], rgba[1], rgba[2]);
    };
    const int last = texture.size_px.x - 1;
    EXPECT_EQ(texel(0, 0), glm::ivec3(255, 0, 0));
    EXPECT_EQ(texel(last, last), glm::ivec3(255, 0, 0));
    EXPECT_EQ(texel(last, 0), glm::ivec3(0, 0, 255));
    EXPECT_EQ(texel(0, last), glm::ivec3(0, 0, 255));
    EXPECT_TRUE(texture.srgb);
    EXPECT_TRUE(texture.nearest);
}

TEST(SceneRecipe, WithoutViewsAndLightsTheyAreFitted)
{
    const Scene   scene  = load_text("[[part]]\nshape = 'box'\nsize_m = [2, 4, 4]\nposition = [1, 0, 0]\n");
    const Camera& camera = scene.cameras.at(0);
    // A sphere of 3 m around the box, a twentieth farther away than where it fills the view of 50 degrees.
    const double distance_m = 1.05 * 3 / std::sin(25 * std::acos(-1.0) / 180);
    EXPECT_VEC_NEAR(camera.target_ws, glm::dvec3(1, 2, 0), 1e-9);
    EXPECT_VEC_NEAR(camera.position_ws - camera.target_ws, distance_m * glm::normalize(glm::dvec3(0.5, 0.4, 1)), 1e-9);
    EXPECT_NEAR(camera.near_m, distance_m / 100, 1e-9);
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.type, LightType::directional);
    EXPECT_EQ(light.intensity, glm::vec3(2.5F));
    EXPECT_VEC_NEAR(light.direction_ws, glm::normalize(glm::vec3(-0.4F, -1, -0.6F)), 1e-6F);
}

TEST(SceneShapes, TexturesAreLaidInMetres)
{
    const double pi   = std::acos(-1.0);
    const auto   most = [](const Mesh& mesh) {
        glm::vec2 uv(0);
        for (const Vertex& vertex : mesh.vertices) uv = glm::max(uv, vertex.uv0);
        return glm::vec3(uv, 0);
    };
    EXPECT_VEC_NEAR(most(make_sphere({0, 0, 0}, 2, 8, 4)), glm::vec3(4 * pi, 2 * pi, 0), 1e-5F);
    EXPECT_VEC_NEAR(most(make_cylinder({0, 0, 0}, 2, 3, 8)), glm::vec3(4 * pi, 3, 0), 1e-5F);
    EXPECT_VEC_NEAR(most(make_quad({0, 0, 0}, {5, 0, 0}, {0, 0, -2})), glm::vec3(5, 2, 0), 1e-6F);
    const Mesh   round = make_cylinder({1, 2, 3}, 2, 3, 8);
    const Bounds box   = [&] {
        Bounds bounds;
        for (const glm::dvec3& position : round.positions_ws) bounds.add(position);
        return bounds;
    }();
    EXPECT_VEC_NEAR(box.min_ws, glm::dvec3(-1, 2, 1), 1e-9);
    EXPECT_VEC_NEAR(box.max_ws, glm::dvec3(3, 5, 5), 1e-9);
    for (const Shape shape : {Shape::sphere, Shape::cylinder}) {
        const Draw draw = load_text(fmt::format("[[part]]\nshape = '{}'\nsize_m = [2, 4, 6]\n",
                                                shape == Shape::sphere ? "sphere" : "cylinder"))
                              .draws.at(0);
        EXPECT_VEC_NEAR(draw.bounds_min_ws, glm::vec3(-1, 0, -3), 1e-5F);
        EXPECT_VEC_NEAR(draw.bounds_max_ws, glm::vec3(1, 4, 3), 1e-5F);
    }
}

} // namespace
} // namespace ssrlab
