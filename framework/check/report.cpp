#include "check/report.h"

#include "core/error.h"

namespace ssrlab {

std::string table_head()
{
    return fmt::format(
        "{:<10} {:<28} {:<16} {:>7} {:>8} {:>7} {:>6} {:>9} {:>7} {:>10} {:>10} {:>12} {:>10} {:>14} {:>7}", "family",
        "case", "technique", "rays", "findable", "found", "wrong", "near ties", "allowed", "worst px", "non-finite",
        "out of steps", "most steps", "float≠double", "seconds");
}

std::string table_line(const CaseRow& row)
{
    return fmt::format("{:<10} {:<28} {:<16} {:>7} {:>8} {:>7} {:>6} {:>9} {:>7} {:>10.3f} {:>10} {:>12} {:>10} {:>12} "
                       "{:>7.2f}{}",
                       row.family, row.case_name, row.technique, row.rays, row.findable, row.found, row.wrong,
                       row.slivers, row.allowed, row.worst_deviation_px, row.non_finite, row.out_of_steps,
                       row.most_steps, row.precision_changes, row.seconds, row.breaks > 0 ? "  FAILS" : "");
}

std::string table_findings(const CaseRow& row)
{
    std::string text;
    for (const std::string& finding : row.findings) text += fmt::format("    {}\n", finding);
    if (row.breaks > row.findings.size()) text += fmt::format("    … and {} more\n", row.breaks - row.findings.size());
    if (row.breaks > 0)
        text += fmt::format("    look: ssrlab check {} --case {} --ray SETUP:RAY\n", row.technique, row.case_name);
    return text;
}

std::string markdown_table(const std::vector<CaseRow>& rows)
{
    std::string text =
        "| family | case | technique | rays | findable | found | wrong | near ties | allowed | worst deviation "
        "px | non-finite | out of steps | most steps | float ≠ double | claims |\n"
        "|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|---|\n";
    for (const CaseRow& row : rows)
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {:.3f} | {} | {} | {} | {} | {} |\n",
                            row.family, row.case_name, row.technique, row.rays, row.findable, row.found, row.wrong,
                            row.slivers, row.allowed, row.worst_deviation_px, row.non_finite, row.out_of_steps,
                            row.most_steps, row.precision_changes,
                            row.breaks > 0 ? fmt::format("{} broken", row.breaks) : "hold");
    return text;
}

} // namespace ssrlab
