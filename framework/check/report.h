// Tables of `ssrlab check`.
#pragma once

#include "check/run_case.h"

namespace ssrlab {

/// One aligned line each; table_head() names the columns.
std::string table_head();
std::string table_line(const CaseRow& row);
/// Returns the findings of a row that breaks a claim, each with the command that shows it.
std::string table_findings(const CaseRow& row);

/// Returns the whole table as Markdown, without times, so the bytes are equal in every run.
std::string markdown_table(const std::vector<CaseRow>& rows);

} // namespace ssrlab
