#include "check/run_check.h"

#include "core/error.h"
#include "core/names.h"

#include <map>

namespace ssrlab {

const HardCase& find_case(const std::string& name)
{
    std::vector<std::string> known;
    for (const CaseFamily& family : hard_cases())
        for (const HardCase& hard_case : family.cases) {
            if (hard_case.name == name) return hard_case;
            known.push_back(hard_case.name);
        }
    throw SpecError(unknown_name("hard case", name, known));
}

std::vector<CaseRow> run_check(Gpu& gpu, Gpu* robust, const CheckRequest& request,
                               const std::function<void(const CaseRow&)>& on_row)
{
    if (!request.only_case.empty()) find_case(request.only_case);
    std::vector<CaseRow> rows;
    for (const CaseFamily& family : hard_cases())
        for (const HardCase& hard_case : family.cases) {
            if (!request.only_case.empty() && hard_case.name != request.only_case) continue;
            for (size_t i = 0; i < request.techniques.size(); ++i) {
                const Technique&      technique = request.techniques[i];
                const ParameterValues values =
                    request.values.empty() ? default_values(technique) : request.values.at(i);
                const std::string missing = missing_feature(gpu, technique, adjusted(hard_case, technique, values));
                if (!missing.empty()) {
                    on_row({.family    = family.name,
                            .case_name = hard_case.name,
                            .technique = technique.id,
                            .findings  = {"left out: " + missing}});
                    continue;
                }
                CaseRow row =
                    run_case(gpu, request.catalogue, technique, values, family.name, hard_case, request.options);
                if (robust != nullptr &&
                    digest_of(*robust, request.catalogue, technique, values, hard_case) != row.digest) {
                    ++row.breaks;
                    row.findings.emplace_back(
                        "robust buffer access changes what rays find: something is read outside its bounds");
                }
                on_row(row);
                rows.push_back(row);
            }
        }
    return rows;
}

std::vector<std::string> check_finds(const std::vector<CaseRow>& rows)
{
    std::map<std::string, std::pair<size_t, size_t>> found_of; // and findable
    for (const CaseRow& row : rows) {
        found_of[row.technique].first += row.found;
        found_of[row.technique].second += row.findable;
    }
    std::vector<std::string> lines;
    for (const auto& [technique, count] : found_of)
        if (count.first == 0 && count.second > 0)
            lines.push_back(fmt::format("{} finds none of {} hits that are there", technique, count.second));
    return lines;
}

std::vector<std::string> check_refusals()
{
    std::vector<std::string> accepted;
    for (const CaseFamily& family : hard_cases())
        for (const RefusedCase& refused : family.refused) {
            try {
                refused.attempt();
                accepted.push_back(fmt::format("{} {}: was accepted", family.name, refused.name));
            } catch (const SpecError& error) {
                if (std::string(error.what()).find(refused.named) == std::string::npos)
                    accepted.push_back(fmt::format("{} {}: the message does not name {}: {}", family.name, refused.name,
                                                   refused.named, error.what()));
            }
        }
    return accepted;
}

} // namespace ssrlab
