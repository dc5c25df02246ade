#include "app/fit_report.h"

#include "core/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace ssrlab {
namespace {

/// The values of what differs between the settings that were tried; of parameters, between those of its technique.
std::string setting_text(const FitReport& report, const Run& run)
{
    std::string text = run.technique;
    for (const Setting& setting : report.known) {
        const double value = setting.get(run.settings);
        if (std::ranges::any_of(report.tried, [&](const Tried& one) { return setting.get(one.run.settings) != value; }))
            text += fmt::format(" {}={}", setting.name, format_parameter(setting, value));
    }
    for (const Parameter& parameter : std::ranges::find(report.techniques, run.technique, &Technique::id)->parameters) {
        const double value  = run.values.at(parameter.name);
        const auto   varies = [&](const Tried& one) {
            return one.run.technique == run.technique && one.run.values.at(parameter.name) != value;
        };
        if (std::ranges::any_of(report.tried, varies))
            text += fmt::format(" {}={}", parameter.name, format_parameter(parameter, value));
    }
    return text;
}

std::string row_text(const FitReport& report, const std::string& label, const Tried* tried)
{
    if (tried == nullptr) return fmt::format("{:<22} nothing is within it", label);
    const auto pictures = every_picture(report);
    return fmt::format("{:<22} {:<8.4f} {:<14.4g} {}", label, quality_on(*tried, pictures), cost_on(*tried, pictures),
                       setting_text(report, tried->run));
}

std::string share_label(const FitReport& report, double share)
{
    return fmt::format("{:.4g} {}", share * report.budget, unit_text(report.goal.unit));
}

/// In points: of F1, or of FLIP times 100.
double lost_points(const FitReport& report, const LeftOut& one)
{
    const double lost = one.best->quality[one.picture] - one.fitted->quality[one.picture];
    return 100 * (report.goal.picture ? -lost : lost);
}

std::string left_out_row(const FitReport& report, const LeftOut& one, double share)
{
    const Run&  picture = report.pictures[one.picture];
    std::string row =
        fmt::format("| {} | {} | {:.4g} |", printable(picture.scene), printable(picture.view), share * report.budget);
    if (one.fitted == nullptr || one.best == nullptr) return row + " nothing within | | | | |\n";
    return row + fmt::format(" {} | {:.2f} | {:.2f} | {:.2f} | {:.4g} |\n", setting_text(report, one.fitted->run),
                             100 * one.fitted->quality[one.picture], 100 * one.best->quality[one.picture],
                             lost_points(report, one), one.fitted->cost[one.picture]);
}

} // namespace

std::vector<size_t> every_picture(const FitReport& report)
{
    std::vector<size_t> pictures(report.pictures.size());
    std::iota(pictures.begin(), pictures.end(), size_t(0));
    return pictures;
}

void print_fit(const FitReport& report, const Fit& fit)
{
    const auto pictures = every_picture(report);
    const auto within   = [&](double share) {
        const Fit other = fit_within(report.tried, pictures, share * report.budget, report.goal);
        return row_text(report, share_label(report, share), other.best);
    };
    std::puts(fmt::format("{} settings on {} picture{}; the cost is that of the dearest picture", report.tried.size(),
                          pictures.size(), pictures.size() == 1 ? "" : "s")
                  .c_str());
    std::puts(fmt::format("{:<22} {:<8} {:<14} {}", "budget", report.goal.picture ? "FLIP" : "F1",
                          unit_text(report.goal.unit), "setting")
                  .c_str());
    std::puts(row_text(report, share_label(report, 1), fit.best).c_str());
    if (fit.runner_up != nullptr) std::puts(row_text(report, "runner-up", fit.runner_up).c_str());
    std::puts(within(0.5).c_str());
    std::puts(within(2).c_str());
}

std::string leave_one_out_text(const FitReport& report)
{
    const char* quality = report.goal.picture ? "FLIP" : "F1";
    std::string rows, summary;
    for (const double share : fit_shares) {
        const double        budget = share * report.budget;
        std::vector<double> lost; // of those within the budget
        size_t              views = 0, over = 0;
        for (const LeftOut& one : leave_one_out(report.tried, report.pictures, budget, report.goal)) {
            ++views;
            rows += left_out_row(report, one, share);
            if (one.fitted == nullptr || one.best == nullptr) continue;
            if (one.fitted->cost[one.picture] > budget)
                ++over;
            else
                lost.push_back(lost_points(report, one));
        }
        const double sum = std::accumulate(lost.begin(), lost.end(), 0.0);
        summary += fmt::format("| {:.4g} | {} | {} | {} | {} |", budget, views,
                               std::ranges::count_if(lost, [](double points) { return points <= 1; }), over,
                               views - over - lost.size());
        summary += lost.empty() ? " | |\n"
                                : fmt::format(" {:.2f} | {:.2f} |\n", sum / static_cast<double>(lost.size()),
                                              *std::ranges::max_element(lost));
    }
    return fmt::format("| budget, {} | views | within it and at most 1 point lost | over it | nothing within it | mean "
                       "loss within it | largest |\n| --: | --: | --: | --: | --: | --: | --: |\n{}\n"
                       "| scene | view left out | budget | fitted to the others | its {} | best {} of the view | "
                       "points lost | its {} |\n| --- | --- | --: | --- | --: | --: | --: | --: |\n{}",
                       unit_text(report.goal.unit), summary, quality, quality, unit_text(report.goal.unit), rows);
}

} // namespace ssrlab
