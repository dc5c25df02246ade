#include "truth/ggx_lobe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

constexpr double grazing = 1e-6;

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

} // namespace

Lobe::Lobe(glm::dvec3 normal, glm::dvec3 to_eye, double roughness)
    : alpha_(roughness >= double(mirror_roughness) ? std::min(roughness, 1.0) * std::min(roughness, 1.0) : 0),
      frame_(frame_about(normal)), view_(glm::transpose(frame_) * to_eye)
{
    view_.z = std::max(view_.z, grazing);
    view_   = glm::normalize(view_);
}

LobeSample Lobe::sample(glm::dvec2 u) const
{
    if (is_mirror()) return {glm::normalize(frame_ * glm::dvec3(-view_.x, -view_.y, view_.z)), 1, view_.z};
    const glm::dvec3 half     = visible_normal(view_, alpha_, u);
    const double     cos_half = glm::dot(view_, half);
    const glm::dvec3 light    = 2 * cos_half * half - view_;
    if (!(light.z > 0)) return {};
    const double to_view = 1 + lambda(view_.z, alpha_);
    return {glm::normalize(frame_ * light), to_view / (to_view + lambda(light.z, alpha_)), cos_half};
}

glm::dvec3 f0_of(glm::dvec3 base_colour, double metallic, double dielectric_f0)
{
    return (1 - metallic) * glm::dvec3(dielectric_f0) + metallic * base_colour;
}

glm::dvec3 fresnel(glm::dvec3 f0, double cosine)
{
    const double f90 = std::min(1.0, 50 * std::max({f0.x, f0.y, f0.z}));
    return f0 + (f90 - f0) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

} // namespace ssrlab
