#include "app/sources_command.h"

#include "core/error.h"
#include "harness/choose_technique.h"
#include "harness/experiment.h"
#include "harness/source_rows.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace ssrlab {
namespace {

/// What a row of the file begins with: the frame, and what was asked.
const std::vector<Column>& asked_columns()
{
    using enum ColumnType;
    static const std::vector<Column> columns = {
        {"scene", "", words},     {"view", "", words},    {"size", "", words},
        {"technique", "", words}, {"surface", "", words}, {"settings", "", words},
        {"sources", "", words},   {"hand_on", "", words}, {"device", "", words}};
    return columns;
}

/// A line for each source of a list.
void print_table(const std::string& list, std::span<const Record> sources)
{
    size_t wide = 0;
    for (const Record& source : sources) wide = std::max(wide, words_of(source, "source").size());
    const auto line = [&](const std::string& source, std::span<const std::string> cells) {
        std::string text = fmt::format("  {:{}}", source, wide);
        for (const std::string& cell : cells) text += fmt::format("  {:>9}", cell);
        std::puts(text.c_str());
    };
    std::puts(list.c_str());
    line("", std::array<std::string, 15>{"handed", "meet, %", "points", "right, %", "certain", "right, %", "nothing",
                                         "right, %", "recall, %", "prec., %", "F1, %", "draw, ms", "trace, ms", "MB",
                                         "visits"});
    for (const Record& source : sources) {
        const auto number  = [&](const char* column) { return number_of(source, column).value_or(0); };
        const auto percent = [&](const char* part, const char* whole) {
            return number(whole) > 0 ? fmt::format("{:.1f}", 100 * number(part) / number(whole)) : std::string("-");
        };
        const auto count = [&](const char* column) { return fmt::format("{:.0f}", number(column)); };
        const auto share = [&](const char* column) { return fmt::format("{:.2f}", 100 * number(column)); };
        const auto tenth = [&](const char* column) { return fmt::format("{:.1f}", number(column)); };
        line(words_of(source, "source"),
             std::array{count("handed"), percent("meeting", "handed"), count("points"), percent("right", "points"),
                        count("certain_points"), percent("certain_right", "certain_points"), count("certain_nothing"),
                        percent("certain_nothing_right", "certain_nothing"), share("all_recall"),
                        share("all_precision"), share("all_f1"), tenth("draw_ms"), tenth("trace_ms"),
                        tenth("megabytes"), count("node_visits")});
    }
}

std::vector<Column> all_columns()
{
    std::vector<Column> columns = asked_columns();
    columns.insert(columns.end(), source_columns().begin(), source_columns().end());
    return columns;
}

/// Throws SpecError for a file that has other columns than what would be appended to it.
void require_columns(const std::string& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::string   first;
    if (std::getline(stream, first) && first + "\n" != csv_line(names_of(all_columns())))
        throw_spec_error("{}: its columns are not those of this version of ssrlab; name another file", file);
}

void append(const std::string& file, const Record& asked, std::span<const Record> sources)
{
    const std::vector<Column> columns = all_columns();
    const bool                fresh   = !std::filesystem::exists(file) || std::filesystem::file_size(file) == 0;
    std::ofstream             stream(file, std::ios::app | std::ios::binary);
    if (fresh) stream << csv_line(names_of(columns));
    for (Record row : sources) {
        row.insert(asked.begin(), asked.end());
        stream << csv_line(fields_of(row, columns));
    }
    if (!stream.flush()) throw_failure("{}: could not be written", file);
}

HandOn parse_hand_on(const std::string& text)
{
    const auto found = std::ranges::find(hand_on_names, text);
    if (found == hand_on_names.end()) throw_spec_error("--hand-on: expected lost or uncertain, got '{}'", text);
    return static_cast<HandOn>(found - hand_on_names.begin());
}

} // namespace

int compare_sources(const CommonOptions& common, const SourcesOptions& options)
{
    const PictureOptions& picture = options.picture;
    if (!picture.output.empty()) {
        require_output(picture.output, {".csv"});
        require_columns(picture.output);
    }
    std::vector<std::vector<ListedSource>> lists;
    for (const std::string& list : options.lists) lists.push_back(parse_sources(list, "--sources " + list));
    const HandOn      hand_on      = parse_hand_on(options.hand_on);
    const std::string settings     = fmt::format("{}", fmt::join(picture.parameters, ";"));
    const Catalogue   catalogue    = load_catalogue(common.technique_dirs);
    const auto        asked_for    = asked_techniques(catalogue, picture.technique, picture.parameters);
    Stage             stage        = open_stage(common, catalogue, picture);
    const auto [technique, choice] = choose_technique(stage, asked_for, common.quiet);
    SourceContext context =
        context_of_frame(stage, *technique, choice.values, choice.settings, picture.view, picture.at);
    const SceneTruth truth = scene_truth(SceneBvh(stage.scene), stage.scene, context.image, choice.settings.trace);
    if (const std::string why = drawn_elsewhere(off_surface_share(truth)); !why.empty())
        throw_failure("no scene truth: {}", why);
    std::puts(fmt::format("{} {} {}, {}, surface {}", picture.scene, picture.view, size_text(stage.view.size_px),
                          technique->id, choice.settings.trace.surface)
                  .c_str());
    for (size_t l = 0; l < lists.size(); ++l) {
        const ChosenSources chosen = choose_sources(context, lists[l], hand_on);
        if (!chosen.reason.empty()) std::puts(("  auto, " + chosen.reason).c_str());
        const std::vector<Record> sources = ask_sources(context, chosen, hand_on, truth);
        print_table(options.lists[l], sources);
        const Record asked = {{"scene", picture.scene},
                              {"view", picture.view},
                              {"size", size_text(stage.view.size_px)},
                              {"technique", technique->id},
                              {"surface", choice.settings.trace.surface},
                              {"settings", settings},
                              {"sources", options.lists[l]},
                              {"hand_on", options.hand_on},
                              {"device", stage.gpu.info.name}};
        if (!picture.output.empty()) append(picture.output, asked, sources);
    }
    return report_messages(stage);
}

} // namespace ssrlab
