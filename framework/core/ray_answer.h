// What is known of a reflected ray: the point that it meets, that it meets nothing, or how far it was followed in vain.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace ssrlab {

enum class AnswerKind : uint8_t {
    not_traced = 0, // the pixel has no ray
    open       = 1, // no answer
    point      = 2, // meets geometry at RayAnswer::point_ws
    nothing    = 3, // meets no geometry within the maximum distance
    light      = 4, // what it brings back is guessed; where it ends is not known
};

struct RayAnswer {
    AnswerKind kind    = AnswerKind::not_traced;
    bool       certain = false; // the source vouches for it; an open answer is never certain
    uint8_t    source  = 0;     // place in the list of the source that said it
    double     clear_m = 0;     // from the reflecting point on, the ray is known to meet nothing before this distance
    glm::dvec3 point_ws{0};     // undefined unless `point`; of `light`: the place whose distance blurs it
    glm::vec3  light{0};        // linear radiance that the ray brings back; undefined where the answer is open

    bool operator==(const RayAnswer&) const = default;
};

/// One source's turn: the rays that it was asked about and what it said, entry by entry.
struct SourceTurn {
    std::string            source; // its id
    std::vector<size_t>    pixels; // of the rays
    std::vector<RayAnswer> answers;
    double                 draw_ms     = 0; // drawing what the source traces in
    double                 trace_ms    = 0; // deriving structures and tracing
    double                 shade_ms    = 0; // light of what was met, where no G-buffer holds it
    double                 bounces_ms  = 0; // following what reflects there
    double                 merge_ms    = 0; // choosing the rays and merging the answers
    double                 megabytes   = 0; // of device memory that the frame alone does not need
    uint64_t               node_visits = 0; // of a hierarchy of triangles; 0: it has none
};

/// The answer of one pixel's ray after one more source was asked: what is certain stands, and so does an uncertain
/// point until a certain answer or another point comes. "Meets nothing" and light without a point fill open answers.
inline RayAnswer merged(const RayAnswer& before, const RayAnswer& added)
{
    if (before.certain || added.kind == AnswerKind::not_traced) return before;
    if (added.certain || added.kind == AnswerKind::point) return added;
    RayAnswer result = before.kind == AnswerKind::open && added.kind != AnswerKind::open ? added : before;
    result.clear_m   = before.clear_m > added.clear_m ? before.clear_m : added.clear_m;
    return result;
}

} // namespace ssrlab
