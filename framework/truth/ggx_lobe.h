// The reflected lobe of a rough surface: GGX with Smith's height-correlated masking, single scattering (appendix B of
// glTF).
//
// Half vectors h are drawn from the normals visible to the viewer v (E. Heitz 2018, "Sampling the GGX Distribution of
// Visible Normals", JCGT 7(4)), with alpha = roughness^2. A ray leaves along l, the mirror image of v at h, with the
// weight F(v.h) G2(v, l) / G1(v), or 0 below the horizon. So the mean of weight * radiance is the integral of radiance
// * F D G2 / (4 n.v), the mean weight the directional albedo. Below mirror_roughness it is the mirror ray alone.
#pragma once

#include <glm/glm.hpp>

namespace ssrlab {

inline constexpr float mirror_roughness = 0.02F;

struct LobeSample {
    glm::dvec3 direction{0};
    double     weight   = 0; // G2 / G1, without Fresnel's factor; 0: the ray goes below the horizon
    double     cos_half = 0; // v.h
};

class Lobe {
public:
    /// Takes unit vectors. A viewer behind the surface counts as grazing it.
    Lobe(glm::dvec3 normal, glm::dvec3 to_eye, double roughness);

    bool is_mirror() const { return alpha_ == 0; }
    /// Returns a ray for two random numbers in [0, 1).
    LobeSample sample(glm::dvec2 u) const;

private:
    double     alpha_; // 0: a mirror
    glm::dmat3 frame_{1};
    glm::dvec3 view_{0};
};

/// Returns the reflectance at normal incidence of a material that is partly metal.
glm::dvec3 f0_of(glm::dvec3 base_colour, double metallic, double dielectric_f0);

/// Returns Fresnel's factor (Schlick 1994): 1 at grazing incidence, or 50 f0 if f0 is below 2 % ("no reflection").
glm::dvec3 fresnel(glm::dvec3 f0, double cosine);

} // namespace ssrlab
