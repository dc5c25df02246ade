#include "app/sources_command.h"

#include "core/error.h"
#include "harness/choose_technique.h"
#include "harness/experiment.h"
#include "harness/source_rows.h"

#include <fmt/ranges.h>

#include <algorithm>
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

void print_line(const Record& source)
{
    const auto number  = [&](const char* column) { return number_of(source, column).value_or(0); };
    const auto percent = [&](const char* part, const char* whole) {
        return number(whole) > 0 ? 100 * number(part) / number(whole) : 0;
    };
    std::puts(fmt::format("  {:8} handed {:6} ({:5.1f} % meet)  points {:6}, {:5.1f} % right  certain {:6}, {:5.1f} % "
                          "right  nothing {:6}, {:5.1f} % right"
                          "  all: recall {:5.1f} precision {:5.1f} F1 {:5.2f} %  draw {:.1f} ms, trace {:.1f} ms, "
                          "{:.1f} MB, {} visits",
                          words_of(source, "source"), number("handed"), percent("meeting", "handed"), number("points"),
                          percent("right", "points"), number("certain_points"),
                          percent("certain_right", "certain_points"), number("certain_nothing"),
                          percent("certain_nothing_right", "certain_nothing"), 100 * number("all_recall"),
                          100 * number("all_precision"), 100 * number("all_f1"), number("draw_ms"), number("trace_ms"),
                          number("megabytes"), number("node_visits"))
                  .c_str());
}

void append(const std::string& file, const Record& asked, std::span<const Record> sources)
{
    std::vector<Column> columns = asked_columns();
    columns.insert(columns.end(), source_columns().begin(), source_columns().end());
    const bool    fresh = !std::filesystem::exists(file) || std::filesystem::file_size(file) == 0;
    std::ofstream stream(file, std::ios::app | std::ios::binary);
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
    if (!picture.output.empty()) require_output(picture.output, {".csv"});
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
        for (const Record& source : sources) print_line(source);
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
