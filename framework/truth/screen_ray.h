// Ray set-up in double precision: section "The ray" of docs/reference/hit_contract.md.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"

namespace ssrlab {

/// The mirror ray of one pixel, as a straight segment in (x_px, y_px, depth): origin + t * delta, t in [0, 1].
struct ScreenRay {
    bool        traced = false; // false: nothing below is defined
    glm::dvec3  origin_px_depth{0};
    glm::dvec3  delta_px_depth{0}; // all zero when the ray visits nothing
    glm::ivec2  start_pixel{0, 0};
    TraceStatus end_status = TraceStatus::not_traced; // if it meets nothing
    double      length_m   = 0;                       // from the reflecting point to the clipped end; may be +inf
    glm::dvec3  direction_vs{0};                      // unit
};

/// Returns whether the pixel reflects: finite depth > 0, a finite non-zero normal, and a material that reflects.
bool reflects(const GBufferImage& gbuffer, glm::ivec2 pixel, const TraceSettings& settings = {});

/// Returns the view-space point at the pixel's centre and depth.
glm::dvec3 pixel_point_vs(const GBufferImage& gbuffer, glm::ivec2 pixel);

/// Returns the unit mirror direction at a reflecting pixel.
glm::dvec3 mirror_direction_vs(const GBufferImage& gbuffer, glm::ivec2 pixel);

ScreenRay make_screen_ray(const GBufferImage& gbuffer, glm::ivec2 pixel, const TraceSettings& settings);
/// Makes a ray from a reflecting pixel in any direction; the length of `direction_vs` does not matter.
ScreenRay make_screen_ray(const GBufferImage& gbuffer, glm::ivec2 pixel, glm::dvec3 direction_vs,
                          const TraceSettings& settings);

/// Throws Failure unless depth, normal_vs and metallic cover the image.
void require_complete(const GBufferImage& gbuffer);

} // namespace ssrlab
