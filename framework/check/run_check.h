// Runs the whole catalogue, technique by technique.
#pragma once

#include "check/run_case.h"

namespace ssrlab {

struct CheckRequest {
    Catalogue                    catalogue;  // of what the techniques may use
    std::vector<Technique>       techniques; // that are checked
    std::string                  only_case;  // empty: all
    CheckOptions                 options;
    std::vector<ParameterValues> values = {}; // of each technique; empty: defaults
};

/// Calls `on_row` after each case. A `robust` device (robust buffer access) must give the same bits. Throws SpecError
/// for a case that does not exist.
std::vector<CaseRow> run_check(Gpu& gpu, Gpu* robust, const CheckRequest& request,
                               const std::function<void(const CaseRow&)>& on_row);

/// Returns a line for each technique that finds nothing in all rows although there is something to find.
std::vector<std::string> check_finds(const std::vector<CaseRow>& rows);

/// Attempts what must be refused. Returns a line for each attempt that was accepted.
std::vector<std::string> check_refusals();

const HardCase& find_case(const std::string& name);

} // namespace ssrlab
