#include "core/error.h"
#include "core/files.h"
#include "scene/load_scene.h"

#include <cstdlib>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view package_prefix     = "package:";
constexpr std::string_view sweethome3d_prefix = "sweethome3d:";

/// The folders into which ./experiments/prepare_scenes, or the user, unpacked data.
std::vector<fs::path> data_folders()
{
    std::vector<fs::path> folders;
    if (const char* folder = std::getenv("SSRLAB_DATA")) {
        if (!fs::is_directory(folder)) throw_spec_error("SSRLAB_DATA = {}: no such folder", folder);
        folders.emplace_back(folder);
    }
    folders.emplace_back(data_root() / "scene_data");
    return folders;
}

fs::path first_existing(const std::vector<fs::path>& candidates, const std::string& reference)
{
    std::error_code error;
    std::string     tried;
    for (const fs::path& candidate : candidates) {
        if (fs::exists(candidate, error)) return candidate;
        tried += "\n  " + candidate.string();
    }
    throw_spec_error("scene data '{}' is not there: run ./experiments/prepare_scenes. Tried:{}", reference, tried);
}

fs::path find_in_package(const std::string& reference)
{
    const std::string rest  = reference.substr(package_prefix.size());
    const size_t      slash = rest.find('/');
    if (slash == std::string::npos || slash == 0 || rest.find("..") != std::string::npos)
        throw_spec_error("'{}' must look like package:NAME/path/inside/the/package", reference);
    std::vector<fs::path> candidates{rest.substr(slash)};
    for (const fs::path& folder : data_folders()) candidates.push_back(folder / rest);
    return first_existing(candidates, reference);
}

fs::path find_sweethome3d(const std::string& reference)
{
    const std::string model = reference.substr(sweethome3d_prefix.size());
    if (model.empty() || model.find('/') != std::string::npos)
        throw_spec_error("'{}' must look like sweethome3d:MODEL", reference);
    std::vector<fs::path> candidates;
    for (const fs::path& folder : data_folders())
        candidates.push_back(folder / "sweethome3d" / model / (model + ".obj"));
    return first_existing(candidates, reference);
}

} // namespace

fs::path find_data(const std::string& reference, const fs::path& folder)
{
    if (reference.starts_with(package_prefix)) return find_in_package(reference);
    if (reference.starts_with(sweethome3d_prefix)) return find_sweethome3d(reference);
    fs::path file = fs::path(reference).is_absolute() ? fs::path(reference) : folder / reference;
    if (!fs::exists(file)) throw_spec_error("{}: no such file", file.string());
    return file;
}

} // namespace ssrlab
