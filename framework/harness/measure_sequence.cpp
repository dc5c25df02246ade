#include "harness/measure_sequence.h"

#include "harness/sequence_frame.h"
#include "harness/stop_signal.h"
#include "scene/load_scene.h"

#include <algorithm>
#include <map>

namespace ssrlab {
namespace {

/// The frames of one run's settings that the specification lists.
struct Sequence {
    std::string      id;
    std::vector<Run> runs; // in the order of time
};

std::vector<Sequence> sequences_of(std::span<const Run> runs)
{
    std::vector<Sequence>         sequences;
    std::map<std::string, size_t> place;
    for (const Run& run : runs) {
        const std::string id       = sequence_id(run);
        const auto [found, is_new] = place.try_emplace(id, sequences.size());
        if (is_new) sequences.push_back({id, {}});
        sequences[found->second].runs.push_back(run);
    }
    for (Sequence& sequence : sequences)
        std::ranges::sort(sequence.runs, {}, [](const Run& run) { return run.at.frame; });
    return sequences;
}

/// Whether this is all of it: --only picks one frame.
bool is_whole(const SweepContext& sweep, const Sequence& sequence)
{
    return sequence.runs.size() == sweep.experiment.frames.size();
}

bool is_finished(const SweepContext& sweep, const Sequence& sequence, const std::set<std::string>& summaries)
{
    const auto has_row = [&](const Run& run) { return sweep.results.finished().contains(run.id); };
    return std::ranges::all_of(sequence.runs, has_row) &&
           (!is_whole(sweep, sequence) || summaries.contains(sequence.id));
}

/// The first one from this frame on that has no row, or the last one: it has the blame if a replayed frame ends the process.
const Run& next_listed(const SweepContext& sweep, const Sequence& sequence, int frame)
{
    const auto next = std::ranges::find_if(sequence.runs, [&](const Run& run) {
        return run.at.frame > frame && !sweep.results.finished().contains(run.id);
    });
    return next == sequence.runs.end() ? sequence.runs.back() : *next;
}

Run in_frame(Run run, int frame)
{
    run.at.frame = frame;
    return run;
}

/// Runs whose row says so.
std::set<std::string> failed_runs(const SweepContext& sweep)
{
    std::set<std::string> ids;
    for (const auto& [id, row] : sweep.results.rows())
        if (row.contains("message")) ids.insert(id);
    return ids;
}

void measure_frame(SweepContext& sweep, std::span<const Sequence> sequences, const std::set<std::string>& failed,
                   int frame)
{
    std::vector<Run> listed, replayed;
    for (const Sequence& sequence : sequences) {
        if (frame > sequence.runs.back().at.frame) continue;
        const auto is_here = std::ranges::find(sequence.runs, frame, [](const Run& run) { return run.at.frame; });
        if (is_here != sequence.runs.end() && !sweep.results.finished().contains(is_here->id))
            listed.push_back(*is_here);
        else if (is_here != sequence.runs.end() && failed.contains(is_here->id))
            lose_sequence(sweep, *is_here); // it would fail again
        else
            replayed.push_back(in_frame(next_listed(sweep, sequence, frame), frame));
    }
    measure_picture(sweep, listed, replayed);
}

/// Frame by frame, without a look at the one before.
void measure_each_picture(SweepContext& sweep, std::span<const Run> runs)
{
    while (!runs.empty() && stop_requested() == 0) {
        const auto same  = [&](const Run& run) { return same_picture(run, runs.front()); };
        const auto count = static_cast<size_t>(std::ranges::find_if_not(runs, same) - runs.begin());
        measure_picture(sweep, runs.first(count));
        runs = runs.subspan(count);
    }
}

void summarise_sequences(SweepContext& sweep, std::span<const Sequence> sequences)
{
    const std::map<std::string, Record> rows    = sweep.results.rows();
    const std::vector<Column>           columns = summary_columns(sweep.experiment, sweep.techniques);
    for (const Sequence& sequence : sequences) {
        if (!is_whole(sweep, sequence)) continue;
        std::vector<Record> frames;
        for (const Run& run : sequence.runs) frames.push_back(rows.at(run.id));
        const Run& first = sequence.runs.front();
        Record     row =
            summary_row(identity_row(sweep.experiment, first, find_technique(sweep.techniques, first.technique)),
                        frames, sweep.sequences[sequence.id]);
        row["sequence_id"] = sequence.id;
        write_summary(sweep.results.path(), columns, row);
    }
}

} // namespace

void measure_sequence(SweepContext& sweep, std::span<const Run> runs)
{
    if (!is_sequence(sweep.experiment) || is_frame(runs.front().scene)) return measure_each_picture(sweep, runs);
    sweep.sequences.clear();
    sweep.converged.clear();
    const std::set<std::string> summaries = summarised(sweep.results.path());
    std::vector<Sequence>       sequences = sequences_of(runs);
    std::erase_if(sequences, [&](const Sequence& sequence) { return is_finished(sweep, sequence, summaries); });
    if (sequences.empty()) return;
    int last = -1;
    for (const Sequence& sequence : sequences) last = std::max(last, sequence.runs.back().at.frame);
    make_converged_pictures(sweep, runs, last);
    const std::set<std::string> failed = failed_runs(sweep); // before this process
    for (int frame = 0; frame <= last && stop_requested() == 0; ++frame) measure_frame(sweep, sequences, failed, frame);
    if (stop_requested() == 0) summarise_sequences(sweep, sequences);
    sweep.sequences.clear();
    sweep.converged.clear();
}

} // namespace ssrlab
