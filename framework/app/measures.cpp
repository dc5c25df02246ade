#include "app/commands.h"
#include "core/error.h"

#include "compare/measures.h"
#include "harness/passes.h"
#include "harness/sequence_state.h"

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace {

constexpr const char* introduction = R"(# Results

`ssrlab measures` writes this page; do not edit it. `ssrlab run` makes one folder per experiment
here, which git ignores. `reference/` holds small committed runs to compare with.

| in a results folder | |
|---|---|
| `results.csv` | one row per run, in the columns below |
| `sequence_summary.csv` | of an experiment with several frames: one row per run without its frame, in the columns of the last table |
| `samples.csv` | every timed frame: run_id, round, pass, ms, cpu_ms; docs/measuring.md says what a round is |
| `passes.csv` | the passes of each run's frame: whether each ran, how long it took, and why |
| `environment.json` | device, driver, commit, command line, seed, specification, and hashes of everything that decides a result |
| `pictures/` | per run: the reflection, right and wrong rays in false colours, and the work per ray |
| `report.html`, `report.md`, `summary.csv`, `plots/` | made from the above by `ssrlab plot` |

## Columns
A field without a value is empty, never NaN. Parameters of techniques are marked. They are empty for
techniques that do not have them.
)";

std::string code(std::string_view text) { return fmt::format("`{}`", text); }

} // namespace

int print_measures(const CommonOptions& common)
{
    const auto techniques = list_techniques(common.technique_dirs);
    Experiment everything;
    for (const Technique& technique : techniques) everything.techniques.push_back({technique.id, {}, {}, {}});

    std::vector<std::string> parameters;
    for (const Technique& technique : techniques)
        for (const Parameter& parameter : technique.parameters) parameters.push_back(parameter.name);

    std::string text = introduction;
    text += "\n| column | meaning |\n|---|---|\n";
    for (const Column& column : result_columns(everything, techniques)) {
        if (std::ranges::find(measures(), column.name, &Measure::name) != measures().end()) continue;
        const bool is_parameter = std::ranges::find(parameters, column.name) != parameters.end();
        text += fmt::format("| {} | {}{} |\n", code(column.name), is_parameter ? "parameter: " : "", column.meaning);
    }
    text += "\n## Measures\nAlso columns. A share is between 0 and 1.\n\n" + measures_markdown();
    text += "\n## Summary of a sequence\n`sequence_summary.csv` has the settings and parameters above, and these:\n\n";
    text += "| column | meaning |\n|---|---|\n";
    const std::vector<Column> settings = setting_columns(everything, techniques);
    for (const Column& column : summary_columns(everything, techniques))
        if (std::ranges::find(settings, column.name, &Column::name) == settings.end())
            text += fmt::format("| {} | {} |\n", code(column.name), column.meaning);
    text += "\n## Passes of the frames\n`passes.csv` has a row for each pass of each run, in the order of a frame:\n\n";
    text += "| column | meaning |\n|---|---|\n";
    for (const Column& column : pass_columns()) text += fmt::format("| {} | {} |\n", code(column.name), column.meaning);
    std::fputs(text.c_str(), stdout);
    return 0;
}

} // namespace ssrlab
