// ssrlab fit: the setting that is best within a budget on given pictures.
#pragma once

#include "app/commands.h"

#include <optional>

namespace ssrlab {

struct FitOptions {
    std::vector<std::string> scenes, views;          // no view: all of each scene
    std::vector<int>         frames = {0};           // of the scenes' motion
    std::vector<std::string> techniques, parameters; // narrow the sweep: techniques, and name=value
    std::string              size;                   // WIDTHxHEIGHT; empty: that of the sweep
    std::string              sweep;                  // an experiment; empty: experiments/fit_OBJECTIVE.toml
    std::string              objective = "f1";       // or flip
    std::string              output    = "results/fit";
    std::string              command_line;
    std::optional<double>    budget_ms, budget_fetches, budget_instructions; // one of them
    std::string              chip; // whose instructions; empty: the budget is in another unit
    bool                     resume = false, leave_one_out = false;
};

/// Measures the sweep into folders below `output`, prints the choice, and writes it as choice.toml. Returns 1 if a
/// run failed, 128 + signal if it was stopped. Throws SpecError if nothing is within the budget.
int fit_to_budget(const CommonOptions& common, const FitOptions& options);

} // namespace ssrlab
