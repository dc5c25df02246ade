// Judges every ray of a frame by the hit contract, whoever traced it.
#pragma once

#include "check/hit_files.h"
#include "core/gbuffer_image.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace ssrlab {

/// How an answer differs from the contract's: the first that applies.
enum class Fault : uint8_t {
    right        = 0,
    near_tie     = 1, // another answer, and rounding could decide every comparison that tells the two apart
    impossible   = 2, // not a valid answer: an unknown status, a hit off the image, in the start pixel or off its pixel
    unanswered   = 3, // the pixel reflects, and the file says that it was not traced
    out_of_steps = 4,
    missed       = 5, // no hit where the ray hits
    false_hit    = 6, // a hit where the ray hits nothing
    too_early    = 7, // a hit before the right one
    too_late     = 8, // a hit behind the right one
    other_end    = 9, // rightly no hit, but with another status
};
inline constexpr std::array<std::string_view, 10> fault_names = {"right",        "near_tie", "impossible", "unanswered",
                                                                 "out_of_steps", "missed",   "false_hit",  "too_early",
                                                                 "too_late",     "other_end"};

/// A ray that is neither right nor a near tie.
struct Finding {
    glm::ivec2  pixel{0, 0};
    Fault       fault = Fault::right;
    std::string expected, got;
    std::string why; // may be empty
};

struct FrameJudgement {
    size_t                                 rays    = 0; // pixels that reflect under these settings
    size_t                                 ignored = 0; // answers of other pixels
    std::array<size_t, fault_names.size()> count{};     // of rays
    std::vector<Finding>                   findings;    // row by row
    std::vector<std::string>               advice;      // conventions of the file that would make most hits right
    TraceImage                             usable;      // the answers; an impossible one is a ray without a hit
    size_t                                 of(Fault fault) const { return count[static_cast<size_t>(fault)]; }
    /// Rays that are neither right nor a near tie.
    size_t wrong() const { return rays - of(Fault::right) - of(Fault::near_tie); }
};

/// Judges every ray. The G-buffer must have gradients if the surface needs them. Throws SpecError for a surface model
/// without a screen truth, and for `layers` above 1, which a frame file does not hold.
FrameJudgement judge_frame(const GBufferImage& gbuffer, const TraceSettings& settings, const HitsFile& hits);

} // namespace ssrlab
