#include "harness/environment.h"

#include "compare/measures.h"
#include "core/error.h"
#include "core/files.h"
#include "core/version.h"
#include "harness/picture.h"
#include "scene/load_scene.h"

#include <sys/utsname.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <thread>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

std::string now_utc()
{
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm           utc = {};
    ::gmtime_r(&now, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text.data();
}

/// Names and contents of all files of a scene.
std::string scene_hash(const std::string& name)
{
    std::string listing;
    for (const fs::path& file : scene_files(name)) {
        listing += fmt::format("{} {}\n", file.filename().string(), content_hash(read_file(file)));
    }
    return content_hash(listing);
}

/// Of this program, whatever lies at its place by now.
const std::string& program_hash()
{
    static const std::string hash = content_hash(read_file("/proc/self/exe"));
    return hash;
}

/// How many threads a software device has.
std::string threads_text()
{
    const char* told = std::getenv("LP_NUM_THREADS");
    return fmt::format("{}{}", std::thread::hardware_concurrency(),
                       told != nullptr ? fmt::format(" (LP_NUM_THREADS={})", told) : "");
}

/// How the true picture shows reflections.
std::string true_picture_text(const Experiment& experiment)
{
    const auto exponent = true_exponent(experiment);
    return exponent ? fmt::format("reflectance = metallic, metallic_exponent = {}", *exponent) : "reflectance = ggx";
}

} // namespace

std::map<std::string, std::string> describe_device(const GpuInfo& device)
{
    std::map<std::string, std::string> described = {{"device", device.name},
                                                    {"driver", device.driver},
                                                    {"storage", storage_text(device)},
                                                    {"passes", passes_text(device)}};
    if (device.processor.empty()) return described;
    described["processor"] = device.processor;
    described["threads"]   = threads_text();
    return described;
}

std::map<std::string, std::string> describe_technique(const Technique& technique)
{
    std::map<std::string, std::string> described = {{"technique " + technique.id, folder_hash(technique.folder)}};
    for (const Structure& structure : technique.structures)
        described["structure " + structure.id] = folder_hash(structure.folder);
    return described;
}

std::map<std::string, std::string> describe_identity(const Experiment&          experiment,
                                                     std::span<const Technique> techniques, const GpuInfo& device)
{
    std::map<std::string, std::string> identity = describe_device(device);
    identity["specification"]                   = content_hash(experiment.text);
    identity["program"]                         = program_hash();
    identity["shaders"]                         = folder_hash(data_root() / "shaders");
    for (const TechniqueSweep& sweep : experiment.techniques)
        identity.merge(describe_technique(find_technique(techniques, sweep.id)));
    const auto add_surfaces = [&](const ValueLists& settings) {
        const auto values = settings.find("surface");
        if (values == settings.end()) return;
        for (const double value : values->second) {
            const Surface& surface            = experiment.known_surfaces[static_cast<size_t>(value)];
            identity["surface " + surface.id] = folder_hash(surface.shaders);
        }
    };
    add_surfaces(experiment.settings);
    for (const TechniqueSweep& sweep : experiment.techniques) add_surfaces(sweep.settings);
    for (const std::string& scene : experiment.scenes) identity["scene " + scene] = scene_hash(scene);
    return identity;
}

Environment describe_environment(const Experiment& experiment, std::span<const Technique> techniques,
                                 const GpuInfo& device, const std::string& command_line)
{
    utsname system = {};
    ::uname(&system);
    Environment environment;
    environment.identity   = describe_identity(experiment, techniques, device);
    auto& notes            = environment.notes;
    notes["title"]         = experiment.title;
    notes["experiment"]    = experiment.name;
    notes["samples"]       = "samples.csv";
    notes["specification"] = experiment.text;
    notes["command_line"]  = command_line;
    notes["true_picture"]  = true_picture_text(experiment);
    notes["seed"]          = std::to_string(experiment.measure.seed);
    notes["started"]       = now_utc();
    notes["commit"]        = built_commit();
    notes["version"]       = SSRLAB_VERSION;
    notes["compiler"]      = __VERSION__;
    notes["system"]        = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
    notes["device_type"]   = device.type;
    notes["vulkan"]        = device.api_version;
    // What a search for targets turns, so that plots know which neighbours on a line differ in accuracy.
    for (const TechniqueSweep& sweep : experiment.techniques) {
        for (const Accuracy& accuracy : find_technique(techniques, sweep.id).accuracy) {
            const std::string entry =
                fmt::format("{}.{}={}", sweep.id, accuracy.parameter, accuracy.higher_is_better ? "higher" : "lower");
            if (notes["accuracy"].find(entry) == std::string::npos)
                notes["accuracy"] += (notes["accuracy"].empty() ? "" : " ") + entry;
        }
    }
    for (const Measure& measure : measures())
        notes["units"] += fmt::format("{}{}={}", notes["units"].empty() ? "" : "; ", measure.name, measure.unit);
    for (const Setting& parameter : experiment.known_settings)
        if (parameter.table == "passes")
            notes["pass_parameters"] += (notes["pass_parameters"].empty() ? "" : " ") + parameter.name;
    return environment;
}

} // namespace ssrlab
