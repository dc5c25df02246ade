// A sequence that fills the unit square evenly, whatever its length.
#pragma once

#include <glm/glm.hpp>

namespace ssrlab {

/// Returns point k of R2, moved by an offset (M. Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
/// Sequences").
inline glm::dvec2 r2_point(int k, glm::dvec2 offset)
{
    return glm::fract(offset + double(k) * glm::dvec2(0.7548776662466927, 0.5698402909980532));
}

} // namespace ssrlab
