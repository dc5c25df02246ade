#include "harness/source_rows.h"

#include "compare/all_rays.h"
#include "core/quantile.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

using enum ColumnType;

constexpr int timed_turns = 3;

constexpr std::array meeting_classes = {TruthClass::visible, TruthClass::hidden, TruthClass::off_screen,
                                        TruthClass::behind_camera, TruthClass::facing_away};

constexpr std::array times = {&SourceTurn::draw_ms, &SourceTurn::trace_ms, &SourceTurn::shade_ms,
                              &SourceTurn::bounces_ms, &SourceTurn::merge_ms};

std::string with_class(const char* name, TruthClass cls)
{
    return fmt::format("{}_{}", name, truth_class_names[static_cast<size_t>(cls)]);
}

std::vector<Column> make_columns()
{
    std::vector<Column> columns = {
        {"place", "in the list, from 0", whole},
        {"source", "the source with its parameters", words},
        {"handed", "rays that the source was asked about", whole},
        {"meeting", "of those, rays that meet geometry within max_distance_m", whole},
        {"points", "rays that it answered by a point", whole},
        {"right", "of those, right ones", whole},
        {"certain_points", "points that it vouches for", whole},
        {"certain_right", "of those, right ones", whole},
        {"certain_nothing", "rays of which it vouches that they meet nothing", whole},
        {"certain_nothing_right", "of those, right ones", whole},
    };
    for (const TruthClass cls : meeting_classes) {
        const auto name = truth_class_names[static_cast<size_t>(cls)];
        columns.push_back(
            {with_class("handed", cls), fmt::format("rays of `meeting` whose true point is {}", name), whole});
        columns.push_back({with_class("right", cls), "of those, rightly answered ones", whole});
    }
    const std::vector<Column> rest = {
        {"draw_ms", "GPU time of drawing the source"},
        {"trace_ms", "GPU time of its structures and trace, and of the grid of occupied cells"},
        {"shade_ms", "GPU time of lighting the triangles that were met"},
        {"bounces_ms",
         "GPU time of following what reflects there; part of no total, as little as the frame's own bounces"},
        {"merge_ms", "time of choosing rays and merging answers on the CPU; part of no total"},
        {"choosing_ms", "time of choosing the list, in the row of its first source; 0 unless the list is `auto`"},
        {"megabytes", "device memory beyond what the frame needs"},
        {"node_visits", "nodes of the triangles' hierarchy that all rays visited", whole},
        {"all_rays", "rays of the frame", whole},
        {"all_meeting", "of those, rays that meet geometry within max_distance_m", whole},
        {"all_recall", "of the answers merged up to and including this source: right ones / all_meeting"},
        {"all_precision", "of the same answers: right ones / points"},
        {"all_f1", "harmonic mean of the two"},
    };
    columns.insert(columns.end(), rest.begin(), rest.end());
    return columns;
}

Record record_of_turn(const SourceTurn& turn, const SourceCounts& counts, const AllRays& so_far)
{
    Record     record = {{"source", turn.source}};
    const auto count  = [&](const std::string& column, size_t value) { record[column] = static_cast<int64_t>(value); };
    count("handed", counts.handed);
    count("meeting", counts.meeting);
    count("points", counts.points);
    count("right", counts.right);
    count("certain_points", counts.certain_points);
    count("certain_right", counts.certain_right);
    count("certain_nothing", counts.certain_nothing);
    count("certain_nothing_right", counts.certain_nothing_right);
    for (const TruthClass cls : meeting_classes) {
        count(with_class("handed", cls), counts.handed_of_class[static_cast<size_t>(cls)]);
        count(with_class("right", cls), counts.right_of_class[static_cast<size_t>(cls)]);
    }
    record["draw_ms"]    = turn.draw_ms;
    record["trace_ms"]   = turn.trace_ms;
    record["shade_ms"]   = turn.shade_ms;
    record["bounces_ms"] = turn.bounces_ms;
    record["merge_ms"]   = turn.merge_ms;
    record["megabytes"]  = turn.megabytes;
    count("node_visits", turn.node_visits);
    count("all_rays", so_far.rays);
    count("all_meeting", so_far.meeting);
    if (so_far.recall) record["all_recall"] = *so_far.recall;
    if (so_far.precision) record["all_precision"] = *so_far.precision;
    if (so_far.f1) record["all_f1"] = *so_far.f1;
    return record;
}

/// Replaces the times of the turns by medians over further turns.
void take_times(SourceContext& context, std::span<const ListedSource> sources, HandOn hand_on, AnsweredRays& answered)
{
    std::vector<AnsweredRays> again;
    for (int i = 0; i < timed_turns; ++i) {
        again.push_back(answer_rays(context, sources, hand_on));
        again.back().answers.clear();
        for (SourceTurn& turn : again.back().turns) turn.answers.clear();
    }
    for (size_t place = 0; place < answered.turns.size(); ++place)
        for (const auto time : times) {
            std::vector<double> ms;
            for (const AnsweredRays& one : again) ms.push_back(one.turns[place].*time);
            answered.turns[place].*time = quantile(std::move(ms), 0.5);
        }
}

} // namespace

std::span<const Column> source_columns() { return source_file_columns().subspan(1); }

std::span<const Column> source_file_columns()
{
    static const std::vector<Column> columns = [] {
        std::vector<Column> all = make_columns();
        all.insert(all.begin(), {"run_id", "run of results.csv", words});
        return all;
    }();
    return columns;
}

SourceContext context_of_frame(Stage& stage, const Technique& technique, const ParameterValues& values,
                               const FrameSettings& settings, const std::string& view, SequenceFrame at)
{
    SourceContext context = make_source_context(stage, technique, values, settings);
    for (int frame = at.frame - 1; frame >= 0; --frame)
        context.earlier.push_back(view_at(stage.scene, view, stage.view.size_px, {frame, at.jitter_phases}));
    return context;
}

std::vector<Record> ask_sources(SourceContext& context, const ChosenSources& sources, HandOn hand_on,
                                const SceneTruth& truth)
{
    AnsweredRays answered = answer_rays(context, sources.list, hand_on);
    take_times(context, sources.list, hand_on, answered);
    std::vector<RayAnswer> so_far(answered.answers.size());
    std::vector<Record>    records;
    for (const SourceTurn& turn : answered.turns) {
        for (size_t k = 0; k < turn.pixels.size(); ++k)
            so_far[turn.pixels[k]] = merged(so_far[turn.pixels[k]], turn.answers[k]);
        Record record         = record_of_turn(turn, count_source(turn, truth, context.image),
                                               compare_all_rays(so_far, truth, context.image));
        record["place"]       = static_cast<int64_t>(records.size());
        record["choosing_ms"] = records.empty() ? sources.choosing_ms : 0.0;
        records.push_back(std::move(record));
    }
    return records;
}

void add_sources(Record& row, std::span<const Record> sources)
{
    if (sources.empty()) return;
    double ms = 0, megabytes = 0;
    for (const Record& source : sources) {
        ms += *number_of(source, "draw_ms") + *number_of(source, "trace_ms") + *number_of(source, "shade_ms");
        megabytes += *number_of(source, "megabytes");
    }
    row["sources_asked"]     = static_cast<int64_t>(sources.size());
    row["sources_ms"]        = ms;
    row["sources_megabytes"] = megabytes;
    for (const char* measure : {"all_recall", "all_precision", "all_f1"})
        if (const auto value = number_of(sources.back(), measure)) row[measure] = *value;
}

std::string sources_text(const MeasuredRun& measured)
{
    std::string text;
    for (Record record : measured.sources) {
        record["run_id"] = measured.run->id;
        text += csv_line(fields_of(record, source_file_columns()));
    }
    return text;
}

std::map<std::string, int64_t> count_sources(std::string_view records)
{
    std::map<std::string, int64_t> asked;
    while (const auto record = take_csv_record(records))
        if (record->size() == source_file_columns().size()) ++asked[record->front()];
    return asked;
}

} // namespace ssrlab
