// How much light a GGX surface reflects: the integral over its lobe, as a table for shaders/passes/ggx_share.glsl.
#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace ssrlab {

/// Roughness by row, square root of the cosine by column, both from 0 to 1, GGX_SHARE_ENTRIES of each. A surface that reflects f0 of the
/// light along its normal reflects f0 * x + y.
const std::vector<glm::vec2>& ggx_share_table();

} // namespace ssrlab
