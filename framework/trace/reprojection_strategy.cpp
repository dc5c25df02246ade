#include "trace/reprojection_strategy.h"

#include "core/files.h"
#include "trace/manifest.h"

namespace ssrlab {

Reprojection load_reprojection(const std::filesystem::path& folder)
{
    static const std::vector<std::string> keys = {"name", "summary", "cite", "parameters"};
    const TomlFile                        file = read_toml(folder / "reprojection.toml");
    Reprojection                          strategy;
    strategy.folder = folder;
    strategy.id     = read_folder_id(file, folder, "reprojection strategy");
    toml_known_keys(file, file.root, "key", keys);
    read_about(file, "the reprojection strategy", strategy);
    strategy.parameters = read_parameters(file);
    for (Parameter& parameter : strategy.parameters) {
        if (!parameter.defines.empty())
            throw_spec_error("{}:1: 'defines' of '{}' belongs to techniques and structures", file.path, parameter.name);
        parameter.name.insert(0, strategy.id + ".");
    }
    if (!std::filesystem::exists(folder / "reproject.glsl"))
        throw_spec_error("{}: missing; it holds the function reproject()", short_path(folder / "reproject.glsl"));
    return strategy;
}

} // namespace ssrlab
