#include "hard_cases/random_rays.h"

#include "core/pixel_index.h"
#include "shared.h"

#include <algorithm>
#include <cstdlib>
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

RayInput make_ray(Span span, int from_z, int to_z, glm::ivec2 size_px, Random& random)
{
    // Along the image's own far border: a case of its own (along_the_image_border).
    for (int axis : {0, 1})
        if (span.from[axis] == span.to[axis])
            span.from[axis] = span.to[axis] = std::min(span.from[axis], size_px[axis] * px_steps - 1);
    RayInput ray;
    ray.origin_px_depth = glm::dvec3(glm::dvec2(span.from) / double(px_steps), double(from_z) / depth_steps);
    ray.delta_px_depth =
        glm::dvec3(glm::dvec2(span.to - span.from) / double(px_steps), double(to_z - from_z) / depth_steps);
    for (int axis : {0, 1})
        if (ray.delta_px_depth[axis] == 0 && random.between(0, 1) != 0) ray.delta_px_depth[axis] = -0.0;
    ray.pixel = glm::clamp(span.from / px_steps, glm::ivec2(0), size_px - 1);
    return ray;
}

} // namespace

size_t planned_rays(size_t short_run)
{
    const char* asked = std::getenv("SSRLAB_LONG");
    if (asked == nullptr) return short_run;
    const size_t rays = std::strtoull(asked, nullptr, 10);
    return rays > 1 ? rays : 100'000'000;
}

Setup make_field(Field field, glm::ivec2 size_px, uint32_t seed)
{
    Setup setup;
    setup.gbuffer.view = bench_view(size_px);
    setup.settings     = campaign_settings;
    setup.gbuffer.depth.reserve(pixel_count(size_px));
    for (int y = 0; y < size_px.y; ++y)
        for (int x = 0; x < size_px.x; ++x)
            setup.gbuffer.depth.push_back(static_cast<float>(depth_of(field, {x, y}, seed)) / depth_steps);
    return setup;
}

std::vector<RayInput> random_rays(glm::ivec2 size_px, size_t count, uint32_t seed)
{
    constexpr size_t      kinds = 8, bundle = RAYS_PER_GROUP;
    Random                random(seed);
    const glm::ivec2      extent = size_px * px_steps;
    std::vector<RayInput> rays;
    rays.reserve(count);
    Span base{};
    int  base_from_z = 0, base_to_z = 0;
    for (size_t i = 0; i < count; ++i) {
        // Every other group keeps together, as the rays of a mirror do: what holds for all of its rays may be asked once.
        const bool bundled = i / bundle % 2 == 1;
        if (!bundled || i % bundle == 0) {
            base = make_span(static_cast<int>((bundled ? i / bundle / 2 : i) % kinds), size_px, random);
            // Any two depths, level, or a drift of a few steps.
            base_from_z      = random.between(1, depth_steps - 1);
            const int kind_z = random.between(0, 3);
            base_to_z        = kind_z == 0   ? base_from_z
                               : kind_z == 1 ? std::clamp(base_from_z + random.between(-40, 40), 0, depth_steps)
                                             : random.between(0, depth_steps);
        }
        Span span   = base;
        int  from_z = base_from_z, to_z = base_to_z;
        if (bundled) {
            const int  spread = px_steps * 8;
            const auto near   = [&](glm::ivec2 point) {
                return glm::clamp(point + glm::ivec2(random.between(0, spread), random.between(0, spread)),
                                    glm::ivec2(0), extent);
            };
            span   = {near(span.from), near(span.to)};
            from_z = std::clamp(from_z + random.between(-4, 4), 1, depth_steps - 1);
            to_z   = std::clamp(to_z + random.between(-4, 4), 0, depth_steps);
        }
        rays.push_back(make_ray(span, from_z, to_z, size_px, random));
    }
    return rays;
}

void complete_field(GBufferImage& image)
{
    const size_t count = image.depth.size();
    image.normal_vs.assign(count, glm::vec3(0, 0, 1));
    image.roughness.assign(count, 0);
    image.metallic.assign(count, 1);
    for (auto* colours : {&image.base_colour, &image.radiance, &image.highlight}) colours->assign(count, glm::vec3(0));
    image.object_id.assign(count, 1);
}

} // namespace ssrlab::test
