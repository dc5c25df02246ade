// The source `auto`: the list that answers most rays rightly within a budget, by a measurement of this frame on this
// device.
#pragma once

#include "sources/answer_rays.h"

namespace ssrlab {

struct ChosenSources {
    std::vector<ListedSource> list;
    std::string               reason;          // with the numbers that decided; empty if the list was given
    double                    choosing_ms = 0; // of that measurement
};

/// What one list costs and answers.
struct MeasuredList {
    std::string text;
    double      ms    = 0; // drawing the frame, and its sources
    double      right = 0; // F1 over all rays, 0 to 1, by what the triangles answer
};

/// Returns the index of the list with most right answers among those within the budget, the cheaper of two that are
/// equal within 0.1 points; of the cheapest list if none is. Throws std::logic_error without lists.
size_t best_within(std::span<const MeasuredList> lists, double budget_ms);

/// Returns the list itself or, for `auto`, one that was chosen: candidates are asked about all rays of the context, and
/// the triangles' answers say how many are right. The budget is budget_ms or, if that is 0, `share` times the frame's
/// own drawing and trace.
ChosenSources choose_sources(SourceContext& context, std::span<const ListedSource> list, HandOn hand_on);

} // namespace ssrlab
