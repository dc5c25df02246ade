#include "harness/samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace ssrlab {

const CsvRecord& sample_columns()
{
    static const CsvRecord columns = {"run_id", "round", "pass", "ms", "cpu_ms"};
    return columns;
}

std::string samples_text(const MeasuredRun& measured)
{
    std::string text;
    // The shortest text that reads back as the same number: medians can be recomputed to the last digit.
    const auto add = [&](size_t frame, const std::string& pass, double ms, const std::string& cpu_ms) {
        const std::string round = std::to_string(measured.rounds[frame]);
        text += csv_line({measured.run->id, round, pass, fmt::format("{}", ms), cpu_ms});
    };
    for (size_t frame = 0; frame < measured.rounds.size(); ++frame) {
        for (const auto& [pass, ms] : measured.pass_ms) add(frame, pass, ms[frame], "");
        add(frame, "frame", measured.frame_ms[frame], fmt::format("{}", measured.cpu_ms[frame]));
    }
    return text;
}

SampleCounts count_samples(std::string_view records)
{
    SampleCounts counts;
    while (const auto record = take_csv_record(records)) {
        if (record->size() != sample_columns().size() || (*record)[2] != "frame") continue;
        ++counts.frames[record->front()];
        int round = 0;
        std::from_chars((*record)[1].data(), (*record)[1].data() + (*record)[1].size(), round);
        counts.next_round = std::max(counts.next_round, round + 1);
    }
    return counts;
}

} // namespace ssrlab
