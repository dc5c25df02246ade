// Value noise on a lattice that repeats, summed over octaves (K. Perlin 1985, An Image Synthesizer: turbulence for the marble).
#include "scene/patterns.h"

#include "core/parallel_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

constexpr int side_px = 1024;

double random_of(uint32_t x, uint32_t y, uint32_t seed)
{
    uint32_t hash = x * 0x9E3779B1U ^ y * 0x85EBCA77U ^ seed * 0xC2B2AE3DU;
    hash          = (hash ^ (hash >> 15U)) * 0x2C1B3C6DU;
    hash          = (hash ^ (hash >> 12U)) * 0x297A2D39U;
    return (hash ^ (hash >> 15U)) / 4294967296.0;
}

/// 0 to 1; `cells` lattice cells to a repeat, u and v from 0 to 1.
double noise(glm::dvec2 uv, int cells, uint32_t seed)
{
    const glm::dvec2 at = uv * double(cells), low = glm::floor(at), part = at - low;
    const glm::dvec2 share = part * part * (3.0 - 2.0 * part);
    const auto       value = [&](int dx, int dy) {
        const auto wrapped = [&](double cell) { return static_cast<uint32_t>(((int(cell) % cells) + cells) % cells); };
        return random_of(wrapped(low.x + dx), wrapped(low.y + dy), seed);
    };
    return glm::mix(glm::mix(value(0, 0), value(1, 0), share.x), glm::mix(value(0, 1), value(1, 1), share.x), share.y);
}

/// Octaves of noise, each twice as fine and half as strong; 0 to 1.
double octaves(glm::dvec2 uv, int cells, int count, uint32_t seed)
{
    double sum = 0, strength = 0.5, whole = 0;
    for (int k = 0; k < count; ++k, strength /= 2, cells *= 2) {
        sum += strength * noise(uv, cells, seed + static_cast<uint32_t>(k));
        whole += strength;
    }
    return sum / whole;
}

struct Texel {
    glm::dvec3 base_colour; // linear
    double     roughness;
};

Texel wet_asphalt(glm::dvec2 uv)
{
    const double height = octaves(uv, 5, 5, 11), grain = octaves(uv, 160, 3, 23);
    // Dry above, damp at the shore, water below.
    const double water = glm::smoothstep(0.487, 0.477, height), damp = glm::smoothstep(0.56, 0.46, height);
    const double albedo = glm::mix(0.05 + 0.11 * grain, 0.022 + 0.03 * grain, damp);
    return {glm::dvec3(1, 0.98, 0.95) * glm::mix(albedo, 0.015, water), glm::mix(0.85 - 0.35 * damp, 0.02, water)};
}

Texel marble(glm::dvec2 uv)
{
    constexpr double joint = 0.003;
    const glm::dvec2 slab = glm::floor(uv * 2.0), within = uv * 2.0 - slab;
    const auto       seed       = static_cast<uint32_t>(31 + 7 * slab.x + 13 * slab.y);
    const glm::dvec2 bent       = uv + 0.10 * (glm::dvec2(octaves(uv, 4, 4, seed), octaves(uv, 4, 4, seed + 3)) - 0.5);
    const double     turbulence = std::abs(2 * octaves(glm::fract(bent), 3, 6, seed + 5) - 1);
    const double     vein = std::pow(1 - turbulence, 14), cloud = octaves(uv, 6, 4, seed + 9);
    const double     border = std::min({within.x, within.y, 1 - within.x, 1 - within.y});
    if (border < joint) return {glm::dvec3(0.25, 0.24, 0.22), 0.6};
    // Light and dark slabs by turns, as on a chessboard.
    const bool       light = int(slab.x + slab.y) % 2 == 0;
    const glm::dvec3 stone = light ? glm::mix(glm::dvec3(0.78, 0.76, 0.72), glm::dvec3(0.62, 0.61, 0.6), cloud)
                                   : glm::mix(glm::dvec3(0.022, 0.024, 0.026), glm::dvec3(0.05, 0.05, 0.048), cloud);
    const glm::dvec3 veins = light ? glm::dvec3(0.16, 0.17, 0.19) : glm::dvec3(0.55, 0.53, 0.48);
    return {glm::mix(stone, veins, (light ? 0.85 : 0.6) * vein), 0.05};
}

Texel oak(glm::dvec2 uv)
{
    constexpr int    rows = 12, lengths = 2;
    const double     row = std::floor(uv.y * rows), along = uv.x * lengths + random_of(uint32_t(row), 1, 41);
    const glm::dvec2 within(glm::fract(along), glm::fract(uv.y * rows));
    const auto       seed  = static_cast<uint32_t>(53 + 17 * row + 5 * (int(along) % lengths));
    const double     tone  = random_of(seed, 2, 43);
    const double     rings = octaves({uv.x, uv.y * 8}, 6, 4, seed), pores = octaves({uv.x, uv.y * 16}, 32, 2, seed + 9);
    const double     grain = 0.5 + 0.5 * std::sin(40 * rings + 6 * within.y);
    const double     edge  = std::min({within.y, 1 - within.y, 6 * within.x, 6 * (1 - within.x)});
    const glm::dvec3 wood  = glm::mix(glm::dvec3(0.2, 0.095, 0.038), glm::dvec3(0.42, 0.235, 0.105),
                                      0.2 + 0.45 * tone + 0.22 * grain + 0.5 * (rings - 0.5));
    if (edge < 0.012) return {0.35 * wood, 0.5};
    return {wood * (0.72 + 0.5 * pores), 0.12 + 0.12 * pores};
}

Texel brick(glm::dvec2 uv)
{
    constexpr int    rows = 12, columns = 4;
    const double     row = std::floor(uv.y * rows), along = uv.x * columns + 0.5 * (int(row) % 2);
    const glm::dvec2 within(glm::fract(along), glm::fract(uv.y * rows));
    const auto       column = static_cast<uint32_t>(int(along) % columns);
    const double     tone = random_of(column, uint32_t(row), 61), burnt = random_of(column, uint32_t(row), 67);
    const double     grain = octaves(uv, 48, 4, 71), worn = octaves(uv, 24, 3, 73);
    const double     edge = std::min({within.y, 1 - within.y, 3 * within.x, 3 * (1 - within.x)}) + 0.1 * (worn - 0.5);
    if (edge < 0.075) return {glm::dvec3(0.42, 0.4, 0.37) * (0.6 + 0.6 * grain), 0.95};
    const glm::dvec3 clay = glm::mix(glm::dvec3(0.24, 0.072, 0.042), glm::dvec3(0.4, 0.16, 0.095), tone);
    return {clay * (burnt < 0.15 ? 0.45 : 1.0) * (0.55 + 0.9 * grain), 0.9};
}

Texel concrete(glm::dvec2 uv)
{
    const double cloud = octaves(uv, 3, 6, 83), fleck = octaves(uv, 128, 2, 89), scuff = octaves(uv, 8, 5, 97);
    const double tone = 0.16 + 0.22 * cloud + 0.05 * (fleck - 0.5);
    return {tone * glm::dvec3(1, 0.985, 0.95), 0.08 + 0.22 * glm::smoothstep(0.42, 0.7, scuff)};
}

double to_srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
uint8_t to_byte(double value) { return static_cast<uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

} // namespace

PatternTextures make_pattern(Pattern pattern)
{
    const std::array texels{wet_asphalt, marble, oak, brick, concrete};
    const auto       texel = texels.at(static_cast<size_t>(pattern));
    PatternTextures  made;
    for (Texture* texture : {&made.base_colour, &made.gloss}) {
        texture->size_px = {side_px, side_px};
        texture->rgba.resize(size_t(4) * side_px * side_px, 255);
    }
    made.base_colour.srgb = true;
    parallel_pixels(side_px, side_px, [&](size_t i) {
        const Texel one = texel((glm::dvec2(i % side_px, i / side_px) + 0.5) / double(side_px));
        for (int c : {0, 1, 2}) made.base_colour.rgba[4 * i + size_t(c)] = to_byte(to_srgb(one.base_colour[c]));
        made.gloss.rgba[4 * i]     = 0;
        made.gloss.rgba[4 * i + 1] = to_byte(one.roughness);
        made.gloss.rgba[4 * i + 2] = 0;
    });
    return made;
}

} // namespace ssrlab
