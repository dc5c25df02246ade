// The whole catalogue, technique by technique.
#pragma once

#include "check/run_case.h"

namespace ssrlab {

struct CheckRequest {
    std::vector<Technique>       techniques;
    std::string                  only_case; // empty: all
    CheckOptions                 options;
    std::vector<ParameterValues> values = {}; // of each technique; empty: defaults
};

/// Calls `on_row` after each case. With a `robust` device (robust buffer access on), its answers must be the same bits.
/// Throws SpecError for a case that does not exist.
std::vector<CaseRow> run_check(Gpu& gpu, Gpu* robust, const CheckRequest& request,
                               const std::function<void(const CaseRow&)>& on_row);

/// A line for each technique that finds nothing in all these rows of what there is: limits allow to miss, but not everything.
std::vector<std::string> check_finds(const std::vector<CaseRow>& rows);

/// Attempts what must be refused; a line for each that was not.
std::vector<std::string> check_refusals();

const HardCase& find_case(const std::string& name);

} // namespace ssrlab
