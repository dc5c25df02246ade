// The environment map: its convention, its lookup, its files and its way through recipes.
#include "scene_files.h"

#include "compare/image_io.h"
#include "scene/environment.h"
#include "scene/scene.h"

#include <OpenImageIO/imageio.h>

namespace ssrlab {
namespace {

using ::testing::HasSubstr;

/// Radiance (column, row, 0).
EnvironmentMap numbered(glm::ivec2 size_px)
{
    EnvironmentMap map;
    map.size_px = size_px;
    for (const auto [i, x, y] : test::pixels_of(size_px)) map.radiance.emplace_back(x, y, 0);
    return map;
}

/// `margin_px`: by so much the picture is larger on each side than what the file holds.
void write_picture(const std::filesystem::path& file, glm::ivec2 size_px, const std::vector<float>& values,
                   int margin_px = 0)
{
    const auto      output = OIIO::ImageOutput::create(file.string());
    OIIO::ImageSpec spec(size_px.x, size_px.y, 3, OIIO::TypeDesc::FLOAT);
    spec.x = spec.y  = margin_px;
    spec.full_width  = size_px.x + 2 * margin_px;
    spec.full_height = size_px.y + 2 * margin_px;
    ASSERT_TRUE(output && output->open(file.string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
}

TEST(SceneEnvironment, DirectionsAreWhereTheHeaderSays)
{
    const auto expect_uv = [](glm::dvec3 direction, glm::dvec2 uv) {
        EXPECT_LT(glm::length(direction_to_uv(direction) - uv), 1e-12) << direction.x << ' ' << direction.y;
        EXPECT_LT(glm::length(uv_to_direction(uv) - glm::normalize(direction)), 1e-12);
    };
    expect_uv({0, 0, -1}, {0.5, 0.5});
    expect_uv({1, 0, 0}, {0.75, 0.5});
    expect_uv({-1, 0, 0}, {0.25, 0.5});
    expect_uv({3, 0, -3}, {0.625, 0.5});
    expect_uv({0, 2, -2}, {0.5, 0.25});
    expect_uv({0, -1, -1}, {0.5, 0.75});
    EXPECT_NEAR(direction_to_uv({0, 1, 0}).y, 0, 1e-12);
    EXPECT_NEAR(direction_to_uv({0, -1, 0}).y, 1, 1e-12);
}

TEST(SceneEnvironment, TexelCentresGiveTheirTexelAndMiddlesTheMean)
{
    const EnvironmentMap map = numbered({16, 8});
    for (const auto [i, x, y] : test::pixels_of({16, 8}))
        ASSERT_VEC_NEAR(environment_radiance(map, uv_to_direction({(x + 0.5) / 16, (y + 0.5) / 8})), glm::vec3(x, y, 0),
                        1e-5F);
    ASSERT_VEC_NEAR(environment_radiance(map, uv_to_direction({4.0 / 16, 3.0 / 8})), glm::vec3(3.5F, 2.5F, 0), 1e-5F);
}

TEST(SceneEnvironment, WrapsAroundAndStopsAtThePoles)
{
    const EnvironmentMap map = numbered({16, 8});
    // Backwards, u = 0 and 1: between the last column and the first.
    ASSERT_VEC_NEAR(environment_radiance(map, {0, 0, 1}), glm::vec3(7.5F, 3.5F, 0), 1e-4F);
    ASSERT_VEC_NEAR(environment_radiance(map, {-1e-9, 0, 1}), glm::vec3(7.5F, 3.5F, 0), 1e-4F);
    EXPECT_EQ(environment_radiance(map, {0, 1, 0}).y, 0);
    EXPECT_EQ(environment_radiance(map, {0, -1, 0}).y, 7);
}

TEST(SceneEnvironment, OneColourStaysThatColourToTheLastBit)
{
    EnvironmentMap map = numbered({16, 8});
    std::ranges::fill(map.radiance, glm::vec3(0.1F, 0.2F, 0.7F));
    for (int i = 0; i < 1000; ++i)
        ASSERT_EQ(environment_radiance(map, {std::sin(i), std::cos(2.3 * i), std::sin(0.7 * i)}),
                  glm::vec3(0.1F, 0.2F, 0.7F));
}

TEST(SceneEnvironment, TheSunStandsWhereTheLightComesFrom)
{
    const Scene      scene  = load_scene("builtin:puddle");
    const glm::dvec3 to_sun = -glm::dvec3(scene.lights[0].direction_ws);
    EXPECT_GT(sky_radiance(scene, to_sun).r, 7);
    EXPECT_LT(sky_radiance(scene, {0, 1, 0}).r, 1);
    EXPECT_GT(sky_radiance(scene, {0, 1, 0}).b, sky_radiance(scene, {0, 1, 0}).r) << "the sky is blue";
}

TEST(SceneEnvironment, WithoutAMapTheSkyIsTheBackground)
{
    const Scene scene = load_scene("builtin:stairs");
    EXPECT_EQ(sky_radiance(scene, {0.3, 0.2, 0.9}), scene.background);
}

TEST(SceneEnvironment, ADeclaredSkyHasItsColours)
{
    const EnvironmentMap map = make_sky({.zenith = {0, 0, 1}, .horizon = {1, 1, 1}, .ground = {0.2, 0.1, 0}});
    ASSERT_VEC_NEAR(environment_radiance(map, {0, 1, 0}), glm::vec3(0, 0, 1), 0.01F);
    ASSERT_VEC_NEAR(environment_radiance(map, {0, -1, 0}), glm::vec3(0.2F, 0.1F, 0), 1e-6F);
    // Between them the square root of the height, so most of the change is near the horizon.
    ASSERT_VEC_NEAR(environment_radiance(map, {0.8, 0.36, 0.48}), glm::vec3(0.4F, 0.4F, 1), 0.01F);
    for (int i = 0; i < 100; ++i)
        ASSERT_EQ(environment_radiance(map, {std::sin(i), -0.3, std::cos(i)}), glm::vec3(0.2F, 0.1F, 0));
}

class EnvironmentFiles : public testing::Test {
protected:
    std::string recipe(const std::string& lines) const
    {
        return folder_.write("scene.toml", lines + "\n[[part]]\nshape = 'box'\n");
    }
    TempFolder folder_;
};

TEST_F(EnvironmentFiles, AreReadScaledAndPutIntoTheScene)
{
    std::vector<float> values;
    for (int i = 0; i < 4 * 2 * 3; ++i) values.push_back(0.25F * float(i));
    for (const char* name : {"sky.exr", "sky.hdr"}) {
        write_picture(folder_ / name, {4, 2}, values);
        const Scene scene = load_scene(recipe(std::string("environment = '") + name + "'\nenvironment_scale = 2"));
        ASSERT_EQ(scene.environment.size_px, glm::ivec2(4, 2));
        EXPECT_TRUE(scene.warnings.empty());
        for (size_t i = 0; i < 8; ++i) // .hdr keeps 8 bits
            ASSERT_VEC_NEAR(scene.environment.radiance[i],
                            2.0F * glm::vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]), 0.07F);
    }
}

TEST_F(EnvironmentFiles, ASkyOfARecipeTakesTheirPlace)
{
    const Scene scene = load_scene(recipe("sky = { zenith = [0, 0, 1], horizon = 0.5 }"));
    ASSERT_VEC_NEAR(sky_radiance(scene, {0, -1, 0}), glm::vec3(0.5F), 1e-6F) << "the ground is as the horizon";
    ASSERT_VEC_NEAR(sky_radiance(scene, {0, 1, 0}), glm::vec3(0, 0, 1), 0.01F);
    EXPECT_THAT(error_of<SpecError>(recipe("background = 1\nsky = { zenith = 1, horizon = 1 }")),
                testing::AllOf(HasSubstr("scene.toml:2"), HasSubstr("'sky' cannot stand beside")));
    EXPECT_THAT(error_of<SpecError>(recipe("sky = { zenith = 1 }")),
                testing::AllOf(HasSubstr("scene.toml:1"), HasSubstr("'horizon'")));
    EXPECT_THAT(error_of<SpecError>(recipe("sky = { zenith = 1, horizon = 1, sun = 1 }")), HasSubstr("'sun'"));
}

TEST_F(EnvironmentFiles, ClampWhatNoPictureCanHold)
{
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    write_picture(folder_ / "sky.exr", {2, 1}, {inf, -1, nan, 1, 2, 3});
    const Scene scene = load_scene(recipe("environment = 'sky.exr'"));
    EXPECT_EQ(scene.environment.radiance[0], glm::vec3(65504, 0, 0));
    EXPECT_EQ(scene.environment.radiance[1], glm::vec3(1, 2, 3));
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_THAT(scene.warnings[0], HasSubstr("2 values"));
}

TEST_F(EnvironmentFiles, ColoursAreFoundByTheirNames)
{
    const auto radiance = [&](const std::vector<std::string>& channels, const std::vector<float>& values) {
        Image image{{2, 1}, channels, values, {}};
        image.values.insert(image.values.end(), values.begin(), values.end());
        write_image(folder_ / "sky.exr", image);
        return load_scene(recipe("environment = 'sky.exr'")).environment.radiance.at(1);
    };
    EXPECT_EQ(radiance({"env.R", "env.G", "env.B", "Z"}, {1, 2, 3, 9}), glm::vec3(1, 2, 3));
    EXPECT_EQ(radiance({"albedo.R", "albedo.G", "albedo.B", "R", "G", "B"}, {9, 9, 9, 1, 2, 3}), glm::vec3(1, 2, 3));
    EXPECT_EQ(radiance({"Y", "Z"}, {2, 9}), glm::vec3(2));
    const std::string normals = recipe("environment = 'sky.exr'");
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"N.X", "N.Y", "N.Z"}, {"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}}) {
        write_image(folder_ / "sky.exr", {{2, 1}, names, std::vector<float>(2 * names.size(), 1), {}});
        EXPECT_THAT(error_of<SpecError>(normals),
                    testing::AllOf(HasSubstr("sky.exr: expected channels R, G and B"), HasSubstr(names.back())));
    }
}

TEST_F(EnvironmentFiles, HeadersOfHdrAreObeyedOrRefused)
{
    const auto write_hdr = [&](const std::string& lines, const std::string& resolution) {
        // 128 with the exponent 129 is 1 (G. Ward).
        const std::string pixel("\x80\x40\x20\x81");
        folder_.write("sky.HDR",
                      "#?RADIANCE\n" + lines + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n" + pixel + pixel);
        return recipe("environment = 'sky.HDR'");
    };
    EXPECT_VEC_NEAR(load_scene(write_hdr("", "-Y 1 +X 2")).environment.radiance.at(0), glm::vec3(1, 0.5F, 0.25F),
                    0.01F);
    EXPECT_VEC_NEAR(load_scene(write_hdr("EXPOSURE=4\nEXPOSURE= 0.5\n", "-Y 1 +X 2")).environment.radiance.at(0),
                    glm::vec3(0.5F, 0.25F, 0.125F), 0.01F);
    for (const char* other : {"+Y 1 +X 2", "-Y 1 -X 2"})
        EXPECT_THAT(error_of<SpecError>(write_hdr("", other)),
                    testing::AllOf(HasSubstr("sky.HDR: expected rows from the top"), HasSubstr(other)));
    EXPECT_THAT(error_of<SpecError>(write_hdr("EXPOSURE=0\n", "-Y 1 +X 2")), HasSubstr("EXPOSURE"));
    EXPECT_THAT(error_of<SpecError>(write_hdr("GAMMA=2.2\n", "-Y 1 +X 2")), HasSubstr("GAMMA"));
}

TEST_F(EnvironmentFiles, MistakesNamePlaceExpectedAndGot)
{
    EXPECT_THAT(error_of<SpecError>(recipe("\nenvironment = 'sky.png'")),
                testing::AllOf(HasSubstr("scene.toml:2"), HasSubstr(".exr"), HasSubstr("sky.png")));
    EXPECT_THAT(error_of<SpecError>(recipe("environment = 'none.exr'")),
                testing::AllOf(HasSubstr("scene.toml:1"), HasSubstr("none.exr")));
    EXPECT_THAT(error_of<SpecError>(recipe("environment_scale = 2")), HasSubstr("needs 'environment'"));
    EXPECT_THAT(error_of<SpecError>(recipe("environment = 'none.exr'\nenvironment_scale = -1")), HasSubstr("[0, "));
    write_picture(folder_ / "square.exr", {2, 2}, std::vector<float>(12));
    EXPECT_THAT(error_of<Failure>(recipe("environment = 'square.exr'")),
                testing::AllOf(HasSubstr("square.exr"), HasSubstr("twice as wide as high"), HasSubstr("2x2")));
    write_picture(folder_ / "wide.exr", {16386, 1}, std::vector<float>(3 * 16386));
    EXPECT_THAT(error_of<SpecError>(recipe("environment = 'wide.exr'")),
                testing::AllOf(HasSubstr("wide.exr"), HasSubstr("16386x1"), HasSubstr("at most 16384 a side")));
    write_picture(folder_ / "part.exr", {4, 2}, std::vector<float>(24), 1);
    EXPECT_THAT(error_of<Failure>(recipe("environment = 'part.exr'")),
                testing::AllOf(HasSubstr("part.exr"), HasSubstr("4x2 pixels at (1, 1) of a picture of 6x4")));
    folder_.write("broken.exr", "not a picture");
    EXPECT_THAT(error_of<Failure>(recipe("environment = 'broken.exr'")), HasSubstr("broken.exr"));
    folder_.write("folder.exr/file", "");
    EXPECT_THAT(error_of<Failure>(recipe("environment = 'folder.exr'")), HasSubstr("not a regular file"));
}

} // namespace
} // namespace ssrlab
