#include "harness/passes.h"

#include "harness/statistics.h"

namespace ssrlab {

std::span<const Column> pass_columns()
{
    using enum ColumnType;
    static const std::vector<Column> columns = {
        {"run_id", "run of results.csv", words},
        {"pass", "pass of the frame, or the structure that it builds", words},
        {"ran", "true or false", words},
        {"ms_median", "GPU time, median over the repeats; empty if the pass did not run"},
        {"ms_ci_low", "lower end of the 95 % confidence interval of the median; empty below six repeats"},
        {"ms_ci_high", "upper end"},
        {"bytes_read_mean",
         "bytes read from memory, a pixel of the image, if caches are ideal: each pixel or ray of the "
         "pass reads one item of every buffer and image that its shaders read"},
        {"bytes_written_mean", "bytes written, likewise"},
        {"reason", "why the pass ran or did not", words}};
    return columns;
}

std::string passes_text(const MeasuredRun& measured)
{
    std::string text;
    for (const PlannedPass& planned : measured.plan.passes) {
        Record record = {{"run_id", measured.run->id},
                         {"pass", planned.id},
                         {"ran", planned.runs ? "true" : "false"},
                         {"reason", planned.reason}};
        if (planned.runs) {
            const Summary ms = summarise(measured.pass_ms.at(planned.id));
            put(record, "ms_median", ms.median);
            put(record, "ms_ci_low", ms.ci_low);
            put(record, "ms_ci_high", ms.ci_high);
            const PassTraffic& moved  = measured.traffic.at(planned.id);
            const auto         pixels = static_cast<double>(measured.plan.statistics.pixels);
            put(record, "bytes_read_mean", static_cast<double>(moved.read_bytes) / pixels);
            put(record, "bytes_written_mean", static_cast<double>(moved.written_bytes) / pixels);
        }
        text += csv_line(fields_of(record, pass_columns()));
    }
    return text;
}

std::map<std::string, int64_t> count_passes(std::string_view records)
{
    std::map<std::string, int64_t> ran;
    while (const auto record = take_csv_record(records))
        if (record->size() == pass_columns().size() && words_of(record_of(*record, pass_columns()), "ran") == "true")
            ++ran[record->front()];
    return ran;
}

} // namespace ssrlab
