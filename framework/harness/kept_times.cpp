#include "harness/kept_times.h"

#include "core/error.h"
#include "core/files.h"
#include "gpu/disk_cache.h"

#include <nlohmann/json.hpp>

#include <cctype>
#include <cmath>

namespace ssrlab {
namespace {

using Json = nlohmann::json;

KeptTimes read_measurement(const Json& entry)
{
    KeptTimes kept{entry.at("frame"), entry.at("state"), entry.at("rays"), entry.at("ms"), entry.at("left_out")};
    if (kept.ms.empty()) throw_spec_error("'{}' has no times", kept.frame);
    for (const auto& [technique, ms] : kept.ms)
        if (!(ms >= 0 && std::isfinite(ms)))
            throw_spec_error("'{}': expected milliseconds of {}, got {}", kept.frame, technique, ms);
    return kept;
}

} // namespace

std::filesystem::path kept_times_file(const std::string& device)
{
    const std::filesystem::path folder = cache_folder();
    if (folder.empty()) return {};
    std::string name = "exact_" + device;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return folder / (name + ".json");
}

std::vector<KeptTimes> read_kept_times(const std::filesystem::path& file)
{
    if (!std::filesystem::exists(file)) return {};
    std::vector<KeptTimes> measurements;
    try {
        const Json json = Json::parse(read_file(file));
        for (const Json& entry : json.at("measurements")) measurements.push_back(read_measurement(entry));
    } catch (const std::exception& error) {
        throw_spec_error("{}: {}", file.string(), error.what());
    }
    return measurements;
}

void write_kept_times(const std::filesystem::path& file, const std::string& device,
                      const std::vector<KeptTimes>& measurements)
{
    Json list = Json::array();
    for (const KeptTimes& kept : measurements)
        list.push_back({{"frame", kept.frame},
                        {"state", kept.state},
                        {"rays", kept.rays},
                        {"ms", kept.ms},
                        {"left_out", kept.left_out}});
    const Json      json{{"device", device}, {"measurements", list}};
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    if (error) throw_failure("{}: cannot be created: {}", file.parent_path().string(), error.message());
    write_file_atomically(file, json.dump(1) + "\n");
}

} // namespace ssrlab
