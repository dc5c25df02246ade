// The check's table, for people and for the reference results.
#pragma once

#include "check/run_case.h"

namespace ssrlab {

/// One line each, aligned; head() names the columns.
std::string table_head();
std::string table_line(const CaseRow& row);
/// The findings of a row that breaks a claim, each with the command that shows it.
std::string table_findings(const CaseRow& row);

/// The whole table as Markdown, without times: the same bytes on every run.
std::string markdown_table(const std::vector<CaseRow>& rows);

} // namespace ssrlab
