// The best setting within a budget, of those that a sweep measured.
#pragma once

#include "harness/experiment.h"
#include "harness/record.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// The unit of a budget. Fetches and instructions are those per ray of the setting with the most rays.
enum class FitUnit : uint8_t { ms, fetches, instructions };
/// "fetches a ray"
const char* unit_text(FitUnit unit);

/// What is judged and what is paid, as columns of results.csv.
struct FitGoal {
    bool picture = false; // FLIP of the picture, and the time of all passes after the G-buffer; else F1, and the time
                          // of structures and trace
    FitUnit unit = FitUnit::fetches; // instructions: the column "instructions" (chip_cost.h)
};

/// A setting and what was measured, by picture. A picture is named by any run on it.
struct Tried {
    Run                 run; // on the first picture
    std::vector<double> quality, cost;
};

/// Returns the run with the scene, view, size and frame of `picture`, and its id.
Run on_picture(Run run, const Run& picture);

/// Returns the pictures on which some setting has a quality. `rows`: by run id.
std::vector<Run> judged_pictures(std::span<const Run> pictures, std::span<const Run> settings,
                                 const std::map<std::string, Record>& rows, const FitGoal& goal);

/// Returns the settings that have quality and cost on every picture, in their order.
std::vector<Tried> tried_on(std::span<const Run> pictures, std::span<const Run> settings,
                            const std::map<std::string, Record>& rows, const FitGoal& goal);

/// Returns the mean over these pictures (indices into Tried::quality).
double quality_on(const Tried& tried, std::span<const size_t> pictures);
/// Returns the largest of these pictures.
double cost_on(const Tried& tried, std::span<const size_t> pictures);

/// `best` is null if nothing is within the budget, `runner_up` if no other technique is.
struct Fit {
    const Tried *best = nullptr, *runner_up = nullptr;
};

/// Returns the setting of the best quality whose cost is within the budget on each of these pictures; among equals the
/// cheapest, then the first. The runner-up is the best setting of another technique.
Fit fit_within(std::span<const Tried> tried, std::span<const size_t> pictures, double budget, const FitGoal& goal);

/// The same; throws SpecError with the cheapest setting if nothing is within the budget.
Fit require_fit(std::span<const Tried> tried, std::span<const size_t> pictures, double budget, const FitGoal& goal);

/// Returns runs on the first picture, to be tried next: those that next_probes() (search.h) finds where the cost of a
/// line crosses the budget, and the setting beyond is better than the best within. A technique that declares no
/// accuracy is turned by the steps that bound it.
std::vector<Run> next_tries(std::span<const Technique> techniques, std::span<const Tried> tried, double budget,
                            const FitGoal& goal);

/// A picture that a fit did not see: what was fitted to the others, and what is best on it. Null if nothing is within.
struct LeftOut {
    size_t       picture = 0;
    const Tried *fitted = nullptr, *best = nullptr;
};

/// Fits to all pictures of each scene but one, for each picture of scenes with two or more.
std::vector<LeftOut> leave_one_out(std::span<const Tried> tried, std::span<const Run> pictures, double budget,
                                   const FitGoal& goal);

} // namespace ssrlab
