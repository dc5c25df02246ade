#include "scene/environment.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "scene/exr_header.h"
#include "scene/load_scene.h"
#include "scene/scene.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
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
    const bool exr = lower_extension(file) == ".exr";
    if (exr) check_exr_header(file, name);
    // By that reader alone: ImageInput::open(name) hands what its own reader refuses to those of all other formats.
    const auto      input = OIIO::ImageInput::create(exr ? "openexr" : "hdr");
    OIIO::ImageSpec spec;
    if (!input || !input->open(name, spec))
        throw_failure("{}: expected an .hdr or .exr picture: {}", name, input ? input->geterror() : OIIO::geterror());
    if (spec.width > max_width_px)
        throw_spec_error("{}: {}x{} pixels, at most {} a side can be used", name, spec.width, spec.height,
                         max_width_px);
    if (spec.width < 2 || spec.width != 2 * spec.height || spec.depth > 1)
        throw_failure("{}: expected an equirectangular picture, twice as wide as high, got {}x{}", name, spec.width,
                      spec.height);
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height)
        throw_failure("{}: holds {}x{} pixels at ({}, {}) of a picture of {}x{}, expected all of them and no more",
                      name, spec.width, spec.height, spec.x - spec.full_x, spec.y - spec.full_y, spec.full_width,
                      spec.full_height);
    const size_t       channels = spec.nchannels >= 3 ? 3 : 1; // a file may have a thousand
    EnvironmentMap     map;
    std::vector<float> values(size_t(spec.width) * size_t(spec.height) * channels);
    map.size_px = {spec.width, spec.height};
    if (!input->read_image(0, 0, 0, int(channels), OIIO::TypeDesc::FLOAT, values.data()))
        throw_failure("{}: cannot be decoded: {}", name, input->geterror());
    size_t clamped = 0;
    map.radiance.reserve(values.size() / channels);
    for (size_t i = 0; i < values.size(); i += channels) {
        glm::vec3 radiance(0);
        for (int c = 0; c < 3; ++c) {
            const float value = values[i + (channels == 3 ? size_t(c) : 0)] * float(scale);
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
