#include "scene/environment.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "scene/exr_file.h"
#include "scene/load_scene.h"
#include "scene/scene.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <numbers>

namespace ssrlab {
namespace {

constexpr double pi             = std::numbers::pi;
constexpr int    max_width_px   = 16384;
constexpr double sun_radius_deg = 4;
constexpr double sun_edge_deg   = 1; // so that bilinear lookups see no hard border
constexpr int    sky_height_px  = 256;

glm::vec3 texel(const EnvironmentMap& map, int column, int row)
{
    const int x = (column % map.size_px.x + map.size_px.x) % map.size_px.x;
    const int y = std::clamp(row, 0, map.size_px.y - 1);
    return map.radiance[pixel_index({x, y}, map.size_px)];
}

/// Not glm::mix: between equal values the result is that value, to the last bit.
glm::vec3 blend(glm::vec3 a, glm::vec3 b, float share_of_b) { return a + (b - a) * share_of_b; }

double smooth_step(double from, double to, double value)
{
    const double x = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

glm::dvec3 sky_colour(const SkyColours& colours, double height)
{
    const glm::dvec3 above = glm::mix(colours.horizon, colours.zenith, std::sqrt(std::max(height, 0.0)));
    return glm::mix(colours.ground, above, smooth_step(-0.06, 0.02, height));
}

glm::dvec3 sun_colour(glm::dvec3 direction_ws, glm::dvec3 to_sun_ws)
{
    const double cosine = std::clamp(glm::dot(direction_ws, to_sun_ws), -1.0, 1.0);
    const double off    = std::acos(cosine) * 180 / pi;
    return glm::dvec3(7, 6, 4.6) * (1 - smooth_step(sun_radius_deg - sun_edge_deg, sun_radius_deg, off));
}

/// As a file has it, linear.
struct Picture {
    glm::ivec2             size_px{0, 0};
    std::vector<glm::vec3> rgb;
    double                 scale = 1; // to radiance
};

void check_shape(const std::string& name, glm::ivec2 size_px)
{
    if (size_px.x > max_width_px)
        throw_spec_error("{}: {}x{} pixels, at most {} a side can be used", name, size_px.x, size_px.y, max_width_px);
    if (size_px.x < 2 || size_px.x != 2 * size_px.y)
        throw_failure("{}: expected an equirectangular picture, twice as wide as high, got {}x{}", name, size_px.x,
                      size_px.y);
}

/// Channels named R, G and B, of a layer if only one has them; or Y alone.
std::vector<ExrChannel> colour_channels(const ExrFile& file)
{
    std::vector<std::vector<ExrChannel>> layers;
    std::string                          names;
    for (const ExrChannel& channel : file.channels) {
        names += (names.empty() ? "" : ", ") + channel.name;
        if (channel.name != "R" && !channel.name.ends_with(".R")) continue;
        std::vector<ExrChannel> layer;
        for (const char letter : {'R', 'G', 'B'}) {
            const std::string wanted = channel.name.substr(0, channel.name.size() - 1) + letter;
            const auto        found  = std::ranges::find(file.channels, wanted, &ExrChannel::name);
            if (found != file.channels.end()) layer.push_back(*found);
        }
        if (layer.size() == 3 && channel.name == "R") return layer;
        if (layer.size() == 3) layers.push_back(layer);
    }
    if (layers.size() == 1) return layers[0];
    const auto grey = std::ranges::find(file.channels, "Y", &ExrChannel::name);
    if (layers.empty() && grey != file.channels.end()) return {*grey, *grey, *grey};
    throw_spec_error("{}: expected channels R, G and B, or Y, of one layer, got {}", file.shown, names);
}

Picture read_exr_picture(const std::filesystem::path& path, std::vector<std::string>& warnings)
{
    const ExrFile                 file     = open_exr(path);
    const std::vector<ExrChannel> channels = colour_channels(file);
    for (const ExrChannel& channel : channels) {
        const ExrWindow window = file.windows[size_t(channel.part)];
        if (!window.is_whole(file.size_px))
            throw_failure("{}: holds {}x{} pixels at ({}, {}) of a picture of {}x{}, expected all of them and no more",
                          file.shown, window.size_px.x, window.size_px.y, window.from_px.x, window.from_px.y,
                          file.size_px.x, file.size_px.y);
    }
    check_shape(file.shown, file.size_px);
    if (file.other_primaries) warnings.push_back(other_primaries_text(file));
    Picture picture{file.size_px, std::vector<glm::vec3>(pixel_count(file.size_px)), 1};
    for (int c = 0; c < 3; ++c) {
        const std::vector<float> values = read_channel(file, channels[size_t(c)]);
        for (size_t i = 0; i < values.size(); ++i) picture.rgb[i][c] = values[i];
    }
    return picture;
}

/// What OpenImageIO does not hand on: all EXPOSURE lines together, by which stored values are to be divided
/// (G. Ward, Radiance's file formats), and the way that the rows run.
struct HdrHeader {
    double      exposure = 1;
    bool        gamma    = false;
    std::string resolution;
};

HdrHeader read_hdr_header(const std::filesystem::path& file)
{
    constexpr int most_lines = 1000;
    HdrHeader     header;
    std::ifstream stream(file, std::ios::binary);
    std::string   line;
    for (int i = 0; i < most_lines && std::getline(stream, line) && !line.empty(); ++i) {
        if (line.starts_with("EXPOSURE=")) header.exposure *= std::strtod(line.c_str() + 9, nullptr);
        if (line.starts_with("GAMMA=")) header.gamma = std::strtod(line.c_str() + 6, nullptr) != 1;
    }
    std::getline(stream, header.resolution);
    return header;
}

Picture read_hdr_picture(const std::filesystem::path& file)
{
    const std::string name = file.string();
    // By that reader alone: ImageInput::open(name) hands what its own reader refuses to those of all other formats.
    const auto      input = OIIO::ImageInput::create("hdr");
    OIIO::ImageSpec spec;
    if (!input || !input->open(name, spec))
        throw_failure("{}: expected an .hdr or .exr picture: {}", name, input ? input->geterror() : OIIO::geterror());
    check_shape(name, {spec.width, spec.height});
    const HdrHeader header = read_hdr_header(file);
    if (!header.resolution.starts_with("-Y") || header.resolution.find("+X") == std::string::npos)
        throw_spec_error("{}: expected rows from the top and from the left, '-Y … +X …', got '{}'", name,
                         header.resolution);
    if (header.gamma || !(header.exposure > 0 && std::isfinite(header.exposure)))
        throw_spec_error("{}: expected linear radiance, got a GAMMA, or an EXPOSURE that is no number above 0", name);
    std::vector<float> values(pixel_count({spec.width, spec.height}) * 3);
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::FLOAT, values.data()))
        throw_failure("{}: cannot be decoded: {}", name, input->geterror());
    Picture picture{{spec.width, spec.height}, {}, 1 / header.exposure};
    for (size_t i = 0; i < values.size(); i += 3) picture.rgb.emplace_back(values[i], values[i + 1], values[i + 2]);
    return picture;
}

} // namespace

glm::dvec2 direction_to_uv(glm::dvec3 direction_ws)
{
    const double level   = std::sqrt(direction_ws.x * direction_ws.x + direction_ws.z * direction_ws.z);
    const double azimuth = level > 0 ? std::atan2(direction_ws.x, -direction_ws.z) : 0;
    return {0.5 + azimuth / (2 * pi), 0.5 - std::atan2(direction_ws.y, level) / pi};
}

glm::dvec3 uv_to_direction(glm::dvec2 uv)
{
    const double azimuth = (uv.x - 0.5) * 2 * pi, elevation = (0.5 - uv.y) * pi;
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)};
}

glm::vec3 environment_radiance(const EnvironmentMap& map, glm::dvec3 direction_ws)
{
    const glm::dvec2 at_px = direction_to_uv(direction_ws) * glm::dvec2(map.size_px) - 0.5;
    const glm::dvec2 low   = glm::floor(at_px);
    const glm::vec2  part(at_px - low);
    const int        x = int(low.x), y = int(low.y);
    return blend(blend(texel(map, x, y), texel(map, x + 1, y), part.x),
                 blend(texel(map, x, y + 1), texel(map, x + 1, y + 1), part.x), part.y);
}

glm::vec3 sky_radiance(const Scene& scene, glm::dvec3 direction_ws)
{
    return scene.environment.radiance.empty() ? scene.background
                                              : environment_radiance(scene.environment, direction_ws);
}

EnvironmentMap load_environment(const std::filesystem::path& file, double scale, std::vector<std::string>& warnings)
{
    const std::string name = file.string();
    if (!std::filesystem::is_regular_file(file)) throw_failure("{}: not a regular file", name);
    const Picture picture = lower_extension(file) == ".exr" ? read_exr_picture(file, warnings) : read_hdr_picture(file);
    EnvironmentMap map;
    map.size_px    = picture.size_px;
    size_t clamped = 0;
    map.radiance.reserve(picture.rgb.size());
    for (const glm::vec3& stored : picture.rgb) {
        glm::vec3 radiance(0);
        for (int c = 0; c < 3; ++c) {
            const float value = stored[c] * float(scale * picture.scale);
            // In this order NaN becomes 0.
            radiance[c] = std::min(std::max(0.0F, value), largest_radiance);
            clamped += !(value <= largest_radiance); // negative values are a camera's noise around black
        }
        map.radiance.push_back(radiance);
    }
    if (clamped > 0)
        warnings.push_back(
            fmt::format("{}: {} values are not finite or above {}: clamped", name, clamped, largest_radiance));
    return map;
}

EnvironmentMap make_sky(const SkyColours& colours, std::optional<glm::dvec3> to_sun_ws)
{
    EnvironmentMap map;
    map.size_px = {2 * sky_height_px, sky_height_px};
    for (int y = 0; y < map.size_px.y; ++y)
        for (int x = 0; x < map.size_px.x; ++x) {
            const glm::dvec3 direction_ws = uv_to_direction((glm::dvec2(x, y) + 0.5) / glm::dvec2(map.size_px));
            const glm::dvec3 sun = to_sun_ws ? sun_colour(direction_ws, glm::normalize(*to_sun_ws)) : glm::dvec3(0);
            map.radiance.emplace_back(sky_colour(colours, direction_ws.y) + sun);
        }
    return map;
}

} // namespace ssrlab
