// ssrlab plan: which passes a picture needs, why, and what they cost or save.
#pragma once

#include "app/commands.h"

namespace ssrlab {

struct PlanOptions {
    PictureOptions picture;
    int            repeats = 9; // timed frames, planned and with everything on in turn
};

/// Fails (1) when the planned picture differs from the one with everything on.
int print_plan(const CommonOptions& common, const PlanOptions& options);

} // namespace ssrlab
