#include "trace/surface.h"

#include "core/files.h"
#include "core/names.h"
#include "trace/manifest.h"

#include <algorithm>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> manifest_keys = {"name", "summary", "cite", "needs", "defines", "shaders"};
const std::vector<std::string> known_needs   = {"gradient", "solid"};

std::vector<std::string> read_defines(const TomlFile& file, const toml::node& node)
{
    std::vector<std::string> macros = toml_texts(file, node, "defines");
    for (const std::string& macro : macros)
        if (!glsl_name_fault(macro).empty()) toml_refuse(file, node, "defines", "names that GLSL accepts for macros");
    return macros;
}

} // namespace

Surface load_surface(const fs::path& folder)
{
    const TomlFile file = read_toml(folder / "surface.toml");
    Surface        surface;
    surface.folder  = folder;
    surface.shaders = folder;
    surface.id      = read_folder_id(file, folder, "surface model");
    toml_known_keys(file, file.root, "key", manifest_keys);
    read_about(file, "the surface model", surface);
    if (const toml::node* node = file.root.get("needs")) {
        const auto needs       = read_known(file, *node, "needs", "part of the G-buffer", known_needs);
        surface.needs_gradient = std::ranges::count(needs, "gradient") > 0;
        surface.needs_solid    = std::ranges::count(needs, "solid") > 0;
    }
    if (const toml::node* node = file.root.get("defines")) surface.defines = read_defines(file, *node);
    if (const toml::node* node = file.root.get("shaders"))
        surface.shaders = (folder / toml_text(file, *node, "shaders")).lexically_normal();
    for (const char* part : {"meeting.glsl", "held.glsl"})
        if (!fs::exists(surface.shaders / part))
            throw_spec_error("{}: missing; a surface model has surface.toml, meeting.glsl and held.glsl",
                             short_path(surface.shaders / part));
    return surface;
}

} // namespace ssrlab
