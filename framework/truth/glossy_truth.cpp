#include "truth/glossy_truth.h"

#include "core/error.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"
#include "truth/screen_ray.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Two numbers in [0, 1).
glm::dvec2 random(glm::ivec2 pixel, int ray, uint32_t seed)
{
    return glm::dvec2(glm::uvec2(hash({uint32_t(pixel.x), uint32_t(pixel.y), uint32_t(ray), seed}))) * 0x1p-32;
}

/// Columns: tangent, bitangent, normal.
glm::dmat3 frame_about(glm::dvec3 normal)
{
    const glm::dvec3 other   = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 tangent = glm::normalize(glm::cross(other, normal));
    return {tangent, glm::cross(normal, tangent), normal};
}

/// In the frame of the normal (z); `view` is a unit vector with z > 0. Heitz 2018, listing 1.
glm::dvec3 visible_normal(glm::dvec3 view, double alpha, glm::dvec2 u)
{
    const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * view.x, alpha * view.y, view.z));
    const double     r = std::sqrt(u.x), phi = 2 * std::numbers::pi * u.y;
    const double     a = r * std::cos(phi), share = 0.5 * (1 + stretched.z);
    const glm::dvec3 across(-stretched.y, stretched.x, 0);
    const glm::dvec3 t1 = glm::length(across) > 0 ? glm::normalize(across) : glm::dvec3(1, 0, 0);
    const glm::dvec3 t2 = glm::cross(stretched, t1);
    const double     b  = (1 - share) * std::sqrt(1 - a * a) + share * r * std::sin(phi);
    const glm::dvec3 h  = a * t1 + b * t2 + std::sqrt(std::max(0.0, 1 - a * a - b * b)) * stretched;
    return glm::normalize(glm::dvec3(alpha * h.x, alpha * h.y, std::max(0.0, h.z)));
}

/// Smith's Lambda of GGX; Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs", JCGT 3(2).
double lambda(double cosine, double alpha)
{
    const double tangent2 = 1 / (cosine * cosine) - 1;
    return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

struct Sample {
    glm::dvec3 direction_vs{0};
    double     weight = 0;
};

/// The lobe of one pixel.
class Lobe {
public:
    Lobe(const GBufferImage& gbuffer, glm::ivec2 pixel, double roughness) : alpha_(roughness * roughness)
    {
        const glm::dvec3 to_eye_vs = gbuffer.view.projection == Projection::perspective
                                         ? -glm::normalize(pixel_point_vs(gbuffer, pixel))
                                         : glm::dvec3(0, 0, 1);
        // The normal that mirrors the eye into the mirror direction, on the eye's side (mirroring does not know sides).
        const glm::dvec3 sum    = to_eye_vs + mirror_direction_vs(gbuffer, pixel);
        const double     length = glm::length(sum);
        const size_t     i      = pixel_index(pixel, gbuffer.view.size_px);
        const glm::dvec3 stored = glm::normalize(glm::dvec3(gbuffer.normal_vs[i]));
        frame_                  = frame_about(length > grazing ? sum / length : stored);
        view_                   = glm::transpose(frame_) * to_eye_vs;
        view_.z                 = std::max(view_.z, grazing);
    }

    Sample sample(glm::dvec2 u) const
    {
        const glm::dvec3 half  = visible_normal(glm::normalize(view_), alpha_, u);
        const glm::dvec3 light = 2 * glm::dot(view_, half) * half - view_;
        if (!(light.z > 0)) return {};
        const double to_view = 1 + lambda(view_.z, alpha_);
        return {glm::normalize(frame_ * light), to_view / (to_view + lambda(light.z, alpha_))};
    }

private:
    static constexpr double grazing = 1e-6;

    double     alpha_;
    glm::dmat3 frame_{1};
    glm::dvec3 view_{0};
};

/// The rays of one row, pixel after pixel.
struct RowRays {
    std::vector<SceneRay> rays;    // with weight 0 left out
    std::vector<double>   weights; // of `rays`
    std::vector<size_t>   pixels;  // that reflect
    std::vector<size_t>   ends;    // of each pixel's rays in `rays`
};

void add_pixel(const ReflectedRays& reflected, const GBufferImage& gbuffer, glm::ivec2 pixel,
               const GlossySettings& settings, GlossyTruth& truth, RowRays& row)
{
    const size_t i   = pixel_index(pixel, gbuffer.view.size_px);
    const auto   add = [&](const Sample& sample) {
        row.rays.push_back(reflected.ray_from(pixel, sample.direction_vs));
        row.weights.push_back(sample.weight);
    };
    const bool mirror = !(gbuffer.roughness[i] >= mirror_roughness);
    truth.rays[i]     = mirror ? 1 : uint32_t(settings.rays);
    if (mirror) add({mirror_direction_vs(gbuffer, pixel), 1});
    if (!mirror) {
        const Lobe lobe(gbuffer, pixel, std::min(double(gbuffer.roughness[i]), 1.0));
        for (int k = 0; k < settings.rays; ++k)
            if (const Sample sample = lobe.sample(random(pixel, k, settings.seed)); sample.weight > 0) add(sample);
    }
    row.pixels.push_back(i);
    row.ends.push_back(row.rays.size());
}

/// Mean and standard error of one pixel; rays below the horizon count as 0.
void reduce(std::span<const RayEnd> ends, std::span<const double> weights, size_t i, GlossyTruth& truth)
{
    const double count = truth.rays[i];
    glm::dvec3   sum(0), squares(0);
    double       weight = 0;
    for (size_t k = 0; k < ends.size(); ++k) {
        sum += weights[k] * glm::dvec3(ends[k].radiance);
        weight += weights[k];
    }
    const glm::dvec3 mean = sum / count;
    for (size_t k = 0; k < ends.size(); ++k) {
        const glm::dvec3 off = weights[k] * glm::dvec3(ends[k].radiance) - mean;
        squares += off * off;
    }
    squares += (count - double(ends.size())) * mean * mean;
    truth.radiance[i] = glm::vec3(mean);
    truth.weight[i]   = float(weight / count);
    if (count > 1) truth.standard_error[i] = glm::vec3(glm::sqrt(squares / (count - 1) / count));
}

} // namespace

GlossyTruth empty_glossy_truth(glm::ivec2 size_px)
{
    const size_t count = pixel_count(size_px);
    GlossyTruth  truth;
    truth.size_px = size_px;
    truth.rays.resize(count);
    truth.radiance.resize(count);
    truth.standard_error.resize(count);
    truth.weight.resize(count);
    return truth;
}

GlossyTruth glossy_truth(const SceneBvh& bvh, const Scene& scene, const GBufferImage& gbuffer,
                         const TraceSettings& settings, const GlossySettings& glossy, unsigned threads)
{
    require_radiance(gbuffer);
    if (gbuffer.roughness.size() != gbuffer.depth.size())
        throw_failure("G-buffer of view '{}': expected {} values of roughness, found {}", gbuffer.view.name,
                      gbuffer.depth.size(), gbuffer.roughness.size());
    if (glossy.rays < 2) throw_failure("glossy truth: expected at least 2 rays a pixel, got {}", glossy.rays);
    GlossyTruth         truth = empty_glossy_truth(gbuffer.view.size_px);
    const ReflectedRays reflected(bvh, scene, gbuffer, settings.max_distance_m);
    parallel_rows(truth.size_px.y, threads, [&](int y) {
        RowRays row;
        for (int x = 0; x < truth.size_px.x; ++x)
            if (reflects(gbuffer, {x, y})) add_pixel(reflected, gbuffer, {x, y}, glossy, truth, row);
        const std::vector<RayEnd> ends = reflected.follow(row.rays);
        for (size_t p = 0, first = 0; p < row.pixels.size(); first = row.ends[p++])
            reduce(std::span(ends).subspan(first, row.ends[p] - first),
                   std::span(row.weights).subspan(first, row.ends[p] - first), row.pixels[p], truth);
    });
    return truth;
}

std::vector<glm::vec4> reflection_of(const GlossyTruth& truth)
{
    std::vector<glm::vec4> reflection;
    reflection.reserve(truth.rays.size());
    for (size_t i = 0; i < truth.rays.size(); ++i)
        reflection.push_back(truth.rays[i] == 0    ? glm::vec4(0, 0, 0, -1)
                             : truth.weight[i] > 0 ? glm::vec4(truth.radiance[i] / truth.weight[i], 1)
                                                   : glm::vec4(0, 0, 0, 1));
    return reflection;
}

} // namespace ssrlab
