#include "frame/directional_albedo.h"

#include "shared.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

/// Smith's Lambda of GGX: E. Heitz 2014, "Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs".
double smith_lambda(double alpha, double cosine)
{
    const double tangent2 = 1 / (cosine * cosine) - 1;
    return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

/// The split of B. Karis 2013, "Real Shading in Unreal Engine 4", with height-correlated masking and shadowing. Half vectors are drawn from
/// the visible normals, a regular grid of them: J. Dupuy, A. Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
glm::dvec2 dfg(double roughness, double cosine)
{
    constexpr int    heights = 64, turns = 16; // of half the circle: the other half is its mirror image
    const double     alpha = std::max(roughness * roughness, 1e-4), lambda_v = smith_lambda(alpha, cosine);
    const glm::dvec3 to_eye(std::sqrt(1 - cosine * cosine), 0, cosine);
    const glm::dvec3 stretched = glm::normalize(to_eye * glm::dvec3(alpha, alpha, 1));
    glm::dvec2       sum(0);
    for (int i = 0; i < heights; ++i)
        for (int j = 0; j < turns; ++j) {
            const double z = 1 - (i + 0.5) / heights * (1 + stretched.z), phi = std::numbers::pi * (j + 0.5) / turns;
            const double sine     = std::sqrt(std::max(0.0, 1 - z * z));
            const glm::dvec3 cap  = glm::dvec3(sine * std::cos(phi), sine * std::sin(phi), z) + stretched;
            const glm::dvec3 half = glm::normalize(glm::dvec3(alpha * cap.x, alpha * cap.y, std::max(cap.z, 0.0)));
            const double     v_h = glm::dot(to_eye, half), n_l = 2 * v_h * half.z - cosine;
            if (n_l <= 0) continue;
            const double seen   = (1 + lambda_v) / (1 + lambda_v + smith_lambda(alpha, n_l));
            const double beside = 1 - std::min(v_h, 1.0), fresnel = beside * beside * beside * beside * beside;
            sum += seen * glm::dvec2(1 - fresnel, fresnel);
        }
    return sum / static_cast<double>(heights * turns);
}

} // namespace

const std::vector<glm::vec2>& dfg_table()
{
    static const std::vector<glm::vec2> table = [] {
        constexpr double       last = DFG_TABLE_ENTRIES - 1;
        std::vector<glm::vec2> entries;
        for (int row = 0; row < DFG_TABLE_ENTRIES; ++row)
            for (int column = 0; column < DFG_TABLE_ENTRIES; ++column)
                entries.emplace_back(dfg(row / last, std::max(std::pow(column / last, 2), 1e-4)));
        return entries;
    }();
    return table;
}

SampledTable upload_dfg_table(Gpu& gpu)
{
    std::vector<uint32_t> texels;
    for (const glm::vec2& entry : dfg_table()) texels.push_back(glm::packHalf2x16(entry));
    SampledTable table{make_image(gpu, {.format  = vk::Format::eR16G16Sfloat,
                                        .size_px = glm::ivec2(DFG_TABLE_ENTRIES),
                                        .usage   = vk::ImageUsageFlagBits::eSampled}),
                       {gpu.impl->device, vk::SamplerCreateInfo{.magFilter    = vk::Filter::eLinear,
                                                                .minFilter    = vk::Filter::eLinear,
                                                                .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                                                .addressModeV = vk::SamplerAddressMode::eClampToEdge}}};
    upload(gpu, table.image, texels.data(), texels.size() * sizeof(uint32_t));
    return table;
}

} // namespace ssrlab
