// Rays on which single and double precision disagree: is it rounding, and of what?
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"
#include "test.h"
#include "truth/screen_ray.h"

namespace ssrlab::test {

struct Dispute {
    bool        missed     = false; // double precision hits, single misses
    double      corner_px  = 0; // how deep the ray goes into the disputed pixel; negative: how far it passes outside
    double      face       = 0; // gap between the ray's depth there and the nearest face of the slab
    double      allowed_px = 0, allowed_face = 0;
    std::string text;

    /// Through a corner exactly: no rounding of the ray decides it as exact numbers do. Level views send dozens.
    bool tie() const { return std::abs(corner_px) < 1e-9; }
    /// A pixel that the ray passes by more than that is no matter of rounding.
    bool explained() const { return corner_px >= -allowed_px && (corner_px <= allowed_px || face <= allowed_face); }
};

struct Answer {
    TraceStatus status;
    glm::ivec2  hit_pixel; // undefined unless hit
};

/// The two answers must differ.
Dispute explain_dispute(const GBufferImage& gbuffer, const TraceSettings& settings, const ScreenRay& ray,
                        const Answer& truth, const Answer& found);

} // namespace ssrlab::test
