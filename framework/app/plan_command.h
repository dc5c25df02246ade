// ssrlab plan: which passes a frame needs, why, and what they cost or save.
#pragma once

#include "app/commands.h"

namespace ssrlab {

struct PlanOptions {
    PictureOptions picture;
    int            repeats        = 9; // timed frames, of the planned and the unculled frame in turn
    double         bandwidth_gbps = 0; // of a card's memory; 0: not given
};

/// Fails (1) when the planned image differs from the unculled one.
int print_plan(const CommonOptions& common, const PlanOptions& options);

} // namespace ssrlab
