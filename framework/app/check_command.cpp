#include "app/check_command.h"

#include "app/commands.h"
#include "check/report.h"
#include "check/run_check.h"
#include "check/stability.h"
#include "core/error.h"
#include "core/files.h"
#include "core/printable.h"
#include "core/version.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace ssrlab {
namespace {

/// A technique of the catalogue, those of a folder, or all.
std::vector<Technique> chosen(const Catalogue& catalogue, const std::string& subject)
{
    if (subject.empty()) return catalogue.techniques;
    if (!std::filesystem::is_directory(subject)) return {find_technique(catalogue.techniques, subject)};
    std::vector<Technique> below;
    const auto             root = std::filesystem::weakly_canonical(subject).string();
    std::ranges::copy_if(catalogue.techniques, std::back_inserter(below), [&](const Technique& technique) {
        return std::filesystem::weakly_canonical(technique.folder).string().starts_with(root);
    });
    return below;
}

Catalogue catalogue_with(const CommonOptions& common, const std::string& subject)
{
    std::vector<std::filesystem::path> dirs = common.technique_dirs;
    if (std::filesystem::is_directory(subject)) dirs.emplace_back(subject);
    return load_catalogue(dirs);
}

/// Defaults with what -p says. Settings of the trace belong to the cases.
std::vector<ParameterValues> values_of(const std::vector<Technique>& techniques, const std::vector<std::string>& pairs)
{
    std::vector<ParameterValues> values;
    for (const Technique& technique : techniques) {
        values.push_back(default_values(technique));
        for (const std::string& pair : pairs) {
            const auto equals = pair.find('=');
            if (equals == std::string::npos) throw_spec_error("-p {}: expected name=value", pair);
            const std::string name = pair.substr(0, equals), place = "-p " + pair;
            values.back()[name] =
                parse_parameter(find_parameter(technique, name, place), pair.substr(equals + 1), place);
        }
    }
    return values;
}

int show_ray(Gpu& gpu, const Catalogue& catalogue, const std::vector<Technique>& techniques,
             const std::vector<ParameterValues>& values, const HardCaseOptions& options)
{
    const auto  colon = options.ray.find(':');
    size_t      setup = 0, ray = 0;
    const char* end  = options.ray.data() + options.ray.size();
    const bool  read = colon != std::string::npos &&
                      std::from_chars(options.ray.data(), end, setup).ptr == options.ray.data() + colon &&
                      std::from_chars(options.ray.data() + colon + 1, end, ray).ptr == end;
    if (!read || options.only_case.empty())
        throw_spec_error("--ray: expected SETUP:RAY together with --case, got '{}'", options.ray);
    for (size_t i = 0; i < techniques.size(); ++i)
        std::puts(
            describe_ray(gpu, catalogue, techniques[i], values[i], find_case(options.only_case), setup, ray).c_str());
    return 0;
}

/// Jitter and depth formats, technique by technique; printed as they are written.
std::string measure_stability(Gpu& gpu, const Catalogue& catalogue, const std::vector<Technique>& techniques)
{
    std::vector<JitterRow> jitter;
    std::vector<FormatRow> formats;
    for (const Technique& technique : techniques) {
        jitter.push_back(measure_jitter(gpu, catalogue, technique));
        std::ranges::copy(measure_formats(gpu, catalogue, technique), std::back_inserter(formats));
    }
    std::string text = stability_markdown(jitter, formats);
    std::puts(text.c_str());
    return text;
}

} // namespace

int check_techniques(const CommonOptions& common, const HardCaseOptions& options)
{
    const Catalogue                    catalogue  = catalogue_with(common, options.subject);
    const std::vector<Technique>       techniques = chosen(catalogue, options.subject);
    const std::vector<ParameterValues> values     = values_of(techniques, options.parameters);
    Gpu                                gpu        = open_gpu(common.gpu);
    if (!options.ray.empty()) return show_ray(gpu, catalogue, techniques, values, options);

    Gpu robust;
    if (!options.quick) {
        GpuOptions bounds_checked           = common.gpu;
        bounds_checked.robust_buffer_access = true;
        robust                              = open_gpu(bounds_checked);
    }
    size_t broken = 0;
    std::puts(table_head().c_str());
    const auto rows =
        run_check(gpu, options.quick ? nullptr : &robust,
                  {catalogue, techniques, options.only_case, {.double_precision = !options.quick}, values},
                  [&](const CaseRow& row) {
                      broken += row.breaks > 0;
                      std::printf("%s\n%s", table_line(row).c_str(), table_findings(row).c_str());
                      std::fflush(stdout);
                  });
    std::vector<std::string> more = check_refusals();
    if (options.only_case.empty()) std::ranges::copy(check_finds(rows), std::back_inserter(more));
    for (const std::string& line : more) {
        ++broken;
        std::puts(line.c_str());
    }
    for (const std::string& message : validation_messages(gpu)) {
        ++broken;
        std::fprintf(stderr, "validation: %s\n", message.c_str());
    }
    const std::string verdict   = fmt::format("{} of {} rows hold what the technique claims",
                                              std::ranges::count(rows, 0U, &CaseRow::breaks), rows.size());
    const std::string stability = options.stability ? measure_stability(gpu, catalogue, techniques) : "";
    if (!options.markdown.empty())
        write_file_atomically(options.markdown,
                              fmt::format("# Hard cases\nWritten by `{}`. Commit: {}. Device: {}.\n\n{}.\n\n{}{}",
                                          options.command_line, built_commit(), gpu.info.name, verdict,
                                          markdown_table(rows), stability));
    std::puts(verdict.c_str());
    if (broken > 0) std::printf("the check fails: %s, each above\n", counted(broken, "finding").c_str());
    return broken == 0 ? 0 : 1;
}

} // namespace ssrlab
