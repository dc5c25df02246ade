// "12 of 84 runs, yard default 1280x720, 0:42 so far, about 3:10 left" on stderr, seldom enough to read.
#pragma once

#include "core/stopwatch.h"
#include "harness/experiment.h"

#include <optional>
#include <set>
#include <string>

namespace ssrlab {

/// Roughly, on two CPU cores without a GPU: enough to say minutes from hours before anything was measured.
double estimated_seconds(const Run& run, const Technique& technique, const MeasureSettings& measure);

std::string duration_text(double seconds); // "3:07", "1:02:09"

class Progress {
public:
    /// `total_cost`: the sum of estimated_seconds over all runs to do; the time left scales with what is left of it.
    Progress(size_t total_runs, double total_cost, bool quiet = false);

    /// More runs than were known: a search tries further settings.
    void add_runs(size_t count, double cost);
    void start_picture(const std::string& what);
    /// Everything but the timed repeats is done.
    void prepared_run(const std::string& id, double cost);
    void finish_run(const std::string& id, double cost);
    /// Says where we are if the last line is old enough.
    void tick();
    /// A line that is never swallowed.
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
