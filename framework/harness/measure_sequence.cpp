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
bool is_whole(const Bench& bench, const Sequence& sequence)
{
    return sequence.runs.size() == bench.experiment.frames.size();
}

bool is_finished(const Bench& bench, const Sequence& sequence, const std::set<std::string>& summaries)
{
    const auto has_row = [&](const Run& run) { return bench.results.finished().contains(run.id); };
    return std::ranges::all_of(sequence.runs, has_row) &&
           (!is_whole(bench, sequence) || summaries.contains(sequence.id));
}

Run in_frame(Run run, int frame)
{
    run.at.frame = frame;
    run.id       = run_id(run);
    return run;
}

void measure_frame(Bench& bench, std::span<const Sequence> sequences, int frame)
{
    std::vector<Run> listed, replayed;
    for (const Sequence& sequence : sequences) {
        if (frame > sequence.runs.back().at.frame) continue;
        const auto is_here = std::ranges::find(sequence.runs, frame, [](const Run& run) { return run.at.frame; });
        if (is_here != sequence.runs.end() && !bench.results.finished().contains(is_here->id))
            listed.push_back(*is_here);
        else
            replayed.push_back(in_frame(sequence.runs.front(), frame));
    }
    measure_picture(bench, listed, replayed);
}

void summarise_sequences(Bench& bench, std::span<const Sequence> sequences)
{
    const std::map<std::string, Row> rows    = bench.results.rows();
    const std::vector<Column>        columns = summary_columns(bench.experiment, bench.techniques);
    for (const Sequence& sequence : sequences) {
        if (!is_whole(bench, sequence)) continue;
        std::vector<Row> frames;
        for (const Run& run : sequence.runs) frames.push_back(rows.at(run.id));
        const Run& first = sequence.runs.front();
        Row row = summary_row(identity_row(bench.experiment, first, find_technique(bench.techniques, first.technique)),
                              frames, bench.sequences[sequence.id]);
        row["sequence_id"] = sequence.id;
        write_summary(bench.results.path(), columns, row);
    }
}

} // namespace

void measure_sequence(Bench& bench, std::span<const Run> runs)
{
    if (!is_sequence(bench.experiment) || is_frame(runs.front().scene)) return measure_picture(bench, runs);
    bench.sequences.clear();
    bench.converged.clear();
    const std::set<std::string> summaries = summarised(bench.results.path());
    std::vector<Sequence>       sequences = sequences_of(runs);
    std::erase_if(sequences, [&](const Sequence& sequence) { return is_finished(bench, sequence, summaries); });
    if (sequences.empty()) return;
    std::vector<Run> first;
    for (const Sequence& sequence : sequences) first.push_back(in_frame(sequence.runs.front(), 0));
    make_converged_pictures(bench, first);
    int last = -1;
    for (const Sequence& sequence : sequences) last = std::max(last, sequence.runs.back().at.frame);
    for (int frame = 0; frame <= last && stop_requested() == 0; ++frame) measure_frame(bench, sequences, frame);
    if (stop_requested() == 0) summarise_sequences(bench, sequences);
    bench.sequences.clear();
}

} // namespace ssrlab
