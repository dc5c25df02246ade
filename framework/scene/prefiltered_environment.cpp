#include "scene/prefiltered_environment.h"

#include "core/parallel_rows.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

constexpr double pi = std::numbers::pi;

/// Means over areas of texels, by the solid angle that they cover.
EnvironmentMap shrunk(const EnvironmentMap& map, glm::ivec2 size_px)
{
    EnvironmentMap small;
    small.size_px = size_px;
    small.radiance.resize(pixel_count(size_px));
    const glm::dvec2 scale = glm::dvec2(map.size_px) / glm::dvec2(size_px);
    parallel_rows(size_px.y, 0, [&](int y) {
        const int top    = std::min(int(y * scale.y), map.size_px.y - 1),
                  bottom = std::max(top + 1, int((y + 1) * scale.y));
        for (int x = 0; x < size_px.x; ++x) {
            const int left  = std::min(int(x * scale.x), map.size_px.x - 1),
                      right = std::max(left + 1, int((x + 1) * scale.x));
            glm::dvec3 sum(0);
            double     weight = 0;
            for (int row = top; row < bottom; ++row) {
                const double solid_angle = std::sin(pi * (row + 0.5) / map.size_px.y);
                for (int column = left; column < right; ++column)
                    sum += solid_angle * glm::dvec3(map.radiance[pixel_index({column, row}, map.size_px)]);
                weight += solid_angle * (right - left);
            }
            small.radiance[pixel_index({x, y}, size_px)] = glm::vec3(sum / weight);
        }
    });
    return small;
}

/// D G2 / (4 n.v) for n = v, by the cosine between normal and light: the half vector's cosine is that of half the angle.
double lobe_weight(double alpha2, double cos_light)
{
    const double cos_half2 = 0.5 * (1 + cos_light), spread = cos_half2 * (alpha2 - 1) + 1;
    const double to_light = std::sqrt(alpha2 + (1 - alpha2) * cos_light * cos_light);
    return alpha2 / (spread * spread) * cos_light / (cos_light + to_light);
}

struct Direction {
    glm::vec3 direction;
    float     solid_angle;
};

std::vector<Direction> texel_directions(glm::ivec2 size_px)
{
    std::vector<Direction> directions;
    for (int y = 0; y < size_px.y; ++y)
        for (int x = 0; x < size_px.x; ++x)
            directions.push_back({glm::vec3(uv_to_direction((glm::dvec2(x, y) + 0.5) / glm::dvec2(size_px))),
                                  float(std::sin(pi * (y + 0.5) / size_px.y))});
    return directions;
}

/// A level at the size of its source.
EnvironmentMap blurred(const EnvironmentMap& source, double roughness)
{
    constexpr double negligible = 1e-3; // of the lobe's peak
    const glm::ivec2 size       = source.size_px;
    const double     alpha2     = std::pow(roughness, 4);
    double           angle      = 0; // beyond it the lobe is negligible
    while (angle < 0.5 * pi && lobe_weight(alpha2, std::cos(angle)) > negligible * lobe_weight(alpha2, 1))
        angle += 0.01;
    const int                    rows   = int(std::ceil(angle / pi * size.y)) + 1;
    const std::vector<Direction> texels = texel_directions(size);
    EnvironmentMap               result = source;
    parallel_rows(size.y, 0, [&](int y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::vec3 normal = texels[pixel_index({x, y}, size)].direction;
            glm::dvec3      sum(0);
            double          weight = 0;
            for (int row = std::max(0, y - rows); row <= std::min(size.y - 1, y + rows); ++row) {
                const double level = double(texels[pixel_index({0, row}, size)].solid_angle);
                const double share = std::sin(angle) / std::max(level, 1e-6);
                const int    columns =
                    share >= 0.5 || angle > 1
                           ? size.x / 2
                           : std::min(size.x / 2, int(std::ceil(std::asin(share) / (2 * pi) * size.x)) + 1);
                for (int i = x - columns; i < x + columns + (2 * columns < size.x ? 1 : 0); ++i) {
                    const size_t texel  = pixel_index({(i + size.x) % size.x, row}, size);
                    const double cosine = double(glm::dot(normal, texels[texel].direction));
                    if (cosine <= 0) continue;
                    const double part = lobe_weight(alpha2, std::min(cosine, 1.0)) * double(texels[texel].solid_angle);
                    sum += part * glm::dvec3(source.radiance[texel]);
                    weight += part;
                }
            }
            result.radiance[pixel_index({x, y}, size)] = glm::vec3(sum / weight);
        }
    });
    return result;
}

} // namespace

double environment_level_roughness(int level) { return std::pow((level + 1.0) / environment_levels, 1.5); }

EnvironmentMap prefilter_environment(const EnvironmentMap& map)
{
    const EnvironmentMap fine = shrunk(map, environment_level_px), middle = shrunk(fine, environment_level_px / 2),
                         coarse = shrunk(fine, environment_level_px / 4);
    EnvironmentMap levels;
    levels.size_px = environment_level_px * glm::ivec2(1, environment_levels);
    for (int k = 0; k < environment_levels; ++k) {
        const double          roughness = environment_level_roughness(k);
        const EnvironmentMap& source    = roughness < 0.15 ? fine : roughness < 0.3 ? middle : coarse;
        const EnvironmentMap  level     = blurred(source, roughness);
        for (int y = 0; y < environment_level_px.y; ++y)
            for (int x = 0; x < environment_level_px.x; ++x)
                levels.radiance.push_back(environment_radiance(
                    level, uv_to_direction((glm::dvec2(x, y) + 0.5) / glm::dvec2(environment_level_px))));
    }
    return levels;
}

} // namespace ssrlab
