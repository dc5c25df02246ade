#include "hard_cases/random_rays.h"

#include <algorithm>
#include <random>

namespace ssrlab::test {
namespace {

uint32_t mix_bits(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/// Depth in steps, 0 = background.
int depth_of(Field field, glm::ivec2 p, uint32_t seed)
{
    const uint32_t hash =
        mix_bits(static_cast<uint32_t>(p.x) * 0x9E3779B1u + mix_bits(static_cast<uint32_t>(p.y) + seed));
    const int any = 1 + static_cast<int>(hash >> 13) % (depth_steps - 1);
    switch (field) {
    case Field::poles: return hash % 64 == 0 ? any : 0;
    case Field::sparse_poles: return hash % 2048 == 0 ? any : 0;
    case Field::walls:
        return p.x % 61 == 30 || p.y % 53 == 20
                   ? 1 + static_cast<int>(mix_bits(static_cast<uint32_t>(p.x / 61 * 97 + p.y / 53)) >> 13) %
                             (depth_steps - 1)
                   : 0;
    case Field::terrain: return depth_steps / 64 + (p.y * 173) % (depth_steps / 32) + static_cast<int>(hash % 64);
    }
    return 0;
}

class Random {
public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    int between(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

private:
    std::mt19937 engine_;
};

struct Span {
    glm::ivec2 from, to; // in 1/256 px
};

/// The largest k <= limit for which from + k * way lies in [0, extent] on both axes.
int longest(glm::ivec2 from, glm::ivec2 way, glm::ivec2 extent, int limit)
{
    for (int axis : {0, 1}) {
        if (way[axis] > 0) limit = std::min(limit, (extent[axis] - from[axis]) / way[axis]);
        if (way[axis] < 0) limit = std::min(limit, from[axis] / -way[axis]);
    }
    return limit;
}

Span make_span(int kind, glm::ivec2 size_px, Random& random)
{
    const glm::ivec2 extent = size_px * px_steps;
    const auto       point  = [&] { return glm::ivec2(random.between(0, extent.x), random.between(0, extent.y)); };
    const auto       centre = [&] {
        return glm::ivec2(random.between(0, size_px.x - 1), random.between(0, size_px.y - 1)) * px_steps + px_steps / 2;
    };
    const auto corner = [&] {
        return glm::ivec2(random.between(0, size_px.x), random.between(0, size_px.y)) * px_steps;
    };
    const auto along = [&](glm::ivec2 from, glm::ivec2 way) {
        return Span{from, from + longest(from, way, extent, extent.x + extent.y) * way};
    };
    const int sign = random.between(0, 1) * 2 - 1;
    switch (kind) {
    case 0: return {point(), point()};
    case 1: return {centre(), centre()};
    case 2:
        return along(random.between(0, 1) != 0 ? centre() : point(),
                     random.between(0, 1) != 0 ? glm::ivec2(sign, 0) : glm::ivec2(0, sign));
    case 3: return along(random.between(0, 1) != 0 ? centre() : point(), {sign, random.between(0, 1) * 2 - 1});
    case 4: return along(centre(), {random.between(-4, 4), random.between(-4, 4)});
    case 5:
        return along(point(), random.between(0, 1) != 0 ? glm::ivec2(px_steps * sign, random.between(-2, 2))
                                                        : glm::ivec2(random.between(-2, 2), px_steps * sign));
    case 6: return {corner(), corner()};
    default: {
        const glm::ivec2 from = point();
        return {from, glm::clamp(from + glm::ivec2(random.between(-2 * px_steps, 2 * px_steps),
                                                   random.between(-2 * px_steps, 2 * px_steps)),
                                 glm::ivec2(0), extent)};
    }
    }
}

} // namespace

Setup make_field(Field field, glm::ivec2 size_px, uint32_t seed)
{
    Setup setup;
    setup.gbuffer.view = bench_view(size_px);
    setup.settings     = campaign_settings;
    setup.gbuffer.depth.reserve(static_cast<size_t>(size_px.x) * static_cast<size_t>(size_px.y));
    for (int y = 0; y < size_px.y; ++y)
        for (int x = 0; x < size_px.x; ++x)
            setup.gbuffer.depth.push_back(static_cast<float>(depth_of(field, {x, y}, seed)) / depth_steps);
    return setup;
}

std::vector<RayInput> random_rays(glm::ivec2 size_px, size_t count, uint32_t seed)
{
    constexpr int         kinds = 8;
    Random                random(seed);
    std::vector<RayInput> rays;
    rays.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        Span span = make_span(static_cast<int>(i % kinds), size_px, random);
        // Along the image's own far border: a case of its own (along_the_image_border).
        for (int axis : {0, 1})
            if (span.from[axis] == span.to[axis])
                span.from[axis] = span.to[axis] = std::min(span.from[axis], size_px[axis] * px_steps - 1);
        // Any two depths, level, or a drift of a few steps.
        const int from_z = random.between(1, depth_steps - 1);
        const int kind_z = random.between(0, 3);
        const int to_z   = kind_z == 0   ? from_z
                           : kind_z == 1 ? std::clamp(from_z + random.between(-40, 40), 0, depth_steps)
                                         : random.between(0, depth_steps);
        RayInput  ray;
        ray.origin_px_depth = glm::dvec3(glm::dvec2(span.from) / double(px_steps), double(from_z) / depth_steps);
        ray.delta_px_depth =
            glm::dvec3(glm::dvec2(span.to - span.from) / double(px_steps), double(to_z - from_z) / depth_steps);
        for (int axis : {0, 1})
            if (ray.delta_px_depth[axis] == 0 && random.between(0, 1) != 0) ray.delta_px_depth[axis] = -0.0;
        ray.pixel = glm::clamp(span.from / px_steps, glm::ivec2(0), size_px - 1);
        rays.push_back(ray);
    }
    return rays;
}

} // namespace ssrlab::test
