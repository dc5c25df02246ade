// Hand-made G-buffers whose reflections have closed forms.
#pragma once

#include "core/gbuffer_image.h"
#include "core/pixel_index.h"
#include "test.h"

namespace ssrlab::test {

/// 90 degrees, square pixels, near 0.1 m: px = 32 (1 + X / Z), py = 32 (1 - Y / Z) at 64 x 64.
inline View bench_view(glm::ivec2 size_px, double near_m = 0.1)
{
    View view;
    view.size_px   = size_px;
    view.focal_px  = glm::dvec2(0.5 * size_px.y);
    view.centre_px = 0.5 * glm::dvec2(size_px);
    view.near_m    = near_m;
    return view;
}

inline GBufferImage empty_gbuffer(const View& view)
{
    const size_t count = pixel_count(view.size_px);
    GBufferImage gbuffer;
    gbuffer.view = view;
    gbuffer.depth.resize(count);
    gbuffer.normal_vs.resize(count);
    gbuffer.roughness.resize(count);
    gbuffer.metallic.resize(count);
    gbuffer.base_colour.resize(count);
    gbuffer.dielectric_f0.resize(count); // what is no metal does not reflect
    gbuffer.radiance.resize(count);
    gbuffer.highlight.resize(count);
    gbuffer.object_id.resize(count);
    return gbuffer;
}

inline size_t at(const GBufferImage& gbuffer, int x, int y) { return pixel_index({x, y}, gbuffer.view.size_px); }

inline void set_pixel(GBufferImage& gbuffer, int x, int y, double distance_m, glm::dvec3 normal_vs, float metallic)
{
    gbuffer.depth[at(gbuffer, x, y)]     = float(distance_to_depth(gbuffer.view, distance_m));
    gbuffer.normal_vs[at(gbuffer, x, y)] = glm::vec3(normal_vs);
    gbuffer.metallic[at(gbuffer, x, y)]  = metallic;
}

/// Mirror floor at y = -1 and, up to its horizon, a dull wall at Z = wall_m (infinity: no wall).
inline GBufferImage floor_and_wall(const View& view, double wall_m)
{
    GBufferImage gbuffer = empty_gbuffer(view);
    for (int y = 0; y < view.size_px.y; ++y) {
        const double slope   = (y + 0.5 - view.centre_px.y) / view.focal_px.y;
        const double floor_m = slope > 0 ? 1.0 / slope : std::numeric_limits<double>::infinity();
        for (int x = 0; x < view.size_px.x; ++x) {
            if (floor_m < wall_m) {
                set_pixel(gbuffer, x, y, floor_m, {0, 1, 0}, 1);
            } else if (std::isfinite(wall_m)) {
                set_pixel(gbuffer, x, y, wall_m, {0, 0, 1}, 0);
            }
        }
    }
    return gbuffer;
}

/// Patches of random distance and random normals, some background: everything reflects in every direction.
inline GBufferImage random_gbuffer(const View& view, unsigned seed)
{
    GBufferImage                           gbuffer = empty_gbuffer(view);
    std::mt19937                           random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    const double nearest_m = view.projection == Projection::perspective ? 2 : 0.2 * view.far_m;
    for (const auto [i, x, y] : pixels_of(view.size_px)) {
        if (unit(random) < -0.7) continue;
        const double patch = 1.5 + std::sin(0.3 * x + seed) * std::cos(0.2 * y);
        set_pixel(gbuffer, x, y, nearest_m * (patch + 0.05 * unit(random)),
                  {unit(random), unit(random), unit(random) + 0.5}, 1);
    }
    return gbuffer;
}

} // namespace ssrlab::test
