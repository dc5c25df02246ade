// What ssrlab fit prints.
#pragma once

#include "harness/fit.h"

namespace ssrlab {

/// Shares of the budget of which the best setting is named.
inline constexpr double fit_shares[] = {1, 0.5, 2};

struct FitReport {
    std::span<const Run>       pictures;
    std::span<const Tried>     tried;
    std::span<const Setting>   known;
    std::span<const Technique> techniques;
    FitGoal                    goal;
    double                     budget;
};

/// Returns 0, 1, 2 … for each picture.
std::vector<size_t> every_picture(const FitReport& report);

/// Prints the choice, its runner-up, and the choices of half and double the budget.
void print_fit(const FitReport& report, const Fit& fit);

/// Returns a Markdown table with a row for each picture and share of the budget: what was fitted to the scene's other
/// pictures against the best of this picture.
std::string leave_one_out_text(const FitReport& report);

} // namespace ssrlab
