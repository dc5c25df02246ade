// Frames of other renderers: every convention against the same distances, and what is said about files that cannot be right.
#include "compare/image_io.h"
#include "core/error.h"
#include "core/pixel_index.h"
#include "errors.h"
#include "scene/environment.h"
#include "scene/exr_file.h"
#include "scene/frame_channels.h"
#include "scene/load_scene.h"
#include "scene/scene.h"
#include "scene/sequence.h"
#include "temp_folder.h"
#include "test.h"

#include <OpenImageIO/imageio.h>

namespace ssrlab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

constexpr glm::ivec2  size_px{8, 6};
constexpr double      near_m = 0.25, far_m = 50;
constexpr const char* camera = "[camera]\nfov_y_deg = 90\nnear_m = 0.25\n";

/// Of a wall that slopes away to the right; the last pixel is background.
double distance_m(size_t i) { return 2 + 0.5 * static_cast<double>(pixel_at(i, size_px).x); }
bool   covered(size_t i) { return i + 1 < pixel_count(size_px); }

/// Sent along the pixel's ray: slopes at 90 degrees and 6 rows.
double ray_length(size_t i)
{
    const glm::dvec2 slope = (glm::dvec2(pixel_at(i, size_px)) + 0.5 - 0.5 * glm::dvec2(size_px)) / 3.0;
    return glm::length(glm::dvec3(slope, 1));
}

class LoadFrame : public testing::Test {
protected:
    using Values = std::function<double(size_t)>;

    void channel(const std::string& name, const Values& value) { channels_.emplace_back(name, value); }

    /// Depth and what else a frame must have, facing the camera.
    void whole_frame(const std::string& depth, const Values& value)
    {
        channel(depth, value);
        const glm::dvec3 normal(0, 0, 1);
        for (int c = 0; c < 3; ++c) channel(std::string("normal_vs.") + "xyz"[c], [=](size_t) { return normal[c]; });
        channel("roughness", [](size_t) { return 0.25; });
        channel("metallic", [](size_t) { return 0.5; });
    }

    std::string write(const std::string& convention)
    {
        Image image{size_px, {}, {}, {}};
        for (const auto& [name, value] : channels_) image.channels.push_back(name);
        for (size_t i = 0; i < pixel_count(size_px); ++i)
            for (const auto& [name, value] : channels_) image.values.push_back(static_cast<float>(value(i)));
        write_image(folder_ / "f.exr", image);
        if (!convention.empty()) folder_.write("f.exr.toml", convention);
        return (folder_ / "f.exr").string();
    }

    Frame load(const std::string& convention) { return load_frame(write(convention)); }

    template <typename Error = SpecError> std::string refused(const std::string& convention)
    {
        const std::string path = write(convention);
        return message_of<Error>([&] { load_frame(path); });
    }

    void expect_the_wall(const Frame& frame) const
    {
        for (size_t i = 0; i < pixel_count(size_px); ++i) {
            const double expected = covered(i) ? near_m / distance_m(i) : 0;
            ASSERT_NEAR(frame.gbuffer.depth[i], expected, 2e-6 * expected) << "pixel " << i;
        }
    }

    TempFolder                                  folder_;
    std::vector<std::pair<std::string, Values>> channels_;
};

TEST_F(LoadFrame, EveryDepthConventionGivesTheSameDistances)
{
    const double infinity = std::numeric_limits<double>::infinity();
    struct Convention {
        std::string text;
        Values      value;
    };
    const std::string with_far      = std::string(camera) + "far_m = 50\n";
    const Convention  conventions[] = {
         {std::string(camera) + "[depth]\nkind = 'reversed'\n", [](size_t i) { return near_m / distance_m(i); }},
         {with_far + "[depth]\nkind = 'reversed'\n",
          [](size_t i) { return near_m * (far_m - distance_m(i)) / (distance_m(i) * (far_m - near_m)); }},
         {with_far + "[depth]\nkind = 'standard'\n",
          [](size_t i) { return far_m * (distance_m(i) - near_m) / (distance_m(i) * (far_m - near_m)); }},
         {std::string(camera) + "[depth]\nkind = 'standard'\n", [](size_t i) { return 1 - near_m / distance_m(i); }},
         {std::string(camera) + "[depth]\nkind = 'distance'\n", [](size_t i) { return distance_m(i); }},
         {std::string(camera) + "[depth]\nkind = 'distance'\nunit_m = 0.01\nbackground_m = 900\n",
          [](size_t i) { return 100 * distance_m(i); }},
         {std::string(camera) + "[depth]\nkind = 'ray_distance'\n",
          [](size_t i) { return distance_m(i) * ray_length(i); }}};
    for (size_t k = 0; k < std::size(conventions); ++k) {
        SCOPED_TRACE(conventions[k].text);
        const double nothing = k < 2 ? 0 : k < 4 ? 1 : k == 5 ? 65504 * 100.0 : infinity;
        channels_.clear();
        whole_frame("Depth.Z", [&, k](size_t i) { return covered(i) ? conventions[k].value(i) : nothing; });
        expect_the_wall(load(conventions[k].text));
    }
}

// Depth is linear in the distance, and a ray's way is its distance.
TEST_F(LoadFrame, OrthographicDepthConventionsGiveTheSameDistances)
{
    const std::string flat =
        "[camera]\nprojection = 'orthographic'\nheight_m = 6\nnear_m = 0.25\nfar_m = 50\n[depth]\n";
    const auto                           reversed = [](size_t i) { return (far_m - distance_m(i)) / (far_m - near_m); };
    const std::pair<const char*, Values> conventions[] = {
        {"kind = 'reversed'\n", reversed},
        {"kind = 'standard'\n", [&](size_t i) { return 1 - reversed(i); }},
        {"kind = 'distance'\n", distance_m},
        {"kind = 'ray_distance'\n", distance_m}};
    for (const auto& [text, value] : conventions) {
        channels_.clear();
        whole_frame("Depth.Z", value);
        const Frame frame = load(flat + text);
        for (size_t i = 0; i < pixel_count(size_px); ++i) // the file and what is read round to float
            ASSERT_NEAR(frame.gbuffer.depth[i], reversed(i), std::ldexp(1.0, -22)) << text << i;
    }
}

TEST_F(LoadFrame, NormalsOfTheWorldTurnIntoTheCamera)
{
    channel("ViewLayer.Depth.Z", [](size_t) { return 3.0; });
    // The world is z up; the camera looks along +y. Stored in 0 … 1: a wall that faces it, (0, -1, 0).
    const glm::dvec3 stored(0.5, 0, 0.5);
    for (int c = 0; c < 3; ++c) channel(std::string("ViewLayer.Normal.") + "XYZ"[c], [=](size_t) { return stored[c]; });
    channel("ViewLayer.roughness.X", [](size_t) { return 0; });
    channel("ViewLayer.metallic.X", [](size_t) { return 1; });
    const std::string axes  = "right = [1, 0, 0]\nup = [0, 0, 1]\nforward = [0, 1, 0]\n";
    const std::string depth = "[depth]\nkind = 'distance'\n";
    const Frame       frame = load(camera + axes + depth + "[normals]\nspace = 'world'\nunsigned = true\n");
    for (const glm::vec3& normal : frame.gbuffer.normal_vs) EXPECT_LT(glm::length(normal - glm::vec3(0, 0, 1)), 1e-6F);

    EXPECT_THAT(refused(camera + axes + depth),
                HasSubstr("'ViewLayer.Normal.X': nothing says whether it is in view or world"));
    EXPECT_THAT(refused(camera + depth + "[normals]\nspace = 'world'\n"), HasSubstr("need the camera's 'right', 'up'"));
    EXPECT_THAT(
        refused(camera + axes + depth + "[normals]\nspace = 'world'\n"),
        AllOf(HasSubstr("f.exr: channel 'ViewLayer.Normal.X'"), HasSubstr("expected normals of length 1, got 0.71")));
    EXPECT_THAT(
        load(camera + axes + depth + "[normals]\nspace = 'world'\nunsigned = true\nflip = 'y'\n").warnings.front(),
        HasSubstr("100 % of the normals look away"));
}

TEST_F(LoadFrame, SpecularAndSmoothnessStandForMetallicAndRoughness)
{
    channel("depth", [](size_t) { return 0.1; });
    for (const char* name : {"normal_vs.x", "normal_vs.y"}) channel(name, [](size_t) { return 0; });
    channel("normal_vs.z", [](size_t) { return 1; });
    channel("Smoothness.R", [](size_t) { return 0.75; });
    for (const char* name : {"Specular.R", "Specular.G", "Specular.B"})
        channel(name, [](size_t i) { return i == 0 ? 0.04 : 0.52; });
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'reversed'\n");
    EXPECT_EQ(frame.gbuffer.roughness[0], 0.25F);
    EXPECT_NEAR(frame.gbuffer.metallic[0], 0, 1e-6);
    EXPECT_NEAR(frame.gbuffer.metallic[1], 0.5, 1e-6);
    EXPECT_THAT(frame.warnings, testing::Contains(HasSubstr("channel 'Specular.R' is taken as reflectance")));
}

TEST_F(LoadFrame, ChannelsAreNamedValuedOrTakenFromOtherFiles)
{
    whole_frame("what.R", [](size_t i) { return covered(i) ? near_m / distance_m(i) : 0; });
    const std::string head = std::string(camera) + "[depth]\nkind = 'reversed'\n";
    EXPECT_THAT(refused(head), AllOf(HasSubstr("f.exr: no channel is recognised as depth"), HasSubstr("what.R")));
    EXPECT_THAT(refused(head + "[channels]\ndepth = 'there.R'\n"),
                HasSubstr("has no channel 'there.R'; it has metallic, roughness"));
    EXPECT_THAT(refused(head + "[channels]\ndepht = 'what.R'\n"),
                HasSubstr("f.exr.toml:7: unknown key of channels 'depht'"));
    const std::string named =
        head + "[channels]\ndepth = 'what.R'\n'lit.R' = 'l.exr:R'\n'lit.G' = 'l.exr:R'\n'lit.B' = 'l.exr:R'\n";
    EXPECT_THAT(refused(named), HasSubstr("l.exr: no such file"));
    write_image(folder_ / "l.exr", {size_px, {"R"}, std::vector<float>(pixel_count(size_px), 0.5F), {}});
    const Frame frame = load(named + "[values]\nmetallic = 0.75\n");
    expect_the_wall(frame);
    EXPECT_EQ(frame.gbuffer.radiance[3], glm::vec3(0.5F));
    EXPECT_EQ(frame.gbuffer.metallic[3], 0.75F);
    EXPECT_THAT(scene_files((folder_ / "f.exr").string()),
                UnorderedElementsAre(folder_ / "f.exr", folder_ / "f.exr.toml", folder_ / "l.exr", folder_ / "l.exr",
                                     folder_ / "l.exr"));
    write_image(folder_ / "l.exr", {{3, 2}, {"R"}, std::vector<float>(6, 0.5F), {}});
    EXPECT_THAT(refused(named), HasSubstr("3x2 pixels, expected 8x6"));
}

TEST_F(LoadFrame, NamesOfEngines)
{
    const std::vector<ExrChannel> channels = {{"FinalImageMovieRenderQueue_WorldDepth.R", 0, 0, false},
                                              {"FinalImageMovieRenderQueue_WorldDepth.G", 0, 1, false},
                                              {"FinalImageWorldNormal.G", 0, 2, false},
                                              {"FinalImageBaseColor.B", 0, 3, false},
                                              {"R", 0, 4, false},
                                              {"ViewLayer.Combined.G", 0, 5, false},
                                              {"MetalRoughness.X", 0, 6, false},
                                              {"nearest_depth.T", 1, 0, false}, // Mitsuba
                                              {"rgba.B", 2, 0, false}};
    const auto                    name     = [&](const char* quantity) {
        const auto found = find_quantity(channels, quantity);
        return found.size() == 1 ? found[0].name : fmt::format("{} channels", found.size());
    };
    EXPECT_EQ(find_quantity(std::span(channels).first(7), "depth").at(0).name,
              "FinalImageMovieRenderQueue_WorldDepth.R");
    EXPECT_EQ(find_quantity(std::span(channels).subspan(7), "depth").at(0).name, "nearest_depth.T");
    EXPECT_EQ(name("lit.B"), "rgba.B");
    EXPECT_EQ(name("normal.y"), "FinalImageWorldNormal.G");
    EXPECT_EQ(name("normal.x"), "0 channels");
    EXPECT_EQ(name("base_colour.B"), "FinalImageBaseColor.B");
    EXPECT_EQ(name("lit.R"), "R");
    EXPECT_EQ(name("lit.G"), "ViewLayer.Combined.G");
    EXPECT_EQ(name("roughness"), "MetalRoughness.X");
    EXPECT_EQ(normal_space_of("FinalImageWorldNormal.G"), "world");
    EXPECT_EQ(normal_space_of("normal_vs.x"), "view");
    EXPECT_EQ(normal_space_of("ViewLayer.Normal.X"), "");
}

TEST_F(LoadFrame, WhatCannotBeRightIsSaid)
{
    const std::string device = std::string(camera) + "[depth]\nkind = 'reversed'\n";
    whole_frame("depth", [](size_t i) { return i == 10 ? 35.5 : 0.5; });
    EXPECT_THAT(refused(""), HasSubstr("nothing says how the camera looks: write"));
    EXPECT_THAT(refused(camera), HasSubstr("nothing says what depth means: write"));
    EXPECT_THAT(refused(device),
                HasSubstr("f.exr: channel 'depth': expected device depth in 0 … 1, got 35.5 at pixel 2,1"));
    EXPECT_THAT(refused("[camera]\nnear_m = 0.1\n"), AllOf(HasSubstr("f.exr.toml:1"), HasSubstr("'fov_y_deg'")));
    EXPECT_THAT(refused(std::string(camera) + "[depth]\nkind = 'backward'\n"),
                HasSubstr("must be one of reversed, standard"));
    channels_[0].second = [](size_t i) { return i == 7 ? std::nan("") : 0.5; };
    EXPECT_THAT(refused(device), HasSubstr("channel 'depth': expected a number, got nan at pixel 7,0"));
    channels_[0].second = [](size_t) { return 0.1; };
    EXPECT_THAT(refused(std::string(camera) + "[depth]\nkind = 'distance'\n"),
                HasSubstr("the value where nothing is, got 0.1"));
    channels_[4].second = [](size_t) { return 7; };
    EXPECT_THAT(refused(device), HasSubstr("channel 'roughness': expected a value in 0 … 1, got 7"));
    channel("Layer.Depth.Z", [](size_t) { return 1; });
    channels_[0].first = "Other.Depth.Z";
    EXPECT_THAT(refused(device), HasSubstr("'Layer.Depth.Z' and 'Other.Depth.Z' could both be depth"));
    folder_.write("g.exr", "this is no image");
    EXPECT_THAT(message_of<Failure>([&] { load_frame(folder_ / "g.exr"); }), HasSubstr("g.exr: cannot be read as EXR"));
    EXPECT_THAT(message_of<SpecError>([&] { load_scene((folder_ / "h.exr").string()); }),
                HasSubstr("h.exr: no such file"));
}

TEST_F(LoadFrame, AValueMayMeanBackground)
{
    const std::string distances = std::string(camera) + "[depth]\nkind = 'distance'\n";
    const auto        wall_on   = [&](double nothing) {
        channels_.clear();
        whole_frame("depth", [=](size_t i) { return covered(i) ? distance_m(i) : nothing; });
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const double nothing : {0.0, -1.0, double(std::numeric_limits<float>::max()), -infinity, std::nan("")}) {
        wall_on(nothing);
        expect_the_wall(load(distances + fmt::format("background = {:#}\n", nothing)));
        if (nothing > 0) continue; // farther than anything
        EXPECT_THAT(refused(distances), HasSubstr(std::isnan(nothing) ? "expected a number, got nan"
                                                                      : "background = the value where nothing is"));
    }
    wall_on(infinity);
    expect_the_wall(load(distances)); // farther than anything
    wall_on(1e10);
    expect_the_wall(load(distances));
}

TEST_F(LoadFrame, PixelsThatAreNotSquareNarrowTheView)
{
    whole_frame("depth", [](size_t i) { return near_m / distance_m(i); });
    const std::string  fov_y = write(std::string(camera) + "[depth]\nkind = 'reversed'\n");
    const auto         in    = OIIO::ImageInput::open(fov_y);
    OIIO::ImageSpec    spec  = in->spec();
    std::vector<float> values(pixel_count(size_px) * size_t(spec.nchannels));
    ASSERT_TRUE(in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()));
    spec.attribute("PixelAspectRatio", 2.0F); // twice as wide as high
    const auto out = OIIO::ImageOutput::create(fov_y);
    ASSERT_TRUE(out->open(fov_y, spec) && out->write_image(OIIO::TypeDesc::FLOAT, values.data()) && out->close());
    const glm::dvec2 expected(1.5, 3); // 90 degrees over 6 rows: 3 pixels for a slope of 1
    EXPECT_LT(glm::length(load_frame(fov_y).gbuffer.view.focal_px - expected), 1e-9);
    // The same camera by its horizontal angle: 8 columns of 2 rows' heights each, of which half are 8, at a distance of 3.
    folder_.write("f.exr.toml",
                  fmt::format("[camera]\nfov_x_deg = {:.12f}\nnear_m = 0.25\n[depth]\nkind = 'reversed'\n",
                              2 * std::atan(8 / 3.0) * 180 / std::numbers::pi));
    EXPECT_LT(glm::length(load_frame(fov_y).gbuffer.view.focal_px - expected), 1e-9);
}

TEST_F(LoadFrame, IntegersAreNumbersAndNoShares)
{
    whole_frame("unused", distance_m);
    const std::string     path = (folder_ / "z.exr").string();
    OIIO::ImageSpec       spec(size_px.x, size_px.y, 1, OIIO::TypeDesc::UINT32);
    std::vector<uint32_t> millimetres;
    for (size_t i = 0; i < pixel_count(size_px); ++i)
        millimetres.push_back(covered(i) ? static_cast<uint32_t>(std::lround(1000 * distance_m(i))) : 4'000'000'000U);
    spec.channelnames = {"Z"};
    const auto out    = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::UINT32, millimetres.data()) && out->close());
    expect_the_wall(load(std::string(camera) + "[depth]\nkind = 'distance'\nunit_m = 0.001\n"
                                               "[channels]\ndepth = 'z.exr:Z'\n"));
}

TEST_F(LoadFrame, NormalsThatAreZeroComeFromDepthAndShortOnesAreStretched)
{
    const glm::dvec3 wall = glm::normalize(glm::dvec3(-0.5, 0, 1)); // it turns to the left
    const auto       z    = [](size_t i) {                          // the plane -0.5 x + z = -3, at x = -slope z
        const double slope = (double(pixel_at(i, size_px).x) + 0.5 - 4) / 3;
        return 3 / (1 + 0.5 * slope);
    };
    whole_frame("depth", z);
    for (size_t c = 0; c < 3; ++c)
        channels_[1 + c].second = [=](size_t i) { return i == 10 ? 0 : (i == 20 ? 0.95 : 1) * wall[int(c)]; };
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'distance'\n");
    for (const size_t i : {size_t(9), size_t(10), size_t(20)})
        EXPECT_LT(glm::length(glm::dvec3(frame.gbuffer.normal_vs[i]) - wall), 1e-4) << i;
    EXPECT_THAT(frame.warnings, testing::Contains(HasSubstr("channel 'normal_vs.x': 1 pixels have a normal of zero")));
}

TEST_F(LoadFrame, UnsignedNormalsOfZeroWereNeverWrittenAndLongOnesAreNamed)
{
    whole_frame("depth", [](size_t) { return 0.5; });
    for (size_t c = 0; c < 3; ++c) // (0.5, 0.5, 1) stands for +z
        channels_[1 + c].second = [=](size_t i) { return i == 10 ? 0 : c < 2 ? 0.5 : i == 20 ? 2 : 1; };
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'reversed'\n[normals]\nunsigned = true\nspace = "
                                                   "'view'\n");
    EXPECT_LT(glm::length(frame.gbuffer.normal_vs[10] - glm::vec3(0, 0, 1)), 1e-4) << "the depth is that of a wall";
    EXPECT_LT(glm::length(frame.gbuffer.normal_vs[20] - glm::vec3(0, 0, 1)), 1e-4);
    EXPECT_THAT(frame.warnings,
                testing::IsSupersetOf({HasSubstr("1 pixels have a normal of zero"),
                                       HasSubstr("1 pixels have normals longer than 1.1: scaled to 1")}));
}

/// What frame_image() needs, of one value everywhere.
GBufferImage whole_gbuffer()
{
    GBufferImage gbuffer;
    gbuffer.view       = camera_to_view(Camera{}, size_px);
    const size_t count = pixel_count(size_px);
    gbuffer.depth      = std::vector<float>(count, 0.5F);
    gbuffer.normal_vs  = std::vector<glm::vec3>(count, {0, 0, 1});
    gbuffer.roughness = gbuffer.metallic = gbuffer.solid_back = std::vector<float>(count, 0.5F);
    gbuffer.base_colour = gbuffer.radiance = gbuffer.highlight = std::vector<glm::vec3>(count, glm::vec3(0.5F));
    gbuffer.object_id                                          = std::vector<uint32_t>(count, 1);
    gbuffer.gradient                                           = std::vector<glm::vec2>(count, glm::vec2(0));
    return gbuffer;
}

// Of frames from before the channel was written, all of the light is diffuse.
TEST_F(LoadFrame, BakedLightThatIsNotDiffuseComesBack)
{
    GBufferImage gbuffer = whole_gbuffer();
    for (size_t i = 0; i < pixel_count(size_px); ++i) gbuffer.diffuse_share.push_back(static_cast<float>(i) / 64);
    Image image = frame_image(gbuffer);
    write_image(folder_ / "f.exr", image);
    EXPECT_EQ(load_frame(folder_ / "f.exr").gbuffer.diffuse_share, gbuffer.diffuse_share);
    std::ranges::replace(image.channels, std::string("diffuse_share"), std::string("other"));
    write_image(folder_ / "f.exr", image);
    EXPECT_EQ(diffuse_share_at(load_frame(folder_ / "f.exr").gbuffer, 7), 1);
}

TEST_F(LoadFrame, OwnFramesThatWereResizedAreRefused)
{
    const GBufferImage gbuffer = whole_gbuffer();
    Image              image   = frame_image(gbuffer);
    write_image(folder_ / "f.exr", image);
    EXPECT_EQ(load_frame(folder_ / "f.exr").gbuffer.view.focal_px, gbuffer.view.focal_px);
    // As another program does it: every other pixel, and all attributes.
    image.size_px = size_px / 2;
    image.values.resize(image.values.size() / 4);
    write_image(folder_ / "f.exr", image);
    EXPECT_THAT(message_of<SpecError>([&] { load_frame(folder_ / "f.exr"); }),
                AllOf(HasSubstr("4x3 pixels, expected 8x6"), HasSubstr("[camera]")));
    folder_.write("f.exr.toml", camera);
    EXPECT_NEAR(load_frame(folder_ / "f.exr").gbuffer.view.focal_px.y, 1.5, 1e-9) << "half of 3 rows, at 90 degrees";
}

TEST_F(LoadFrame, DepthBesideALayerOfColourIsNoBlue)
{
    whole_frame("Z", [](size_t) { return 0.5; });
    for (const char* name : {"Combined.R", "Combined.G", "Combined.B"}) channel(name, [](size_t) { return 0.25; });
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'reversed'\n");
    EXPECT_EQ(frame.gbuffer.radiance[0], glm::vec3(0.25F));
    EXPECT_EQ(frame.gbuffer.depth[0], 0.5F);
}

TEST_F(LoadFrame, OtherPrimariesAreNamed)
{
    constexpr float rec709[8] = {0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F};
    constexpr float acescg[8] = {0.713F, 0.293F, 0.165F, 0.83F, 0.128F, 0.044F, 0.32168F, 0.33767F};
    for (const auto& [primaries, other] : {std::pair(rec709, false), std::pair(acescg, true)}) {
        OIIO::ImageSpec spec(2, 1, 3, OIIO::TypeDesc::FLOAT);
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), primaries);
        const std::string        file   = (folder_ / "sky.exr").string();
        const auto               output = OIIO::ImageOutput::create(file);
        const std::vector<float> values(6, 0.5F);
        ASSERT_TRUE(output && output->open(file, spec));
        ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()) && output->close());
        EXPECT_EQ(open_exr(file).other_primaries, other);
        std::vector<std::string> warnings;
        load_environment(file, 1, warnings);
        const bool said = std::ranges::any_of(warnings, [](const std::string& text) {
            return text.find("sky.exr: its chromaticities are not those of Rec. 709") != std::string::npos;
        });
        EXPECT_EQ(said, other);
    }
}

TEST_F(LoadFrame, DenoisersHelpersAreNoDepth)
{
    whole_frame("ViewLayer.Depth.Z", distance_m);
    channel("ViewLayer.Denoising Depth.Z", [](size_t) { return 7; });
    channel("ViewLayer.Denoising Albedo.R", [](size_t) { return 7; });
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'distance'\n");
    EXPECT_NEAR(frame.gbuffer.depth[0], near_m / distance_m(0), 1e-6);
    EXPECT_EQ(frame.gbuffer.base_colour[0], glm::vec3(1));
}

TEST_F(LoadFrame, LightBeyondWhatPicturesHoldIsClamped)
{
    whole_frame("depth", [](size_t) { return 0.5; });
    channel("R", [](size_t i) { return i == 3 ? 1e30 : i == 4 ? -2 : 0.25; });
    channel("G", [](size_t) { return 65504; });
    channel("B", [](size_t i) { return i == 5 ? std::numeric_limits<double>::infinity() : 0; });
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'reversed'\n");
    EXPECT_EQ(frame.gbuffer.radiance[2], glm::vec3(0.25F, 65504, 0));
    EXPECT_EQ(frame.gbuffer.radiance[3], glm::vec3(65504, 65504, 0));
    EXPECT_EQ(frame.gbuffer.radiance[4], glm::vec3(0, 65504, 0));
    EXPECT_EQ(frame.gbuffer.radiance[5], glm::vec3(0));
    EXPECT_THAT(frame.warnings, testing::IsSupersetOf({HasSubstr("channel 'R': 1 pixels are above 65504: clamped"),
                                                       HasSubstr("channel 'R': 1 pixels are negative: clamped to 0"),
                                                       HasSubstr("channel 'R': 1 pixels are not finite")}));
}

TEST_F(LoadFrame, EmissionIsPartOfTheLight)
{
    whole_frame("depth", [](size_t) { return 0.5; });
    for (const char* c : {"R", "G", "B"}) channel(c, [](size_t) { return 3; });
    for (const char* c : {"R", "G", "B"}) channel(std::string("ViewLayer.Emit.") + c, [](size_t) { return 2; });
    const Frame frame = load(std::string(camera) + "[depth]\nkind = 'reversed'\n");
    EXPECT_EQ(frame.gbuffer.radiance[7], glm::vec3(3));
    EXPECT_EQ(emission_at(frame.gbuffer, 7), glm::vec3(2));
}

// The data window leaves two columns on the left empty and reaches a row above the picture: the wall's pixels keep their places.
TEST_F(LoadFrame, WindowsAreCutAndPlaced)
{
    whole_frame("depth", [](size_t i) { return near_m / distance_m(i); });
    const std::string  path  = write(std::string(camera) + "[depth]\nkind = 'reversed'\n");
    const Frame        all   = load_frame(path);
    const auto         input = OIIO::ImageInput::open(path);
    OIIO::ImageSpec    spec  = input->spec();
    const size_t       count = static_cast<size_t>(spec.nchannels);
    std::vector<float> whole(pixel_count(size_px) * count), stored;
    ASSERT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, whole.data()));
    spec.x = 2, spec.y = -1, spec.width = size_px.x - 2, spec.height = size_px.y + 1;
    spec.full_x = spec.full_y = 0, spec.full_width = size_px.x, spec.full_height = size_px.y;
    for (int y = -1; y < size_px.y; ++y)
        for (int x = 2; x < size_px.x; ++x)
            for (size_t c = 0; c < count; ++c)
                stored.push_back(y < 0 ? 77 : whole[pixel_index({x, y}, size_px) * count + c]);
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output->open(path, spec) && output->write_image(OIIO::TypeDesc::FLOAT, stored.data()) &&
                output->close());
    const Frame cut = load_frame(path);
    EXPECT_EQ(frame_size_px(path), size_px);
    EXPECT_EQ(cut.gbuffer.view.centre_px, all.gbuffer.view.centre_px);
    for (size_t i = 0; i < pixel_count(size_px); ++i)
        EXPECT_EQ(cut.gbuffer.depth[i], pixel_at(i, size_px).x < 2 ? 0 : all.gbuffer.depth[i]) << i;
    EXPECT_THAT(cut.warnings, testing::IsSupersetOf(
                                  {HasSubstr("holds 6x7 pixels at (2, -1) of a picture of 8x6: 6 of them are overscan"),
                                   HasSubstr("12 of the picture are not there and count as background")}));
}

TEST_F(LoadFrame, AFrameHasOneViewAtOneSize)
{
    whole_frame("depth", [](size_t) { return 0.5; });
    const Scene scene = load_scene(write(std::string(camera) + "[depth]\nkind = 'reversed'\n"));
    EXPECT_EQ(view_at(scene, "default", {0, 0}, {}).size_px, size_px);
    EXPECT_EQ(view_at(scene, "default", size_px, {}).near_m, near_m);
    EXPECT_THAT(message_of<SpecError>([&] {
                    view_at(scene, "default", {16, 9}, {});
                }),
                HasSubstr("8x6 pixels: it cannot be drawn at 16x9"));
    EXPECT_THROW(view_at(scene, "side", size_px, {}), SpecError);
    EXPECT_THROW(view_at(scene, "default", size_px, {1, 0}), SpecError) << "no sequence";
}

} // namespace
} // namespace ssrlab
