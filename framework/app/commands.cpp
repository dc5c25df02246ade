#include "app/commands.h"

#include "app/cases.h"
#include "app/python_script.h"
#include "check/hit_files.h"
#include "compare/image_io.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/files.h"
#include "harness/choose_technique.h"
#include "harness/measured_run.h"
#include "harness/no_hits.h"

#include <cstdio>

namespace ssrlab {
namespace {

std::string status_legend()
{
    std::string text;
    for (size_t i = 0; i < trace_status_names.size(); ++i)
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", i, trace_status_names[i]);
    return text;
}

TraceCounts counts_of(const TraceImage& result)
{
    TraceCounts counts;
    for (const TraceStatus status : result.status) {
        counts.rays += status != TraceStatus::not_traced ? 1 : 0;
        counts.hits += status == TraceStatus::hit ? 1 : 0;
    }
    return counts;
}

} // namespace

Image hits_image(const TraceImage& result, const std::string& technique, const std::vector<std::string>& parameters)
{
    Image image                           = hits_image(result);
    image.metadata["ssrlab:status_names"] = status_legend();
    image.metadata["ssrlab:technique"]    = technique;
    image.metadata["ssrlab:parameters"]   = fmt::format("{}", fmt::join(parameters, " "));
    return image;
}

int trace_hits(const CommonOptions& common, const PictureOptions& options)
{
    if (std::filesystem::is_directory(options.scene)) return trace_cases(common, options);
    const Catalogue catalogue = load_catalogue(common.technique_dirs);
    const auto      asked     = asked_techniques(catalogue, options.technique, options.parameters);
    require_output(options.output, {".exr"});
    Stage stage                    = open_stage(common, catalogue, options);
    const auto [technique, choice] = choose_technique(stage, asked, common.quiet);
    const LabPtr lab               = make_lab(stage, *technique, choice.values, choice.settings.trace);
    say(common, lacked_channel_text(stage.scene, catalogue, choice.settings.trace));
    const TraceImage result = trace_gbuffer(stage.gpu, *make_tracer(stage.gpu, lab));
    write_image(options.output, hits_image(result, technique->id, options.parameters));
    say(common, no_hits_text(*technique, choice.settings.trace, stage.scene, counts_of(result)));
    std::puts(options.output.c_str());
    require_possible(result, declared_steps(*technique, choice.values));
    return report_messages(stage);
}

int write_gbuffer(const CommonOptions& common, const PictureOptions& options)
{
    if (!options.size.empty()) size_option(options.size);
    require_output(options.output, {".exr"});
    Stage stage = open_stage(common, load_catalogue(common.technique_dirs), options);
    write_image(options.output, frame_image(read_gbuffer(stage.gpu, *stage.gbuffer)));
    std::puts(options.output.c_str());
    return report_messages(stage);
}

int plot_results(const std::string& folder, double bandwidth_gbps)
{
    const std::filesystem::path given(folder),
        table = given.filename() == "results.csv" ? given : given / "results.csv";
    if (!std::filesystem::exists(table)) throw_spec_error("{}: no such file; ssrlab run writes it", table.string());
    std::vector<std::string> arguments = {folder};
    if (bandwidth_gbps > 0) arguments.push_back(fmt::format("--bandwidth-gbps={}", bandwidth_gbps));
    run_python("experiments/plot", arguments);
    return 0;
}

} // namespace ssrlab
