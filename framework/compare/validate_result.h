// Can this be an answer? Asked of what the device returned, before anything is measured by it.
#pragma once

#include "core/error.h"
#include "core/trace_result.h"

#include <limits>
#include <optional>
#include <string>

namespace ssrlab {

/// One ray's answer, as the tracer stored it. Where its status is `impossible`, `steps` is the status that the technique
/// returned, and hit_pixel its pixel.
struct Answer {
    TraceStatus status = TraceStatus::not_traced;
    glm::ivec2  hit_pixel{0, 0};
    double      t     = 0;
    uint32_t    steps = 0;
};

/// What is impossible in it: an unknown status, a pixel off the image, t outside [0, 1], too many steps. Empty: nothing.
std::string impossible(const Answer& answer, glm::ivec2 size_px, double most_steps);

/// A result holds answers that cannot be: nothing may be measured by it.
struct InvalidResult : Failure {
    using Failure::Failure;
};

/// How many rays of a result have an impossible answer, and the first of them; empty: none.
std::optional<std::string> find_impossible(const TraceResult& result, double most_steps);

/// Throws InvalidResult with what find_impossible() says. Without a bound on steps: what makes a result safe to index with.
void require_possible(const TraceResult& result, double most_steps = std::numeric_limits<double>::infinity());

} // namespace ssrlab
