// Reading and tracing the folder that export-cases wrote.
#include "app/cases.h"

#include "compare/image_io.h"
#include "compare/validate_result.h"
#include "core/error.h"
#include "core/files.h"
#include "harness/experiment.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace ssrlab {
namespace fs = std::filesystem;
using Json   = nlohmann::ordered_json;

std::vector<ExportedCase> read_cases(const fs::path& folder)
{
    const fs::path file = folder / "manifest.json";
    if (!fs::exists(file)) throw_spec_error("{}: no such file; ssrlab export-cases writes it", short_path(file));
    std::vector<ExportedCase> cases;
    try {
        const Json manifest = Json::parse(read_file(file));
        for (const Json& entry : manifest.at("frames")) {
            ExportedCase one{entry.at("name"), folder / entry.at("frame").get<std::string>(), {}};
            for (const auto& [name, value] : entry.at("settings").items())
                one.settings.push_back(name + "=" + value.get<std::string>());
            cases.push_back(std::move(one));
        }
    } catch (const Json::exception& error) {
        throw_spec_error("{}: {}", short_path(file), error.what());
    }
    return cases;
}

int trace_cases(const CommonOptions& common, const PictureOptions& options)
{
    const Catalogue                 catalogue = load_catalogue(common.technique_dirs);
    const Technique&                technique = find_technique(catalogue.techniques, options.technique);
    const std::vector<ExportedCase> cases     = read_cases(options.scene);
    fs::create_directories(options.output);
    Gpu gpu = open_gpu(common.gpu);
    for (const ExportedCase& one : cases) {
        std::vector<std::string> pairs = one.settings;
        // What the user gives replaces the case's own: a setting may stand once.
        std::erase_if(pairs, [&](const std::string& pair) {
            const std::string start = pair.substr(0, pair.find('=') + 1);
            return std::ranges::any_of(options.parameters,
                                       [&](const std::string& given) { return given.starts_with(start); });
        });
        pairs.insert(pairs.end(), options.parameters.begin(), options.parameters.end());
        const Choice     choice  = parse_choice(catalogue, technique, pairs);
        const GBufferPtr gbuffer = upload_gbuffer(gpu, load_scene(one.frame.string()).frame->gbuffer);
        const LabPtr     lab     = make_lab(gpu, catalogue, gbuffer, technique, choice.values, choice.settings.trace);
        const TraceImage result  = trace_gbuffer(gpu, *make_tracer(gpu, lab));
        write_image(fs::path(options.output) / (one.name + ".exr"), hits_image(result, technique.id, pairs));
        require_possible(result, declared_steps(technique, choice.values));
    }
    std::puts(fmt::format("{} frames: {}", cases.size(), options.output).c_str());
    return 0;
}

} // namespace ssrlab
