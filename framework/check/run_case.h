// Runs one technique on one hard case: judges every ray, invariant and relation.
#pragma once

#include "check/hard_case.h"
#include "check/judge.h"

namespace ssrlab {

/// A row of the table.
struct CaseRow {
    std::string family, case_name, technique;
    size_t      rays     = 0;
    size_t      findable = 0, found = 0; // rays that hit something, exactly; and of these, found within a pixel
    size_t      wrong = 0, slivers = 0, allowed = 0; // of rays; slivers: near ties; allowed: by the declared limits
    double      worst_deviation_px = 0;
    size_t      non_finite = 0, out_of_steps = 0;
    uint32_t    most_steps            = 0;
    size_t      precision_changes     = 0; // rays whose status or pixel differ between float and double
    double      seconds               = 0;
    uint64_t    digest                = 0;  // of all outcomes, to compare runs
    size_t      breaks                = 0;  // claims broken: wrong rays, invariants, relations
    std::vector<std::string> findings = {}; // the first few, each naming its setup and ray
};

struct CheckOptions {
    bool double_precision = true; // fill precision_changes
};

CaseRow run_case(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const ParameterValues& values,
                 const std::string& family, const HardCase& hard_case, const CheckOptions& options = {});

/// Returns only the digest that run_case() would give.
uint64_t digest_of(Gpu& gpu, const Catalogue& catalogue, const Technique& technique, const ParameterValues& values,
                   const HardCase& hard_case);

/// Describes a ray: its numbers, its pixels, what the technique said and what is right.
std::string describe_ray(Gpu& gpu, const Catalogue& catalogue, const Technique& technique,
                         const ParameterValues& values, const HardCase& hard_case, size_t setup, size_t ray);

} // namespace ssrlab
