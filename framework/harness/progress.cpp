#include "harness/progress.h"

#include "core/printable.h"
#include "harness/measured_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace ssrlab {
namespace {

// Fitted to results/reference/lavapipe: two cores, scenes of which half the pixels reflect.
constexpr double ns_per_pixel_and_step = 2;
constexpr double walked_share          = 0.2;    // of width + height: the pixels that a ray visits
constexpr double visits_per_level      = 3;      // of a pyramid
constexpr double sampled_share         = 0.6;    // of the steps that a sampler may take
constexpr double overhead_s            = 0.15;   // pipelines, rays compared, picture
constexpr double image_errors_s        = 1.1e-6; // per pixel
constexpr double prepared_share        = 0.5;    // of a run's cost, before its timed repeats

/// Whoever reads it may be gone: no reason to stop.
void write(const std::string& text)
{
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

double expected_steps(const Run& run, const Technique& technique)
{
    const double bound   = iteration_bound(technique, run.values);
    const double crossed = run.size_px.x + run.size_px.y;
    // Strides end with the ray, far below their bound.
    for (const Accuracy& accuracy : technique.accuracy)
        if (!accuracy.higher_is_better && std::ranges::count(technique.bounded_by, accuracy.parameter) == 0)
            return std::min(bound, walked_share * crossed / run.values.at(accuracy.parameter));
    if (!technique.exact) return sampled_share * bound;
    return std::min(bound,
                    technique.structures.empty() ? walked_share * crossed : visits_per_level * std::log2(crossed));
}

/// Drawing, tracing and judging what the sources of a run say, as measured on two CPU cores.
double sources_s_per_pixel(const Run& run)
{
    constexpr double each_s = 15e-6, choosing_s = 190e-6;
    double           sum_s = 0;
    for (const ListedSource& listed : run.sources.list) sum_s += listed.source->id == "auto" ? choosing_s : each_s;
    return sum_s;
}

} // namespace

double estimated_seconds(const Run& run, const Technique& technique, const MeasureSettings& measure)
{
    const double pixels   = static_cast<double>(run.size_px.x) * run.size_px.y;
    const double frame_s  = pixels * expected_steps(run, technique) * ns_per_pixel_and_step * 1e-9 + pixels * 20e-9;
    const double repeats  = std::clamp(measure.budget_s / frame_s, static_cast<double>(measure.min_repeats),
                                       static_cast<double>(measure.max_repeats));
    const double counting = measure.truth ? 4 : 2;
    const double errors_s = measure.truth && measure.image_errors ? pixels * image_errors_s : 0;
    const int    saved =
        measure.saved_time && choice<PassSet>(run.settings.passes) != PassSet::shading ? saved_pairs + 1 : 0;
    return overhead_s + errors_s + frame_s * (repeats + 1 + counting + saved) + pixels * sources_s_per_pixel(run);
}

std::string duration_text(double seconds)
{
    const auto whole = static_cast<int64_t>(std::llround(seconds));
    if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

Progress::Progress(size_t total_runs, double total_cost, bool quiet)
    : total_runs_(total_runs), total_cost_(total_cost), in_place_(::isatty(STDERR_FILENO) != 0), quiet_(quiet)
{
}

void Progress::add_runs(size_t count, double cost)
{
    total_runs_ += count;
    total_cost_ += cost;
}

void Progress::start_picture(const std::string& what)
{
    picture_ = what;
    tick();
}

void Progress::prepared_run(const std::string& id, double cost)
{
    prepared_.insert(id);
    done_cost_ += prepared_share * cost;
    tick();
}

void Progress::finish_run(const std::string& id, double cost)
{
    ++done_runs_;
    done_cost_ += prepared_.erase(id) > 0 ? (1 - prepared_share) * cost : cost;
    if (done_runs_ == total_runs_ && !quiet_)
        print();
    else
        tick();
}

void Progress::tick()
{
    if (quiet_ || done_runs_ == total_runs_) return; // said by finish_run()
    const double interval_s = in_place_ ? 0.2 : 10;
    if (!since_print_ || since_print_->seconds() >= interval_s) print();
}

void Progress::print()
{
    since_print_.emplace();
    const double      elapsed_s = since_start_.seconds();
    const double      left_s    = done_cost_ > 0 ? elapsed_s * (total_cost_ - done_cost_) / done_cost_ : total_cost_;
    const std::string left      = left_s < 0.5 ? "" : ", about " + duration_text(left_s) + " left";
    const std::string line      = fmt::format("{} of {} runs, {}, {} so far{}", done_runs_, total_runs_, picture_,
                                              duration_text(elapsed_s), left);
    write((in_place_ ? "\r\033[K" : "") + line + (in_place_ && done_runs_ < total_runs_ ? "" : "\n"));
}

void Progress::say(const std::string& line) { write((in_place_ ? "\r\033[K" : "") + printable(line) + "\n"); }

} // namespace ssrlab
