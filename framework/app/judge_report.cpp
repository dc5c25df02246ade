#include "app/judge_report.h"

#include "compare/causes.h"
#include "harness/experiment.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

constexpr size_t most_lines = 10; // of findings, in the table; JSON has all

std::string percent(const Record& measures, const std::string& column)
{
    const auto value = number_of(measures, column);
    return value ? fmt::format("{:.2f} %", 100 * *value) : "none";
}

/// The shares of the columns PREFIX + name + SUFFIX that are above 0.
std::string shares(const Record& measures, std::span<const std::string_view> names, std::string_view prefix,
                   std::string_view suffix)
{
    std::string text;
    for (const std::string_view name : names)
        if (const double share = number_of(measures, fmt::format("{}{}{}", prefix, name, suffix)).value_or(0);
            share > 0)
            text += fmt::format("{}{} {:.2f} %", text.empty() ? "" : ", ", name, 100 * share);
    return text.empty() ? "none" : text;
}

} // namespace

nlohmann::ordered_json json_of(const Judged& judged)
{
    nlohmann::ordered_json json{{"frame", judged.frame},
                                {"hits", judged.hits},
                                {"size_px", {judged.size_px.x, judged.size_px.y}},
                                {"settings", judged.settings},
                                {"rays", judged.judgement.rays},
                                {"answers_of_other_pixels", judged.judgement.ignored},
                                {"wrong", judged.judgement.wrong()},
                                {"by_contract", nlohmann::ordered_json::object()},
                                {"f1_truth", judged.has_scene ? "scene" : "screen"},
                                {"f1", nullptr},
                                {"hints", judged.judgement.advice},
                                {"measures", nlohmann::ordered_json::object()},
                                {"findings", nlohmann::ordered_json::array()}};
    if (judged.f1) json["f1"] = *judged.f1;
    for (size_t i = 0; i < fault_names.size(); ++i)
        json["by_contract"][std::string(fault_names[i])] = judged.judgement.count[i];
    for (const auto& [column, value] : judged.measures)
        if (const auto number = number_of(judged.measures, column)) json["measures"][column] = *number;
    for (const Finding& finding : judged.judgement.findings)
        json["findings"].push_back({{"pixel", {finding.pixel.x, finding.pixel.y}},
                                    {"fault", fault_names[static_cast<size_t>(finding.fault)]},
                                    {"expected", finding.expected},
                                    {"got", finding.got},
                                    {"why", finding.why}});
    return json;
}

std::string fault_counts(const FrameJudgement& judgement)
{
    std::string text;
    for (size_t i = static_cast<size_t>(Fault::impossible); i < fault_names.size(); ++i)
        if (judgement.count[i] > 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", fault_names[i], judgement.count[i]);
    return text.empty() ? "" : fmt::format(" ({})", text);
}

void print_findings(const std::vector<Finding>& findings)
{
    for (size_t i = 0; i < std::min(findings.size(), most_lines); ++i) {
        const Finding& found = findings[i];
        std::puts(fmt::format("  ({}, {}) {}: got {}; expected {}", found.pixel.x, found.pixel.y,
                              fault_names[static_cast<size_t>(found.fault)], found.got, found.expected)
                      .c_str());
        if (!found.why.empty()) std::puts(fmt::format("    {}", found.why).c_str());
    }
    if (findings.size() > most_lines)
        std::puts(fmt::format("  and {} more; --json lists all", findings.size() - most_lines).c_str());
}

void print(const Judged& judged)
{
    const FrameJudgement& judgement = judged.judgement;
    const Record&         m         = judged.measures;
    std::puts(fmt::format("{} of {}, {}: {} rays{}{}", judged.hits, judged.frame, size_text(judged.size_px),
                          judgement.rays, judged.settings.empty() ? "" : "; ", fmt::join(judged.settings, " "))
                  .c_str());
    if (judgement.ignored > 0)
        std::puts(
            fmt::format("ignored: {} answers of pixels that do not reflect under these settings", judgement.ignored)
                .c_str());
    std::puts(fmt::format("ends: {}", shares(m, trace_status_names, "", "_share")).c_str());
    std::puts(fmt::format("hit contract: {} right, {} near ties, {} wrong{}", judgement.of(Fault::right),
                          judgement.of(Fault::near_tie), judgement.wrong(), fault_counts(judgement))
                  .c_str());
    print_findings(judgement.findings);
    for (const std::string& advice : judgement.advice) std::puts(("hint: " + advice).c_str());
    const auto line = [&](const char* truth, const char* prefix) {
        std::puts(
            fmt::format("{}: recall {}, precision {}, F1 {}", truth, percent(m, fmt::format("{}recall_1px", prefix)),
                        percent(m, fmt::format("{}precision_1px", prefix)), percent(m, fmt::format("{}f1_1px", prefix)))
                .c_str());
    };
    line("screen truth", "screen_");
    if (!judged.has_scene) return;
    line("scene truth", "");
    std::puts(fmt::format("wrong rays: {}; by cause: {}", percent(m, "wrong_rays"),
                          shares(m, wrong_cause_names, "wrong_", ""))
                  .c_str());
}

} // namespace ssrlab
