#include "app/sources_command.h"

#include "compare/all_rays.h"
#include "core/error.h"
#include "core/size.h"
#include "harness/choice.h"
#include "harness/csv.h"
#include "harness/experiment.h"
#include "sources/answer_rays.h"
#include "truth/scene_truth.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

namespace ssrlab {
namespace {

constexpr std::array meeting_classes = {TruthClass::visible, TruthClass::hidden, TruthClass::off_screen,
                                        TruthClass::behind_camera, TruthClass::facing_away};

/// A row of the file: columns and their texts, in order.
using Row = std::vector<std::pair<std::string, std::string>>;

std::string line_of(const Row& row, std::string Row::value_type::*part)
{
    CsvRecord fields;
    for (const auto& entry : row) fields.push_back(entry.*part);
    return csv_line(fields);
}

std::string text_of(double value) { return fmt::format("{:.4g}", value); }
std::string text_of(size_t value) { return std::to_string(value); }
std::string text_of(std::optional<double> value) { return value ? fmt::format("{:.6g}", *value) : ""; }

/// One source's columns. so_far: the merged answers of the list up to it.
void add_source(Row& row, size_t place, const SourceTurn& turn, const SourceCounts& counts, const AllRays& so_far)
{
    const auto add = [&](std::string column, const auto& value) {
        row.emplace_back(std::move(column), text_of(value));
    };
    add("place", place);
    row.emplace_back("source", turn.source);
    add("handed", counts.handed);
    add("meeting", counts.meeting);
    add("points", counts.points);
    add("right", counts.right);
    add("certain_points", counts.certain_points);
    add("certain_right", counts.certain_right);
    add("certain_nothing", counts.certain_nothing);
    add("certain_nothing_right", counts.certain_nothing_right);
    for (const TruthClass cls : meeting_classes) {
        const auto index = static_cast<size_t>(cls);
        add(fmt::format("handed_{}", truth_class_names[index]), counts.handed_of_class[index]);
        add(fmt::format("right_{}", truth_class_names[index]), counts.right_of_class[index]);
    }
    add("draw_ms", turn.draw_ms);
    add("trace_ms", turn.trace_ms);
    add("shade_ms", turn.shade_ms);
    add("merge_ms", turn.merge_ms);
    add("megabytes", turn.megabytes);
    add("node_visits", static_cast<size_t>(turn.node_visits));
    add("all_rays", so_far.rays);
    add("all_meeting", so_far.meeting);
    add("all_recall", so_far.recall);
    add("all_precision", so_far.precision);
    add("all_f1", so_far.f1);
}

double percent(std::optional<double> share) { return share ? 100 * *share : 0; }
double percent(size_t part, size_t whole) { return whole > 0 ? 100 * double(part) / double(whole) : 0; }

void print_line(const SourceTurn& turn, const SourceCounts& counts, const AllRays& so_far)
{
    std::puts(fmt::format("  {:8} handed {:6} ({:5.1f} % meet)  points {:6}, {:5.1f} % right  certain {:6}, {:5.1f} % "
                          "right  nothing {:6}, {:5.1f} % right"
                          "  all: recall {:5.1f} precision {:5.1f} F1 {:5.2f} %  draw {:.1f} ms, trace {:.1f} ms, "
                          "{:.1f} MB, {} visits",
                          turn.source, counts.handed, percent(counts.meeting, counts.handed), counts.points,
                          percent(counts.right, counts.points), counts.certain_points,
                          percent(counts.certain_right, counts.certain_points), counts.certain_nothing,
                          percent(counts.certain_nothing_right, counts.certain_nothing), percent(so_far.recall),
                          percent(so_far.precision), percent(so_far.f1), turn.draw_ms, turn.trace_ms, turn.megabytes,
                          turn.node_visits)
                  .c_str());
}

void append(const std::string& file, const std::vector<Row>& rows)
{
    const bool    fresh = !std::filesystem::exists(file) || std::filesystem::file_size(file) == 0;
    std::ofstream stream(file, std::ios::app);
    if (fresh) stream << line_of(rows.front(), &Row::value_type::first);
    for (const Row& row : rows) stream << line_of(row, &Row::value_type::second);
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
    if (!picture.output.empty()) require_ending(picture.output, {".csv"});
    std::vector<std::vector<ListedSource>> lists;
    for (const std::string& list : options.lists) lists.push_back(parse_sources(list, "--sources " + list));
    const HandOn      hand_on   = parse_hand_on(options.hand_on);
    const std::string settings  = fmt::format("{}", fmt::join(picture.parameters, ";"));
    const Catalogue   catalogue = load_catalogue(common.technique_dirs);
    const Technique&  technique = find_technique(catalogue.techniques, picture.technique);
    const Choice      choice    = parse_choice(catalogue, technique, picture.parameters);
    Stage             stage     = open_stage(common, catalogue, picture);
    SourceContext     context   = make_source_context(stage, technique, choice.values, choice.settings);
    for (int frame = picture.at.frame - 1; frame >= 0; --frame)
        context.earlier.push_back(
            view_at(stage.scene, picture.view, stage.view.size_px, {frame, picture.at.jitter_phases}));
    const SceneTruth truth = scene_truth(SceneBvh(stage.scene), stage.scene, context.image, choice.settings.trace);
    if (const std::string why = drawn_elsewhere(off_surface_share(truth)); !why.empty())
        throw_failure("no scene truth: {}", why);
    std::puts(fmt::format("{} {} {}, {}, surface {}", picture.scene, picture.view, size_text(stage.view.size_px),
                          technique.id, choice.settings.trace.surface)
                  .c_str());
    for (size_t l = 0; l < lists.size(); ++l) {
        const AnsweredRays     answered = answer_rays(context, lists[l], hand_on);
        const Row              identity = {{"scene", picture.scene},
                                           {"view", picture.view},
                                           {"size", size_text(stage.view.size_px)},
                                           {"technique", technique.id},
                                           {"surface", choice.settings.trace.surface},
                                           {"settings", settings},
                                           {"sources", options.lists[l]},
                                           {"hand_on", options.hand_on}};
        std::vector<Row>       rows;
        std::vector<RayAnswer> so_far(answered.answers.size());
        for (size_t place = 0; place < answered.turns.size(); ++place) {
            const SourceTurn& turn = answered.turns[place];
            for (size_t k = 0; k < turn.pixels.size(); ++k)
                so_far[turn.pixels[k]] = merged(so_far[turn.pixels[k]], turn.answers[k]);
            const SourceCounts counts = count_source(turn, truth, context.image);
            const AllRays      all    = compare_all_rays(so_far, truth, context.image);
            print_line(turn, counts, all);
            Row& row = rows.emplace_back(identity);
            add_source(row, place, turn, counts, all);
            row.emplace_back("device", stage.gpu.info.name);
        }
        if (!picture.output.empty()) append(picture.output, rows);
    }
    return report_messages(stage);
}

} // namespace ssrlab
