// One frame of a scene on the device, and the outputs of a run on it. Folder-internal.
#pragma once

#include "core/stopwatch.h"
#include "harness/measure_picture.h"

namespace ssrlab {

struct MeasuredPicture {
    FrameBuffersPtr       buffers;
    double                gbuffer_ms = 0;
    int                   round      = 0; // of samples.csv
    glm::dvec2            jitter_px{0, 0};
    std::optional<Truths> truths;

    // The image with the true reflections, under the trace settings of the last run.
    std::optional<Reference> reference;
    TraceSettings            reference_for;
    std::string              reference_file; // relative to the results; empty if none was written

    // What the sources of the last run with a list built, and that run.
    std::unique_ptr<SourceContext> sources;
    Run                            sources_for;
};

/// Returns the stage of a scene; loads and uploads the scene unless it is the current one.
Stage& stage_of(SweepContext& sweep, const std::string& scene);
/// Returns the metallic exponent of the true picture, by the experiment's own [passes] (the first value of a list).
/// What techniques set instead does not count, so all runs of a frame are judged by one picture.
std::optional<float> true_exponent(const Experiment& experiment);
/// Shows the run's frame on that stage.
MeasuredPicture make_picture(SweepContext& sweep, const Run& run);

/// The outputs of a run's frames, not yet judged.
struct Observed {
    Image                        shaded;
    TraceImage                   counted;
    std::optional<TraceImage>    hidden, twin = {}; // the second layer's hits; the same trace in double
    std::vector<glm::vec2>       reprojection = {}; // empty if the pass did not run
    std::optional<HistoryCounts> history      = {}; // likewise
};

/// Runs a step and adds its wall time to `seconds`.
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
