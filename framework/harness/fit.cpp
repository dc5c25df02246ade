#include "harness/fit.h"

#include "core/error.h"
#include "harness/search.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>

namespace ssrlab {
namespace {

const Record* find_row(const std::map<std::string, Record>& rows, const Run& run)
{
    const auto row = rows.find(run.id);
    return row == rows.end() ? nullptr : &row->second;
}

/// A frame of another renderer has no triangles: its hits are judged by what its depth allows.
std::optional<double> quality_of(const Record& row, const Run& picture, const FitGoal& goal)
{
    if (goal.picture) return number_of(row, "picture_flip");
    return number_of(row, is_frame(picture.scene) ? "screen_f1_1px" : "f1_1px");
}

std::optional<double> sum_of(const Record& row, std::span<const char* const> columns)
{
    double sum = 0;
    for (const char* column : columns) {
        const auto value = number_of(row, column);
        if (!value) return std::nullopt;
        sum += *value;
    }
    return sum;
}

std::optional<double> cost_of(const Record& row, double most_rays, const FitGoal& goal)
{
    constexpr const char* times[] = {"structures_ms_median", "trace_ms_median", "rays_ms_median", "shade_ms_median"};
    if (goal.unit == FitUnit::ms) return sum_of(row, std::span(times, goal.picture ? 4 : 2));
    const auto paid = number_of(row, goal.unit == FitUnit::fetches ? "fetches_mean" : "instructions");
    const auto rays = number_of(row, "rays");
    if (!paid || !rays || most_rays == 0) return std::nullopt;
    return *paid * *rays / most_rays;
}

double most_rays_on(const Run& picture, std::span<const Run> settings, const std::map<std::string, Record>& rows)
{
    double most = 0;
    for (const Run& setting : settings)
        if (const Record* row = find_row(rows, on_picture(setting, picture)))
            most = std::max(most, number_of(*row, "rays").value_or(0));
    return most;
}

std::vector<size_t> all_of(std::span<const Tried> tried)
{
    std::vector<size_t> pictures(tried.empty() ? 0 : tried.front().quality.size());
    std::iota(pictures.begin(), pictures.end(), size_t(0));
    return pictures;
}

} // namespace

const char* unit_text(FitUnit unit)
{
    return unit == FitUnit::ms ? "ms" : unit == FitUnit::fetches ? "fetches a ray" : "instructions a ray";
}

Run on_picture(Run run, const Run& picture)
{
    run.scene   = picture.scene;
    run.view    = picture.view;
    run.size_px = picture.size_px;
    run.at      = picture.at;
    run.id      = run_id(run);
    return run;
}

std::vector<Run> judged_pictures(std::span<const Run> pictures, std::span<const Run> settings,
                                 const std::map<std::string, Record>& rows, const FitGoal& goal)
{
    std::vector<Run> judged;
    for (const Run& picture : pictures)
        if (std::ranges::any_of(settings, [&](const Run& setting) {
                const Record* row = find_row(rows, on_picture(setting, picture));
                return row != nullptr && quality_of(*row, picture, goal);
            }))
            judged.push_back(picture);
    return judged;
}

std::vector<Tried> tried_on(std::span<const Run> pictures, std::span<const Run> settings,
                            const std::map<std::string, Record>& rows, const FitGoal& goal)
{
    std::vector<double> most_rays;
    for (const Run& picture : pictures) most_rays.push_back(most_rays_on(picture, settings, rows));
    std::vector<Tried> all;
    for (const Run& setting : settings) {
        Tried tried;
        for (size_t i = 0; i < pictures.size(); ++i) {
            const Run     run = on_picture(setting, pictures[i]);
            const Record* row = find_row(rows, run);
            if (row == nullptr) break;
            const auto quality = quality_of(*row, run, goal), cost = cost_of(*row, most_rays[i], goal);
            if (!quality || !cost) break;
            if (i == 0) tried.run = run;
            tried.quality.push_back(*quality);
            tried.cost.push_back(*cost);
        }
        if (!pictures.empty() && tried.cost.size() == pictures.size()) all.push_back(std::move(tried));
    }
    return all;
}

double quality_on(const Tried& tried, std::span<const size_t> pictures)
{
    double sum = 0;
    for (const size_t picture : pictures) sum += tried.quality[picture];
    return sum / static_cast<double>(pictures.size());
}

double cost_on(const Tried& tried, std::span<const size_t> pictures)
{
    double most = 0;
    for (const size_t picture : pictures) most = std::max(most, tried.cost[picture]);
    return most;
}

Fit fit_within(std::span<const Tried> tried, std::span<const size_t> pictures, double budget, const FitGoal& goal)
{
    // Smaller is better.
    const auto order = [&](const Tried& one) {
        return std::tuple(quality_on(one, pictures) * (goal.picture ? 1 : -1), cost_on(one, pictures));
    };
    const auto best = [&](const std::string& but_technique) {
        const Tried* found = nullptr;
        for (const Tried& one : tried) {
            if (cost_on(one, pictures) > budget || one.run.technique == but_technique) continue;
            if (found == nullptr || order(one) < order(*found)) found = &one;
        }
        return found;
    };
    Fit fit;
    fit.best = best("");
    if (fit.best != nullptr) fit.runner_up = best(fit.best->run.technique);
    return fit;
}

Fit require_fit(std::span<const Tried> tried, std::span<const size_t> pictures, double budget, const FitGoal& goal)
{
    if (tried.empty()) throw_failure("no setting could be measured on every picture; see 'message' in results.csv");
    const Fit fit = fit_within(tried, pictures, budget, goal);
    if (fit.best != nullptr) return fit;
    const Tried& cheapest =
        *std::ranges::min_element(tried, {}, [&](const Tried& one) { return cost_on(one, pictures); });
    throw_spec_error("no setting stays within {:.6g} {} on every picture; the cheapest, of {}, takes {:.6g}", budget,
                     unit_text(goal.unit), cheapest.run.technique, cost_on(cheapest, pictures));
}

std::vector<Run> next_tries(std::span<const Technique> techniques, std::span<const Tried> tried, double budget,
                            const FitGoal& goal)
{
    std::vector<Technique> turned(techniques.begin(), techniques.end());
    for (Technique& technique : turned)
        if (technique.accuracy.empty() && !technique.bounded_by.empty())
            technique.accuracy = {{technique.bounded_by.front(), true}};
    const std::vector<size_t> pictures = all_of(tried);
    const Fit                 fit      = fit_within(tried, pictures, budget, goal);
    const auto                promises = [&](const Tried& one) {
        if (cost_on(one, pictures) <= budget || fit.best == nullptr) return true;
        const double gain = quality_on(one, pictures) - quality_on(*fit.best, pictures);
        return goal.picture ? gain < 0 : gain > 0;
    };
    Experiment experiment;
    experiment.targets = {{"cost", {std::nextafter(budget, budget + 1)}}}; // reached: too dear
    std::vector<Run>              runs;
    std::map<std::string, Record> rows;
    for (const Tried& one : tried) {
        runs.push_back(one.run);
        if (promises(one)) rows[one.run.id] = {{"cost", cost_on(one, pictures)}};
    }
    return next_probes(experiment, turned, runs, rows);
}

std::vector<LeftOut> leave_one_out(std::span<const Tried> tried, std::span<const Run> pictures, double budget,
                                   const FitGoal& goal)
{
    std::vector<LeftOut> all;
    for (size_t left_out = 0; left_out < pictures.size(); ++left_out) {
        std::vector<size_t> others;
        for (size_t i = 0; i < pictures.size(); ++i)
            if (i != left_out && pictures[i].scene == pictures[left_out].scene) others.push_back(i);
        if (others.empty()) continue;
        const size_t own[] = {left_out};
        all.push_back(
            {left_out, fit_within(tried, others, budget, goal).best, fit_within(tried, own, budget, goal).best});
    }
    return all;
}

} // namespace ssrlab
