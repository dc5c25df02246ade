// Validates what the device returned before anything is measured by it.
#pragma once

#include "core/error.h"
#include "core/trace_image.h"

#include <limits>
#include <optional>
#include <string>

namespace ssrlab {

/// The answer of one ray, as the tracer stored it. If its status is `impossible`, `steps` holds the status that the
/// technique returned, and hit_pixel its pixel.
struct Answer {
    TraceStatus status = TraceStatus::not_traced;
    glm::ivec2  hit_pixel{0, 0};
    double      t     = 0;
    uint32_t    steps = 0;
};

/// Returns what is impossible (status, pixel off the image, t, number of steps); empty: nothing.
std::string impossible(const Answer& answer, glm::ivec2 size_px, double most_steps);

/// The result holds impossible answers, so nothing may be measured by it.
struct InvalidResult : Failure {
    using Failure::Failure;
};

/// Returns how many rays have an impossible answer, and the first of them; nullopt if none has.
std::optional<std::string> find_impossible(const TraceImage& result, double most_steps);

/// Throws InvalidResult with the text of find_impossible(), if any. Without a bound, checks only what indexing needs.
void require_possible(const TraceImage& result, double most_steps = std::numeric_limits<double>::infinity());

} // namespace ssrlab
