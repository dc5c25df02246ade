// The hit contract in integers: no number is ever rounded.
#pragma once

#include "check/setup.h"

namespace ssrlab::test {

struct OracleAnswer {
    bool       hit = false;
    glm::ivec2 pixel{0, 0};
};

/// For rays and depths of the random campaign: multiples of 1/256 px and of 2^-20, slab backs at half the depth.
/// A crossing is the fraction n / d of the ray with integers n and d; cross products order crossings, depths are
/// compared after multiplication by d. The largest product, 2 * 2^20 * 2^22, is far inside 64 bits; 128 hold them.
OracleAnswer integer_oracle(const GBufferImage& gbuffer, const RayInput& ray);

/// Whether the ray passes exactly through a corner of this pixel. The pixel beside such a corner is touched in one
/// point: the hit contract does not visit it, arithmetic that rounds may.
bool passes_through_a_corner(const RayInput& ray, glm::ivec2 pixel);

} // namespace ssrlab::test
