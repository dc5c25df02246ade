#include "harness/choose_technique.h"

#include "compare/differing_rays.h"
#include "core/error.h"
#include "core/files.h"
#include "core/printable.h"
#include "core/quantile.h"
#include "harness/environment.h"
#include "harness/kept_times.h"
#include "harness/measured_run.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

constexpr int repeats = 5;

std::vector<const Technique*> exact_techniques(const Catalogue& catalogue, const std::vector<std::string>& pairs)
{
    std::vector<const Technique*> exact, with_all;
    for (const Technique& technique : catalogue.techniques)
        if (technique.exact) exact.push_back(&technique);
    std::ranges::copy_if(exact, std::back_inserter(with_all), [&](const Technique* technique) {
        return std::ranges::all_of(pairs, [&](const std::string& pair) { return takes(catalogue, *technique, pair); });
    });
    if (!with_all.empty()) return with_all;
    parse_choices(catalogue, exact, pairs); // throws for a name that none has
    throw_spec_error("-t {}: no exact technique has all of these parameters: {}", fastest_exact,
                     fmt::join(pairs, ", "));
}

struct Candidate {
    std::string         id;
    TracerPtr           tracer;
    int                 times = 1; // in one submit
    std::vector<double> ms    = {};
};

/// Those that trace the frame and find what the first of them finds, and why the others are left out.
std::vector<Candidate> comparable(Stage& stage, const std::vector<AskedTechnique>& asked, KeptTimes& measured)
{
    std::vector<Candidate> candidates;
    TraceImage             first;
    for (const AskedTechnique& one : asked) {
        const std::string& id = one.technique->id;
        try {
            const LabPtr    lab    = make_lab(stage, *one.technique, one.choice.values, one.choice.settings.trace);
            const TracerPtr tracer = make_timed_tracer(stage.gpu, lab);
            TraceImage      hits   = trace_gbuffer(stage.gpu, *tracer);
            measured.rays          = hits.traced_order.size();
            if (candidates.empty())
                first = std::move(hits);
            else if (const size_t wrong = count_differing_rays(first, hits); wrong > 0) {
                measured.left_out[id] =
                    fmt::format("{} of {} rays differ from those of {}", wrong, measured.rays, candidates[0].id);
                continue;
            }
            candidates.push_back({id, tracer, frames_for(time_trace(stage.gpu, *tracer), {}, stage.gpu.info)});
        } catch (const std::runtime_error& error) {
            measured.left_out[id] = error.what();
        }
    }
    return candidates;
}

void measure(Stage& stage, const std::vector<AskedTechnique>& asked, KeptTimes& measured)
{
    std::vector<Candidate> candidates = comparable(stage, asked, measured);
    finish_pipelines(stage.gpu);
    for (int i = 0; i < repeats; ++i)
        for (Candidate& candidate : candidates)
            candidate.ms.push_back(time_trace(stage.gpu, *candidate.tracer, candidate.times));
    for (Candidate& candidate : candidates) measured.ms[candidate.id] = quantile(std::move(candidate.ms), 0.5);
}

/// Everything but the frame that times and hits depend on.
std::string state_of(const Stage& stage, const std::vector<AskedTechnique>& asked)
{
    std::map<std::string, std::string> state = describe_device(stage.gpu.info);
    state["shaders"]                         = folder_hash(data_root() / "shaders");
    for (const AskedTechnique& one : asked) {
        state.merge(describe_technique(*one.technique));
        for (const auto& [name, value] : one.choice.values)
            state[one.technique->id + " " + name] = fmt::format("{}", value);
    }
    const TraceSettings& trace = asked[0].choice.settings.trace;
    state["surface"]           = folder_hash(find_surface(stage.catalogue.surfaces, trace.surface).shaders);
    state["layers"]            = std::to_string(trace.layers);
    return content_hash(fmt::format("{}", state));
}

void warn(const std::string& text, bool quiet)
{
    if (!quiet) std::fprintf(stderr, "warning: %s\n", printable(text).c_str());
}

/// "hiz_packets: 3.10 ms, hiz 3.90, dda 12.00"
std::string in_order(const KeptTimes& times)
{
    std::vector<std::pair<double, std::string>> sorted;
    for (const auto& [id, ms] : times.ms) sorted.emplace_back(ms, id);
    std::ranges::sort(sorted);
    std::string text = fmt::format("{}: {:.2f} ms", sorted[0].second, sorted[0].first);
    for (size_t i = 1; i < sorted.size(); ++i) text += fmt::format(", {} {:.2f}", sorted[i].second, sorted[i].first);
    return text;
}

/// A damaged file is as good as none.
std::vector<KeptTimes> kept_times(const std::filesystem::path& file, bool quiet)
{
    if (file.empty()) return {};
    try {
        return read_kept_times(file);
    } catch (const SpecError& error) {
        warn(fmt::format("no times of techniques can be read, they are measured anew: {}", error.what()), quiet);
        return {};
    }
}

/// In the place of an older measurement at the same frame.
void keep(const std::filesystem::path& file, const std::string& device, std::vector<KeptTimes> all,
          const KeptTimes& measured, bool quiet)
{
    if (file.empty()) return;
    std::erase_if(all, [&](const KeptTimes& older) { return older.frame == measured.frame; });
    all.push_back(measured);
    try {
        write_kept_times(file, device, all);
    } catch (const std::exception& error) {
        warn(fmt::format("times of techniques are not kept: {}", error.what()), quiet);
    }
}

} // namespace

std::vector<AskedTechnique> asked_techniques(const Catalogue& catalogue, const std::string& id,
                                             const std::vector<std::string>& pairs)
{
    const auto                  techniques = id == fastest_exact
                                                 ? exact_techniques(catalogue, pairs)
                                                 : std::vector<const Technique*>{&find_technique(catalogue.techniques, id)};
    std::vector<AskedTechnique> asked;
    for (const Technique* technique : techniques)
        asked.push_back({technique, parse_choice(catalogue, *technique, pairs)});
    return asked;
}

AskedTechnique choose_technique(Stage& stage, const std::vector<AskedTechnique>& asked, bool quiet)
{
    if (asked.size() == 1) return asked[0];
    const std::string&           device = stage.gpu.info.name;
    const TraceSettings&         trace  = asked[0].choice.settings.trace;
    const std::filesystem::path  file   = kept_times_file(device);
    const std::vector<KeptTimes> all    = kept_times(file, quiet);
    const std::string            frame  = fmt::format("{}, {}", size_text(stage.view.size_px), trace.surface);
    KeptTimes                    times  = {frame, state_of(stage, asked), 0, {}, {}};
    const auto                   known  = std::ranges::find_if(
                           all, [&](const KeptTimes& kept) { return kept.frame == frame && kept.state == times.state; });
    const bool is_kept = known != all.end();
    if (is_kept)
        times = *known;
    else
        measure(stage, asked, times);
    for (const auto& [id, why] : times.left_out)
        warn(fmt::format("{} leaves {} out: {}", fastest_exact, id, why), quiet);
    if (times.ms.empty()) throw_failure("-t {}: no exact technique traces this frame", fastest_exact);
    // Without rays the times say nothing, and the next frame of this size may have some.
    if (!is_kept && times.rays > 0) keep(file, device, all, times, quiet);
    if (!quiet)
        std::fprintf(stderr, "%s: %s, %s on %s at %s\n", fastest_exact, in_order(times).c_str(),
                     is_kept ? "kept from a measurement" : "measured", device.c_str(), frame.c_str());
    const auto fastest = std::ranges::min_element(times.ms, {}, &std::pair<const std::string, double>::second)->first;
    return *std::ranges::find_if(asked, [&](const AskedTechnique& one) { return one.technique->id == fastest; });
}

} // namespace ssrlab
