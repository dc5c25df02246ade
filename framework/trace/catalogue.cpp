#include "trace/catalogue.h"

#include "core/error.h"
#include "core/files.h"
#include "core/names.h"
#include "gpu/shader.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

bool is_technique(const fs::path& folder)
{
    return fs::exists(folder / "technique.toml") || fs::exists(folder / "trace.glsl");
}

bool is_structure(const fs::path& folder) { return fs::exists(folder / "structure.toml"); }

bool is_reprojection(const fs::path& folder) { return fs::exists(folder / "reprojection.toml"); }

bool is_surface(const fs::path& folder) { return fs::exists(folder / "surface.toml"); }

/// No technique, but what belongs beside techniques.
bool is_addition(const fs::path& folder)
{
    return is_structure(folder) || is_reprojection(folder) || is_surface(folder);
}

/// Of a directory of techniques: itself or the folders in it, down to those `deepest` levels farther in.
std::vector<fs::path> folders_in(const fs::path& dir, bool (*wanted)(const fs::path&), int deepest)
{
    if (!fs::is_directory(dir)) throw_spec_error("{}: no such directory of techniques", short_path(dir));
    std::vector<fs::path> folders;
    if (wanted(dir)) folders.push_back(fs::weakly_canonical(dir));
    constexpr auto skip = fs::directory_options::skip_permission_denied;
    for (auto entry = fs::recursive_directory_iterator(dir, skip); entry != fs::recursive_directory_iterator();
         ++entry) {
        if (entry.depth() == deepest) entry.disable_recursion_pending();
        if (entry->is_directory() && wanted(entry->path())) folders.push_back(entry->path());
    }
    std::ranges::sort(folders);
    return folders;
}

/// The in-tree directory, then those in $SSRLAB_TECHNIQUES, then the others.
std::vector<fs::path> technique_dirs(std::span<const fs::path> extra_dirs)
{
    std::vector<fs::path> dirs{data_root() / "techniques"};
    const char*           variable = std::getenv("SSRLAB_TECHNIQUES");
    const std::string     list     = variable == nullptr ? "" : variable;
    for (size_t start = 0; start < list.size();) {
        const size_t end = std::min(list.find(':', start), list.size());
        if (end > start) dirs.emplace_back(list.substr(start, end - start));
        start = end + 1;
    }
    dirs.insert(dirs.end(), extra_dirs.begin(), extra_dirs.end());
    return dirs;
}

/// The same folder may be named twice, two folders of one id may not.
template <typename Item> void append(std::vector<Item>& items, Item item, const std::string& kind)
{
    const auto same = std::ranges::find(items, item.id, &Item::id);
    if (same == items.end())
        items.push_back(std::move(item));
    else if (!fs::equivalent(same->folder, item.folder))
        throw_spec_error("two {} are called '{}': {} and {}", kind, item.id, short_path(same->folder),
                         short_path(item.folder));
}

template <typename Item> const Item& find(std::span<const Item> items, const std::string& id, const std::string& kind)
{
    const auto found = std::ranges::find(items, id, &Item::id);
    if (found != items.end()) return *found;
    std::vector<std::string> known;
    std::ranges::transform(items, std::back_inserter(known), &Item::id);
    throw SpecError(unknown_name(kind, id, known) + "; --techniques DIR adds others");
}

[[noreturn]] void refuse_fastest_exact(std::span<const Technique> techniques)
{
    std::vector<std::string> names;
    for (const Technique& technique : techniques)
        if (technique.exact) names.push_back(technique.id);
    throw_spec_error("'{}' is measured and chosen only by commands that take one frame (render, trace, ray, plan, "
                     "sources, view); expected a technique's name here, as of the exact ones: {}",
                     fastest_exact, fmt::join(names, ", "));
}

/// The word would mean two things on the command line.
void refuse_reserved_name(const Technique& technique)
{
    if (technique.id == fastest_exact)
        throw_spec_error("{}: a technique cannot be called '{}', which stands for the fastest exact technique on the "
                         "command line; rename the folder",
                         short_path(technique.folder), fastest_exact);
}

} // namespace

Catalogue load_catalogue(std::span<const fs::path> extra_dirs)
{
    const std::vector<fs::path> dirs = technique_dirs(extra_dirs);
    Catalogue                   catalogue;
    for (const fs::path& folder : folders_in(shader_folder() / "surfaces", is_surface, 1))
        append(catalogue.surfaces, load_surface(folder), "surface models");
    for (const fs::path& dir : dirs) {
        for (const fs::path& folder : folders_in(dir, is_structure, 1))
            append(catalogue.structures, load_structure(folder), "structures");
        for (const fs::path& folder : folders_in(dir, is_surface, 1))
            append(catalogue.surfaces, load_surface(folder), "surface models");
        for (const fs::path& folder : folders_in(dir, is_reprojection, 1))
            append(catalogue.reprojections, load_reprojection(folder), "reprojection strategies");
    }
    for (const fs::path& dir : dirs) {
        const std::vector<fs::path> folders = folders_in(dir, is_technique, 0);
        if (folders.empty() && folders_in(dir, is_addition, 1).empty())
            throw_spec_error("{}: holds no technique (a folder with technique.toml)", short_path(dir));
        for (const fs::path& folder : folders) {
            Technique technique = load_technique(folder, catalogue.structures);
            refuse_reserved_name(technique);
            append(catalogue.techniques, std::move(technique), "techniques");
        }
    }
    return catalogue;
}

const Technique& find_technique(std::span<const Technique> techniques, const std::string& id)
{
    if (id == fastest_exact) refuse_fastest_exact(techniques);
    return find(techniques, id, "technique");
}

const Surface& find_surface(std::span<const Surface> surfaces, const std::string& id)
{
    return find(surfaces, id, "surface model");
}

const Reprojection& find_reprojection(std::span<const Reprojection> reprojections, const std::string& id)
{
    return find(reprojections, id, "reprojection strategy");
}

} // namespace ssrlab
