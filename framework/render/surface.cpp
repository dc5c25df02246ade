#include "render/surface.h"

#include "core/files.h"
#include "core/names.h"
#include "gpu/shader.h"
#include "render/manifest.h"
#include "render/plugin_folders.h"

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> manifest_keys = {"name", "summary", "cite", "needs", "defines"};
const std::vector<std::string> known_needs   = {"gradient", "solid"};

bool is_surface(const fs::path& folder) { return fs::exists(folder / "surface.toml"); }

} // namespace

Surface load_surface(const fs::path& folder)
{
    const TomlFile file = read_toml(folder / "surface.toml");
    Surface        surface;
    surface.folder = folder;
    surface.id     = read_folder_id(file, folder, "surface model");
    toml_known_keys(file, file.root, "key", manifest_keys);
    read_about(file, "the surface model", surface);
    if (const toml::node* node = file.root.get("needs")) {
        const auto needs       = read_known(file, *node, "needs", "part of the G-buffer", known_needs);
        surface.needs_gradient = std::ranges::count(needs, "gradient") > 0;
        surface.needs_solid    = std::ranges::count(needs, "solid") > 0;
    }
    if (const toml::node* node = file.root.get("defines")) {
        surface.defines = toml_texts(file, *node, "defines");
        for (const std::string& macro : surface.defines)
            if (!is_glsl_name(macro)) toml_refuse(file, *node, "defines", "names that GLSL accepts for macros");
    }
    for (const char* part : {"meeting.glsl", "held.glsl"})
        if (!fs::exists(folder / part))
            throw_spec_error("{}: missing; a surface model has surface.toml, meeting.glsl and held.glsl",
                             short_path(folder / part));
    return surface;
}

std::vector<Surface> list_surfaces(std::span<const fs::path> extra_dirs)
{
    std::vector<Surface> surfaces;
    for (const fs::path& folder : plugin_folders(shader_folder() / "surfaces", is_surface, 0))
        append_plugin(surfaces, load_surface(folder), "surface models");
    for (const fs::path& dir : plugin_dirs(extra_dirs))
        for (const fs::path& folder : plugin_folders(dir, is_surface, 1))
            append_plugin(surfaces, load_surface(folder), "surface models");
    return surfaces;
}

const Surface& find_surface(std::span<const Surface> surfaces, const std::string& id)
{
    const auto found = std::ranges::find(surfaces, id, &Surface::id);
    if (found != surfaces.end()) return *found;
    std::vector<std::string> known;
    std::ranges::transform(surfaces, std::back_inserter(known), &Surface::id);
    throw SpecError(unknown_name("surface model", id, known));
}

} // namespace ssrlab
