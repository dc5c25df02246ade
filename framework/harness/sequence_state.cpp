#include "harness/sequence_state.h"

#include "core/error.h"
#include "core/files.h"
#include "core/quantile.h"

#include <algorithm>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

constexpr const char* summary_file = "sequence_summary.csv";

/// Of the columns of results.csv: what a summary says of them.
struct Summarised {
    const char* column;
    bool        median; // over the frames that have a value, or their mean
};
constexpr auto summarised_columns = std::to_array<Summarised>({
    {"disocclusion_share", false},
    {"reprojection_unknown_share", false},
    {"surface_motion_error_median_px", true},
    {"surface_motion_error_p95_px", true},
    {"reprojection_error_median_px", true},
    {"reprojection_error_p95_px", true},
    {"reprojection_found_share", false},
    {"ghosting_rmse", false},
    {"history_share", false},
    {"clamped_share", false},
    {"picture_rmse", false},
    {"trace_ms_median", true},
    {"frame_ms_median", true},
});

/// Empty where no frame has a value.
std::optional<double> summary_of(std::span<const Record> frames, const Summarised& what)
{
    std::vector<double> values;
    double              sum = 0;
    for (const Record& row : frames)
        if (const auto value = number_of(row, what.column)) {
            values.push_back(*value);
            sum += *value;
        }
    if (values.empty()) return std::nullopt;
    const auto count = static_cast<double>(values.size());
    return what.median ? quantile(std::move(values), 0.5) : sum / count;
}

void put(Record& row, const std::string& column, std::optional<double> value)
{
    if (value) row[column] = *value;
}

} // namespace

bool is_sequence(const Experiment& experiment)
{
    return experiment.targets.empty() &&
           std::ranges::any_of(experiment.frames, [](const SequenceFrame& at) { return at.frame > 0; });
}

std::string sequence_id(const Run& run)
{
    Run any      = run;
    any.at.frame = -1;
    return "s" + run_id(any).substr(1);
}

MeasureValues watch(SequenceState& state, const Image& shaded, const TraceImage& traced, glm::dvec2 jitter_px,
                    bool moved)
{
    MeasureValues values;
    HitPlaces     places = hit_places(traced, jitter_px);
    state.moved          = state.moved || moved;
    if (state.places && !moved) {
        const Flips flips = count_changes(*state.places, places);
        state.flips.flips += flips.flips;
        state.flips.rays += flips.rays;
        values["flip_share"] = share(flips.flips, flips.rays);
    }
    state.places = std::move(places);
    add_picture(state.moments, shaded, traced);
    ++state.pictures;
    return values;
}

std::vector<Column> summary_columns(const Experiment& experiment, std::span<const Technique> techniques)
{
    std::vector<Column> columns{{"sequence_id", "hash of the run without its frame", ColumnType::words}};
    for (const Column& column : setting_columns(experiment, techniques))
        if (column.name != "run_id" && column.name != "run_number" && column.name != "frame") columns.push_back(column);
    columns.push_back({"frames", "rows of the sequence with outcome ok", ColumnType::whole});
    columns.push_back({"flip_rate", "flip_share over all frames: flips of all pairs of frames, of their rays"});
    columns.push_back({"temporal_rms", "standard deviation over time of the display luma of the finished picture, root "
                                       "mean square over pixels that reflect in every frame; where nothing but jitter "
                                       "moves"});
    columns.push_back({"converged_rmse_last", "converged_rmse of the last frame"});
    for (const Summarised& what : summarised_columns)
        columns.push_back(
            {what.column, fmt::format("{} over the frames of {}", what.median ? "median" : "mean", what.column)});
    return columns;
}

Record summary_row(const Record& identity, std::span<const Record> frames, const SequenceState& state)
{
    Record row = identity;
    row.erase("run_id");
    row.erase("run_number");
    row.erase("frame");
    std::vector<Record> good;
    for (const Record& frame : frames)
        if (words_of(frame, "outcome") == "ok") good.push_back(frame);
    row["frames"] = static_cast<int64_t>(good.size());
    for (const Summarised& what : summarised_columns) put(row, what.column, summary_of(good, what));
    if (!good.empty()) put(row, "converged_rmse_last", number_of(good.back(), "converged_rmse"));
    if (state.failed) return row;
    put(row, "flip_rate", share(state.flips.flips, state.flips.rays));
    if (!state.moved) put(row, "temporal_rms", temporal_rms(state.moments, state.pictures));
    return row;
}

std::set<std::string> summarised(const fs::path& folder)
{
    std::set<std::string> ids;
    if (!fs::exists(folder / summary_file)) return ids;
    const std::string text = read_file(folder / summary_file);
    std::string_view  rest = text;
    take_csv_record(rest); // the header
    while (const auto record = take_csv_record(rest)) ids.insert(record->front());
    return ids;
}

void write_summary(const fs::path& folder, std::span<const Column> columns, const Record& row)
{
    const CsvRecord header = names_of(columns);
    std::string     text   = csv_line(header);
    if (fs::exists(folder / summary_file)) {
        const std::string old  = read_file(folder / summary_file);
        std::string_view  rest = old;
        if (take_csv_record(rest) != header)
            throw_failure("{}: its columns are not those of this version", short_path(folder / summary_file));
        while (const auto record = take_csv_record(rest))
            if (record->front() != words_of(row, "sequence_id")) text += csv_line(*record);
    }
    write_file_atomically(folder / summary_file, text + csv_line(fields_of(row, columns)));
}

} // namespace ssrlab
