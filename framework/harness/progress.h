// Progress on stderr: "12 of 84 runs, yard default 1280x720, 0:42 so far, about 3:10 left".
#pragma once

#include "core/stopwatch.h"
#include "harness/experiment.h"

#include <optional>
#include <set>
#include <string>

namespace ssrlab {

/// Returns a rough estimate for two CPU cores without a GPU: enough to tell minutes from hours.
double estimated_seconds(const Run& run, const Technique& technique, const MeasureSettings& measure);

std::string duration_text(double seconds); // "3:07", "1:02:09"

class Progress {
public:
    /// `total_cost`: the sum of estimated_seconds() over all runs to do; the time left is scaled by it.
    Progress(size_t total_runs, double total_cost, bool quiet = false);

    /// Adds runs that a search tries.
    void add_runs(size_t count, double cost);
    void start_picture(const std::string& what);
    /// Call when only the timed repeats of a run are left.
    void prepared_run(const std::string& id, double cost);
    void finish_run(const std::string& id, double cost);
    /// Prints a line if the last one is old enough.
    void tick();
    /// Prints a line in any case.
    void say(const std::string& line);

private:
    void print();

    size_t                   total_runs_, done_runs_ = 0;
    double                   total_cost_, done_cost_ = 0;
    std::string              picture_;
    std::set<std::string>    prepared_; // runs that are not finished
    bool                     in_place_, quiet_;
    Stopwatch                since_start_;
    std::optional<Stopwatch> since_print_; // empty before the first line
};

} // namespace ssrlab
