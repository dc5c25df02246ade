#include "harness/search.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace ssrlab {
namespace {

/// A setting along a line, and how good it is by one measure.
struct Point {
    const Run* run;
    double     value, measured;
};

/// Halfway by ratio; nothing when there is no place between the two that is worth a run.
std::optional<double> halfway(const Parameter& parameter, double a, double b)
{
    const double low = std::min(a, b), high = std::max(a, b);
    if (low <= 0 || high / low <= search_ratio) return std::nullopt;
    double middle = std::sqrt(low * high);
    if (parameter.type == ParameterType::integer) {
        middle = std::round(middle);
    } else {
        const double unit = std::pow(10, std::floor(std::log10(middle)) - 2); // three digits say it
        middle            = std::round(middle / unit) * unit;
    }
    return middle > low && middle < high ? std::optional(middle) : std::nullopt;
}

/// The first neighbours, from the cheap end, of which one misses the target and the next reaches it.
std::optional<std::pair<Point, Point>> crossing(std::span<const Point> line, double target, bool higher_is_better)
{
    const auto reaches = [&](const Point& point) {
        return higher_is_better ? point.measured >= target : point.measured <= target;
    };
    const auto first = std::ranges::find_if(line, reaches);
    if (first == line.begin() || first == line.end()) return std::nullopt;
    return std::pair{*(first - 1), *first};
}

/// Runs by all that they are but the value of one parameter.
std::map<std::string, std::vector<const Run*>> lines_of(std::span<const Run> runs, const Technique& technique,
                                                        const std::string& parameter)
{
    std::map<std::string, std::vector<const Run*>> lines;
    for (const Run& run : runs) {
        if (run.technique != technique.id) continue;
        Run line = run;
        line.values.erase(parameter);
        lines[run_id(line)].push_back(&run);
    }
    return lines;
}

/// The run between two values of a line, or between those and what lies halfway, that has this id.
std::optional<Run> probe_between(const Run& line, const Parameter& parameter, double a, double b, const std::string& id)
{
    const auto value = halfway(parameter, a, b);
    if (!value) return std::nullopt;
    Run run                    = line;
    run.values[parameter.name] = *value;
    run.id                     = run_id(run);
    if (run.id == id) return run;
    if (auto found = probe_between(line, parameter, a, *value, id)) return found;
    return probe_between(line, parameter, *value, b, id);
}

} // namespace

std::span<const TargetMeasure> target_measures()
{
    static const std::vector<TargetMeasure> measures = {{"recall_1px", true},    {"precision_1px", true},
                                                        {"f1_1px", true},        {"screen_recall_1px", true},
                                                        {"screen_f1_1px", true}, {"flip_visible", false}};
    return measures;
}

std::vector<Run> next_probes(const Experiment& experiment, std::span<const Technique> techniques,
                             std::span<const Run> runs, const std::map<std::string, Record>& rows)
{
    std::set<std::string> tried;
    for (const Run& run : runs) tried.insert(run.id);
    std::vector<Run> probes;
    const auto       probe = [&](const Accuracy& accuracy, const Parameter& parameter, const Point& a, const Point& b) {
        const auto value = halfway(parameter, a.value, b.value);
        if (!value) return;
        Run run                        = *b.run;
        run.values[accuracy.parameter] = *value;
        run.id                         = run_id(run);
        run.number                     = static_cast<int>(runs.size() + probes.size());
        if (tried.insert(run.id).second) probes.push_back(std::move(run));
    };
    for (const Technique& technique : techniques) {
        for (const Accuracy& accuracy : technique.accuracy) {
            const Parameter& parameter = find_parameter(technique, accuracy.parameter, technique.id);
            for (const auto& [key, line] : lines_of(runs, technique, accuracy.parameter)) {
                for (const Target& target : experiment.targets) {
                    std::vector<Point> points;
                    for (const Run* run : line) {
                        const auto row      = rows.find(run->id);
                        const auto measured = row == rows.end() ? std::nullopt : number_of(row->second, target.measure);
                        if (measured) points.push_back({run, run->values.at(accuracy.parameter), *measured});
                    }
                    std::ranges::sort(points, {}, [&](const Point& point) {
                        return accuracy.higher_is_better ? point.value : -point.value;
                    });
                    for (const double value : target.values)
                        if (const auto found = crossing(points, value, target.higher_is_better))
                            probe(accuracy, parameter, found->first, found->second);
                }
            }
        }
    }
    return probes;
}

std::optional<Run> find_probe(std::span<const Technique> techniques, std::span<const Run> listed, const std::string& id)
{
    for (const Technique& technique : techniques)
        for (const Accuracy& accuracy : technique.accuracy) {
            const Parameter& parameter = find_parameter(technique, accuracy.parameter, technique.id);
            for (const auto& [key, line] : lines_of(listed, technique, accuracy.parameter)) {
                std::set<double> values;
                for (const Run* run : line) values.insert(run->values.at(parameter.name));
                for (auto low = values.begin(); low != values.end() && std::next(low) != values.end(); ++low)
                    if (auto found = probe_between(*line.front(), parameter, *low, *std::next(low), id)) return found;
            }
        }
    return std::nullopt;
}

} // namespace ssrlab
