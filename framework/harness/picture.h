// One frame of a scene on the device, and what a run's frames on it gave. Folder-internal.
#pragma once

#include "core/stopwatch.h"
#include "harness/measure_picture.h"

namespace ssrlab {

struct Picture {
    FrameBuffersPtr       buffers;
    double                gbuffer_ms = 0;
    int                   round      = 0; // of samples.csv
    glm::dvec2            jitter_px{0, 0};
    std::optional<Truths> truths;

    // The picture with the true reflections under the trace settings of the last run.
    std::optional<Reference> reference;
    TraceSettings            reference_for;
    std::string              reference_file; // relative to the results; empty: none was written
};

/// Loads and uploads a scene unless it is the one that is there.
Stage& stage_of(SweepContext& sweep, const std::string& scene);
/// Shows the run's picture on that stage.
Picture make_picture(SweepContext& sweep, const Run& run);

/// What a run's frames gave, before anything is said about it.
struct Observed {
    Image                        shaded;
    TraceResult                  counted;
    std::optional<TraceResult>   hidden, twin = {}; // the second layer's hits; the same trace in double
    std::vector<glm::vec2>       reprojection = {}; // empty: the pass did not run
    std::optional<HistoryCounts> history      = {}; // empty: the pass did not run
};

/// Runs a step and adds how long it took.
template <typename Step> decltype(auto) clocked(double& seconds, const Step& step)
{
    struct Adding {
        double&   seconds;
        Stopwatch stopwatch;
        ~Adding() { seconds += stopwatch.seconds(); }
    } adding{seconds, {}};
    return step();
}

} // namespace ssrlab
