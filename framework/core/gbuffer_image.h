// What the camera sees, on the host: the same bits that the shaders read.
#pragma once

#include "core/view.h"

#include <cstdint>
#include <vector>

namespace ssrlab {

/// Reflectance at normal incidence for a refractive index of 1.5: glass, paint, stone.
inline constexpr float common_dielectric_f0 = 0.04F;

/// All arrays are row-major, size_px.x * size_px.y long. Background pixels have depth 0 and object_id 0.
struct GBufferImage {
    View                   view;
    std::vector<float>     depth;       // as view.h defines it
    std::vector<glm::vec3> normal_vs;   // shading normal, unit length; 0 on the background
    std::vector<float>     roughness;   // 0..1
    std::vector<float>     metallic;    // 0..1
    std::vector<glm::vec3> base_colour; // linear
    std::vector<glm::vec3> radiance;    // linear; the part of the lit colour that is the same from every direction
    std::vector<glm::vec3> highlight;   // linear; the part that depends on the view; lit colour = radiance + highlight
    std::vector<uint32_t>  object_id;   // 1 + index of the draw
    std::vector<glm::vec2>
                       gradient; // of depth, from one pixel to the next along x and y; NaN: no plane. Empty: not known
    std::vector<float> solid_back; // depth where the solid behind the pixel ends, 0: it is thin. Empty: not known
    std::vector<glm::vec2> motion_px =
        {}; // where the surface was in the frame before, minus where it is, without jitter; NaN: it was
            // behind the camera. Empty: nothing moved, or no frame came before
    std::vector<glm::vec3> emission =
        {}; // linear; the part of `radiance` that the surface emits. Reflections do not take its place. Empty: 0
    std::vector<float> diffuse_share =
        {}; // of `radiance` without `emission` and metal's share of ambient light: the rest is baked light that stands
            // in for what a metal reflects. Empty: 1
    std::vector<float> dielectric_f0 =
        {}; // reflectance at normal incidence of what is not metal. Empty: common_dielectric_f0
    std::vector<GBufferImage> layers =
        {}; // what lies behind this one, the nearest first: of each pixel the next surface
            // that faces the camera. As many as are known
};

inline float dielectric_f0_at(const GBufferImage& gbuffer, size_t i)
{
    return gbuffer.dielectric_f0.empty() ? common_dielectric_f0 : gbuffer.dielectric_f0[i];
}

inline glm::vec3 emission_at(const GBufferImage& gbuffer, size_t i)
{
    return gbuffer.emission.empty() ? glm::vec3(0) : gbuffer.emission[i];
}

inline float diffuse_share_at(const GBufferImage& gbuffer, size_t i)
{
    return gbuffer.diffuse_share.empty() ? 1 : gbuffer.diffuse_share[i];
}

} // namespace ssrlab
