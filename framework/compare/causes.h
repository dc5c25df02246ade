// Why a ray is wrong against the scene: one cause for each wrong ray.
#pragma once

#include "compare/measures.h"

namespace ssrlab {

/// Sine of an angle: a ray that ends on its own object at less above its tangent plane hits itself.
inline constexpr double self_hit_sine = 0.01;

/// A ray is wrong if it misses a visible true point by more than 1 px, or hits where no visible point is (a hidden one
/// counts if met in a layer behind the first). A ray that ends before the true point is judged by the pixel where it
/// ends, one that passes a visible true point by the pixel that shows it. The cause is the first that applies.
enum class WrongCause : uint8_t {
    right = 0, // or not traced
    own_surface =
        1, // the mirror direction leads below the plane of the ray's pixel, or the ray ends on its own object there
    not_shown  = 2, // it passed its true point, which the frame does not show
    thin       = 3, // no pixel within 3 x 3 of the true point's holds it
    silhouette = 4, // a neighbour of that pixel lies far off its plane, or holds the true point
    edge       = 5, // two planes meet there
    stopped    = 6, // stopped in the middle of a plane
    other      = 7,
};
inline constexpr std::array<std::string_view, 8> wrong_cause_names = {
    "right", "own_surface", "not_shown", "thin", "silhouette", "edge", "stopped", "other"};

/// Returns the cause of each pixel. Throws Failure unless all sizes agree, InvalidResult for an impossible result.
std::vector<WrongCause> wrong_causes(const TraceImage& tested, const SceneTruth& truth, const GBufferImage& gbuffer);

/// Returns wrong_rays and the measures that begin with "wrong_".
MeasureValues count_causes(const TraceImage& tested, const SceneTruth& truth, const GBufferImage& gbuffer);

} // namespace ssrlab
