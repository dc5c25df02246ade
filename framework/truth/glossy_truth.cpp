#include "truth/glossy_truth.h"

#include "core/error.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "truth/r2_sequence.h"
#include "truth/screen_ray.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ssrlab {
namespace {

/// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", JCGT 9(3): pcg4d.
glm::uvec4 hash(glm::uvec4 v)
{
    v = v * 1664525U + 1013904223U;
    for (int round = 0; round < 2; ++round) {
        v.x += v.y * v.w;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        v.w += v.y * v.z;
        if (round == 0) v ^= v >> 16U;
    }
    return v;
}

/// Two numbers in [0, 1) for each ray of each pixel and each of its bounces.
glm::dvec2 random(glm::ivec2 pixel, int ray, int bounce, uint32_t seed)
{
    const glm::uvec4 key{uint32_t(pixel.x), uint32_t(pixel.y), uint32_t(ray) + (uint32_t(bounce) << 20U), seed};
    return glm::dvec2(glm::uvec2(hash(key))) * 0x1p-32;
}

/// Even and odd rays are two halves that know nothing of each other: what they differ by tells their noise.
int half_of(int ray) { return ray % 2; }

/// The same for rays of which each half fills one lobe evenly, by a random offset for each pixel.
glm::dvec2 even(glm::ivec2 pixel, int ray, int bounce, uint32_t seed)
{
    return r2_point(ray / 2, random(pixel, half_of(ray), bounce, seed));
}

/// Light of the two halves; their mean is the light.
using Halves = std::array<glm::dvec3, 2>;

/// A ray under way, and what the light at its end will count for.
struct Path {
    size_t     sample = 0;
    glm::dvec3 throughput{1};
    double     roughness = 0;     // the largest so far
    int        number    = 0;     // among the rays of its pixel
    bool       alone     = false; // nothing but mirrors so far: one ray stands for the whole pixel
};

/// The rays of one row, pixel after pixel.
struct RowPaths {
    std::vector<glm::ivec2> pixels;  // that reflect
    std::vector<size_t>     ends;    // of each pixel's samples
    std::vector<glm::dvec3> weights; // of each sample; 0: below the horizon
    std::vector<Halves>     light;   // of each sample
    std::vector<size_t>     owners;  // of each sample in `pixels`
    std::vector<Path>       paths;   // that go on
    std::vector<SceneRay>   rays;    // of those
};

/// A path that is alone stands for both halves.
void add_light(RowPaths& row, const Path& path, glm::dvec3 value)
{
    Halves& light = row.light[path.sample];
    if (path.alone)
        for (glm::dvec3& half : light) half += value;
    else
        light[half_of(path.number)] += 2.0 * value;
}

class PathTracer {
public:
    PathTracer(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer, const TraceSettings& settings,
               const GlossySettings& glossy)
        : bvh_(bvh), scene_(scene), gbuffer_(gbuffer), settings_(settings), glossy_(glossy),
          reflected_(bvh, scene, gbuffer, settings.max_distance_m)
    {
    }

    void fill_row(int y, GlossyTruth& truth) const
    {
        RowPaths row;
        for (int x = 0; x < truth.size_px.x; ++x)
            if (reflects(gbuffer_, {x, y}, settings_)) add_pixel({x, y}, truth, row);
        for (int bounce = 0; !row.rays.empty(); ++bounce) advance(row, bounce);
        for (size_t p = 0, first = 0; p < row.pixels.size(); first = row.ends[p++])
            reduce(row, first, row.ends[p], pixel_index(row.pixels[p], truth.size_px), truth);
    }

private:
    void add_pixel(glm::ivec2 pixel, GlossyTruth& truth, RowPaths& row) const
    {
        const size_t     i         = pixel_index(pixel, truth.size_px);
        const double     roughness = double(gbuffer_.roughness[i]);
        const glm::dvec3 to_eye_vs = gbuffer_.view.projection == Projection::perspective
                                         ? -glm::normalize(pixel_point_vs(gbuffer_, pixel))
                                         : glm::dvec3(0, 0, 1);
        // The normal that mirrors the eye into the mirror direction, on the eye's side (mirroring does not know sides).
        const glm::dvec3 mirror_vs = mirror_direction_vs(gbuffer_, pixel), sum = to_eye_vs + mirror_vs;
        const glm::dvec3 stored    = glm::normalize(glm::dvec3(gbuffer_.normal_vs[i]));
        const glm::dvec3 normal_vs = glm::length(sum) > 1e-6 ? glm::normalize(sum) : stored;
        const glm::dvec3 f0        = glossy_.metallic_exponent ? glm::dvec3(1)
                                                               : f0_of(gbuffer_.base_colour[i], double(gbuffer_.metallic[i]),
                                                                       double(dielectric_f0_at(gbuffer_, i)));
        const Lobe       lobe(normal_vs, to_eye_vs, std::isfinite(roughness) ? roughness : 0);
        truth.rays[i] = lobe.is_mirror() ? 1 : uint32_t(glossy_.rays);
        for (int k = 0; k < int(truth.rays[i]); ++k) {
            LobeSample sample = lobe.sample(even(pixel, glossy_.first + k, 0, glossy_.seed));
            if (lobe.is_mirror()) sample.direction = mirror_vs; // the scene truth's, to the last bit
            const size_t number = row.weights.size();
            row.weights.push_back(sample.weight > 0 ? sample.weight * fresnel(f0, sample.cos_half) : glm::dvec3(0));
            row.light.push_back({glm::dvec3(0), glm::dvec3(0)});
            row.owners.push_back(row.pixels.size());
            if (!(sample.weight > 0)) continue;
            row.paths.push_back({number, glm::dvec3(1), roughness, glossy_.first + k, lobe.is_mirror()});
            row.rays.push_back(reflected_.ray_from(pixel, sample.direction));
        }
        row.pixels.push_back(pixel);
        row.ends.push_back(row.weights.size());
    }

    /// What every ray meets, and the rays that go on from there.
    void advance(RowPaths& row, int bounce) const
    {
        const std::vector<RayEnd>   ends  = reflected_.follow(row.rays);
        const std::vector<Path>     paths = std::move(row.paths);
        const std::vector<SceneRay> rays  = std::move(row.rays);
        row.paths.clear();
        row.rays.clear();
        for (size_t k = 0; k < ends.size(); ++k) arrive(row, paths[k], rays[k], ends[k], bounce);
    }

    void arrive(RowPaths& row, Path path, const SceneRay& ray, const RayEnd& end, int bounce) const
    {
        if (end.cls == TruthClass::sky) return add_light(row, path, path.throughput * glm::dvec3(end.radiance));
        const SurfaceMaterial material  = surface_material(scene_, end.hit.surface);
        const glm::dvec3      point_ws  = ray.origin_ws + end.hit.t * ray.direction_ws;
        const glm::dvec3      to_eye_ws = -glm::normalize(ray.direction_ws);
        const double          roughness = std::max(double(material.roughness), path.roughness);
        add_light(row, path,
                  path.throughput *
                      glm::dvec3(shade_highlight(bvh_, scene_, end.hit, point_ws, ray.direction_ws, roughness)));
        const bool goes_on = bounce < glossy_.bounces &&
                             settings_.material_reflects(material.metallic, material.dielectric_f0, material.roughness);
        if (!goes_on) return add_light(row, path, path.throughput * glm::dvec3(end.radiance));
        const glm::ivec2 pixel = row.pixels[row.owners[path.sample]];
        const Lobe       lobe(seen_normal_ws(material, end.hit, ray.direction_ws), to_eye_ws, roughness);
        const glm::dvec3 f0 = f0_of(material.base_colour, double(material.metallic), double(material.dielectric_f0));
        const glm::dvec3 stand_in =
            glm::dvec3((scene_.ambient + material.bounced) * material.base_colour) * double(material.metallic);
        const glm::dvec3 emission = glm::dvec3(material.emissive);
        const glm::dvec3 below    = glm::max(glm::dvec3(end.radiance) - emission - stand_in, 0.0);
        const double     side     = glm::dot(end.hit.normal_ws, ray.direction_ws) > 0 ? -1 : 1;
        const bool       spreads  = path.alone && !lobe.is_mirror();
        const int        count    = spreads ? glossy_.rays : 1;
        add_light(row, path, path.throughput * emission);
        path.throughput /= count;
        path.alone     = path.alone && !spreads;
        path.roughness = roughness;
        for (int k = 0; k < count; ++k) {
            path.number              = spreads ? glossy_.first + k : path.number;
            const glm::dvec2 numbers = spreads ? even(pixel, glossy_.first + k, bounce + 1, glossy_.seed)
                                               : random(pixel, path.number, bounce + 1, glossy_.seed);
            const LobeSample sample  = lobe.sample(numbers);
            const glm::dvec3 weight  = sample.weight * fresnel(f0, sample.cos_half);
            add_light(row, path,
                      path.throughput * (1.0 - weight) * below); // its mean over the lobe is that of the albedo
            if (!(sample.weight > 0)) continue;
            if (side * glm::dot(end.hit.normal_ws, sample.direction) <= 0) {
                // Interpolated normals lead into the triangle.
                add_light(row, path, path.throughput * weight * (glm::dvec3(end.radiance) - emission));
                continue;
            }
            Path onward = path;
            onward.throughput *= weight;
            row.paths.push_back(onward);
            row.rays.push_back({point_ws, sample.direction, self_hit_share * std::max(1.0, end.hit.t),
                                std::numeric_limits<double>::infinity()});
        }
    }

    /// Mean and noise of one pixel's samples.
    void reduce(const RowPaths& row, size_t first, size_t last, size_t i, GlossyTruth& truth) const
    {
        Halves sums{glm::dvec3(0), glm::dvec3(0)}, weights = sums;
        for (size_t k = first; k < last; ++k) {
            for (size_t half : {0, 1}) sums[half] += row.weights[k] * row.light[k][half];
            weights[(k - first) % 2] += 2.0 * row.weights[k];
        }
        if (truth.rays[i] == 1) weights = {row.weights[first], row.weights[first]}; // it stands for both halves
        const auto       count  = double(last - first);
        const glm::dvec3 weight = 0.5 * (weights[0] + weights[1]);
        truth.albedo[i]         = glm::vec3(weight / count);
        if (!glossy_.metallic_exponent) {
            truth.radiance[i] = glm::vec3(0.5 * (sums[0] + sums[1]) / count);
            truth.noise[i]    = glm::vec3(0.5 * (sums[0] - sums[1]) / count);
        } else if (weight.r > 0) {
            truth.radiance[i] = glm::vec3(0.5 * (sums[0] + sums[1]) / weight);
            if (weights[0].r > 0 && weights[1].r > 0)
                truth.noise[i] = glm::vec3(0.5 * (sums[0] / weights[0] - sums[1] / weights[1]));
        }
    }

    const SceneBvh&       bvh_;
    const Scene&          scene_;
    const GBufferImage&   gbuffer_;
    const TraceSettings&  settings_;
    const GlossySettings& glossy_;
    ReflectedRays         reflected_;
};

/// What a reflecting pixel shows by the directional albedo of its lobe.
glm::vec3 shown_by_albedo(const GlossyTruth& truth, const GBufferImage& gbuffer, glm::vec3 ambient, size_t i,
                          glm::vec3 reflected)
{
    const glm::vec3 stand_in = gbuffer.metallic[i] * ambient * gbuffer.base_colour[i];
    const glm::vec3 emission = emission_at(gbuffer, i);
    const glm::vec3 below    = glm::max(gbuffer.radiance[i] - emission - stand_in, 0.0F) * diffuse_share_at(gbuffer, i);
    return emission + (1.0F - truth.albedo[i]) * below + reflected + gbuffer.highlight[i];
}

/// What a reflecting pixel shows by metallic ^ exponent.
glm::vec3 shown_by_metallic(const GlossyTruth& truth, const GBufferImage& gbuffer, size_t i, glm::vec3 reflected)
{
    const glm::vec3 own       = gbuffer.radiance[i] + gbuffer.highlight[i];
    const glm::vec3 scattered = glm::max(gbuffer.radiance[i] - emission_at(gbuffer, i), 0.0F);
    return own +
           (reflected - scattered - gbuffer.highlight[i]) * std::pow(gbuffer.metallic[i], *truth.metallic_exponent);
}

} // namespace

GlossyTruth empty_glossy_truth(glm::ivec2 size_px)
{
    const size_t count = pixel_count(size_px);
    GlossyTruth  truth;
    truth.size_px = size_px;
    truth.rays.resize(count);
    truth.radiance.resize(count);
    truth.noise.resize(count);
    truth.albedo.resize(count);
    return truth;
}

GlossyTruth glossy_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                         const TraceSettings& settings, const GlossySettings& glossy, unsigned threads)
{
    require_radiance(gbuffer);
    for (const auto& [name, count] :
         {std::pair("roughness", gbuffer.roughness.size()), std::pair("base_colour", gbuffer.base_colour.size())})
        if (count != gbuffer.depth.size())
            throw_failure("G-buffer of view '{}': expected {} values of {}, found {}", gbuffer.view.name,
                          gbuffer.depth.size(), name, count);
    if (glossy.rays < 2 || glossy.rays % 2 != 0 || glossy.first % 2 != 0)
        throw_failure("glossy truth: expected an even number of rays a pixel, got {} from {} on", glossy.rays,
                      glossy.first);
    GlossyTruth truth       = empty_glossy_truth(gbuffer.view.size_px);
    truth.metallic_exponent = glossy.metallic_exponent;
    const PathTracer tracer(bvh, scene, gbuffer, settings, glossy);
    parallel_rows(truth.size_px.y, threads, [&](int y) { tracer.fill_row(y, truth); });
    return truth;
}

Image true_picture(const GlossyTruth& truth, const GBufferImage& gbuffer, glm::vec3 ambient, float noises)
{
    Image image{truth.size_px, {"R", "G", "B"}, {}, {}};
    image.values.reserve(3 * truth.rays.size());
    for (size_t i = 0; i < truth.rays.size(); ++i) {
        const glm::vec3 reflected = truth.radiance[i] + noises * truth.noise[i];
        const glm::vec3 colour    = truth.rays[i] == 0        ? gbuffer.radiance[i] + gbuffer.highlight[i]
                                    : truth.metallic_exponent ? shown_by_metallic(truth, gbuffer, i, reflected)
                                                              : shown_by_albedo(truth, gbuffer, ambient, i, reflected);
        image.values.insert(image.values.end(), {colour.r, colour.g, colour.b});
    }
    return image;
}

} // namespace ssrlab
