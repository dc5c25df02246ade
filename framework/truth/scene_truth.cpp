#include "truth/scene_truth.h"

#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "truth/screen_ray.h"

#include <fmt/format.h>

#include <numeric>

namespace ssrlab {
namespace {

/// Returns how many pixels are off the scene's surfaces.
size_t fill_row(const ReflectedRays& reflected, const GBufferImage& gbuffer, const TraceSettings& settings, int y,
                SceneTruth& truth)
{
    std::vector<SceneRay> rays;
    std::vector<size_t>   pixels;
    const int             width = gbuffer.view.size_px.x;
    for (int x = 0; x < width; ++x) {
        if (!reflects(gbuffer, {x, y}, settings)) continue;
        rays.push_back(reflected.ray_from({x, y}, mirror_direction_vs(gbuffer, {x, y})));
        pixels.push_back(pixel_index({x, y}, gbuffer.view.size_px));
    }
    const std::vector<RayEnd> ends = reflected.follow(rays);
    for (size_t k = 0; k < ends.size(); ++k) {
        const size_t i      = pixels[k];
        truth.cls[i]        = ends[k].cls;
        truth.point_vs[i]   = ends[k].point_vs;
        truth.point_px[i]   = ends[k].point_px;
        truth.distance_m[i] = ends[k].distance_m;
        truth.radiance[i]   = ends[k].radiance;
    }
    return reflected.count_off_surface(pixels);
}

} // namespace

bool same_scene_truth(const TraceSettings& a, const TraceSettings& b)
{
    return a.max_distance_m == b.max_distance_m && a.dielectric_min_f0 == b.dielectric_min_f0 &&
           a.dielectric_max_roughness == b.dielectric_max_roughness;
}

SceneTruth empty_scene_truth(glm::ivec2 size_px)
{
    const size_t count = pixel_count(size_px);
    SceneTruth   truth;
    truth.size_px = size_px;
    truth.cls.resize(count);
    truth.point_vs.resize(count);
    truth.point_px.resize(count);
    truth.distance_m.resize(count);
    truth.radiance.resize(count);
    return truth;
}

SceneTruth scene_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                       const TraceSettings& settings, unsigned threads)
{
    require_radiance(gbuffer);
    SceneTruth          truth = empty_scene_truth(gbuffer.view.size_px);
    const ReflectedRays reflected(bvh, scene, gbuffer, settings.max_distance_m);
    std::vector<size_t> off_surface(static_cast<size_t>(truth.size_px.y));
    parallel_rows(truth.size_px.y, threads, [&](int y) {
        off_surface[static_cast<size_t>(y)] = fill_row(reflected, gbuffer, settings, y, truth);
    });
    truth.off_surface = std::accumulate(off_surface.begin(), off_surface.end(), uint64_t(0));
    return truth;
}

std::optional<double> off_surface_share(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                                        const TraceSettings& settings)
{
    std::vector<size_t> reflecting;
    for (size_t i = 0; i < gbuffer.depth.size(); ++i)
        if (reflects(gbuffer, pixel_at(i, gbuffer.view.size_px), settings)) reflecting.push_back(i);
    if (reflecting.empty()) return std::nullopt;
    const ReflectedRays reflected(bvh, scene, gbuffer, settings.max_distance_m);
    return double(reflected.count_off_surface(reflecting)) / double(reflecting.size());
}

std::string drawn_elsewhere(std::optional<double> off_surface_share)
{
    constexpr double most  = 0.05;
    const double     share = off_surface_share.value_or(0);
    if (share <= most) return "";
    return fmt::format("the driver draws another scene: at {:.0f} % of the pixels that reflect, the drawn depth is off "
                       "every surface",
                       100 * share);
}

} // namespace ssrlab
