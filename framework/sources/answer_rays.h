// The loop over sources: each source gets the rays that have no certain answer yet, and its answers are merged into
// the earlier ones.
#pragma once

#include "sources/source.h"

namespace ssrlab {

/// Which rays the next source gets.
enum class HandOn : uint8_t {
    lost,      // those without an answer
    uncertain, // also those whose answer no source vouches for
};
inline constexpr std::array<std::string_view, 2> hand_on_names = {"lost", "uncertain"};

struct AnsweredRays {
    std::vector<RayAnswer>  answers; // of each pixel
    std::vector<SourceTurn> turns;   // of each source
};

/// Returns a context without rays. Throws Failure for a frame file, which has no scene.
SourceContext make_source_context(Stage& stage, const LabPtr& lab);
/// Returns a context with the mirror rays of the shown frame, which is traced once for its counts; its time is the
/// median of three more frames. Throws likewise.
SourceContext make_source_context(Stage& stage, const Technique& technique, const ParameterValues& values,
                                  const FrameSettings& settings);

/// Answers the context's rays.
AnsweredRays answer_rays(SourceContext& context, std::span<const ListedSource> sources, HandOn hand_on);

} // namespace ssrlab
