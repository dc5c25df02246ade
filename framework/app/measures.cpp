#include "app/commands.h"
#include "core/error.h"

#include "compare/measures.h"
#include "harness/passes.h"
#include "harness/sequence_state.h"
#include "harness/source_rows.h"

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

constexpr const char* introduction = R"(# Columns

`results.csv` has one row per run, in the columns below. The settings and parameters of the run are
columns, too (`ssrlab list --markdown`). A field without a value is empty, never NaN.

| in a results folder | |
|---|---|
| `results.csv` | one row per run |
| `sequence_summary.csv` | for an experiment with several frames: one row per run without its frame, in the columns of the last table |
| `samples.csv` | every timed frame: run_id, round, pass, ms, cpu_ms; docs/explanation/measuring.md says what a round is |
| `passes.csv` | the passes of each run's frame: whether each ran, how long it took, and why |
| `sources.csv` | for an experiment with `[sources]`: what each source of each run's list answered, and its price |
| `environment.json` | device, driver, commit, command line, seed, specification, and hashes of everything that decides a result |
| `pictures/` | per run: the reflection, right and wrong rays in false colours, and the work per ray |
| `report.html`, `report.md`, `summary.csv`, `plots/` | made from the above by `ssrlab plot` |

## Runs
)";

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

} // namespace

int print_measures(const CommonOptions& common)
{
    const Catalogue               catalogue  = load_catalogue(common.technique_dirs);
    const std::vector<Technique>& techniques = catalogue.techniques;
    Experiment                    everything;
    everything.known_settings = all_settings(catalogue);
    for (const Technique& technique : techniques) everything.techniques.push_back({technique.id, {}, {}, {}, {}});

    // Settings and parameters are listed by `ssrlab list --markdown`.
    std::vector<std::string> elsewhere;
    for (const Setting& setting : everything.known_settings) elsewhere.push_back(setting.name);
    for (const Technique& technique : techniques)
        for (const Parameter& parameter : technique.parameters) elsewhere.push_back(parameter.name);

    std::string text = introduction;
    text += "| column | meaning |\n|---|---|\n";
    for (const Column& column : result_columns(everything, techniques)) {
        if (std::ranges::find(measures(), column.name, &Measure::name) != measures().end()) continue;
        if (std::ranges::find(elsewhere, column.name) != elsewhere.end()) continue;
        text += fmt::format("| {} | {} |\n", code(column.name), column.meaning);
    }
    text += "\n## Measures\nAlso columns. A share is between 0 and 1.\n\n" + measures_markdown();
    text += "\n## Summary of a sequence\n`sequence_summary.csv` has the settings and parameters of the runs, and "
            "these:\n\n";
    text += "| column | meaning |\n|---|---|\n";
    const std::vector<Column> settings = setting_columns(everything, techniques);
    for (const Column& column : summary_columns(everything, techniques))
        if (std::ranges::find(settings, column.name, &Column::name) == settings.end())
            text += fmt::format("| {} | {} |\n", code(column.name), column.meaning);
    text += "\n## Passes of the frames\n`passes.csv` has a row for each pass of each run, in the order of a frame:\n\n";
    text += "| column | meaning |\n|---|---|\n";
    for (const Column& column : pass_columns()) text += fmt::format("| {} | {} |\n", code(column.name), column.meaning);
    text += "\n## Sources of answers\n`sources.csv` has a row for each source of each run's list, in the order of the "
            "list:\n\n";
    text += "| column | meaning |\n|---|---|\n";
    for (const Column& column : source_file_columns())
        text += fmt::format("| {} | {} |\n", code(column.name), column.meaning);
    std::fputs(text.c_str(), stdout);
    return 0;
}

} // namespace ssrlab
