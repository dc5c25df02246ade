#include "core/error.h"
#include "core/files.h"
#include "scene/gltf.h"
#include "scene/load_scene.h"
#include "scene/recipe.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

using Files = std::vector<fs::path>;

void add_named_by(const fs::path& file, Files& files);

/// Files that are not there are left out: what names them then does without them.
void add(const fs::path& file, Files& files)
{
    std::error_code error;
    if (!fs::is_regular_file(file, error) || std::ranges::find(files, file) != files.end()) return;
    files.push_back(file);
    add_named_by(file, files);
}

/// "mtllib NAME" of an OBJ file, "map_Kd [OPTIONS] NAME" and its like of an MTL file.
void add_obj_names(const fs::path& file, Files& files)
{
    std::istringstream text(read_file(file));
    for (std::string line; std::getline(text, line);) {
        std::ranges::replace(line, '\\', '/');
        while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
        const size_t key = line.find_first_not_of(" \t"), space = line.find_first_of(" \t", key);
        // A name has letters; this spares millions of lines of coordinates a look at the disk.
        if (space == std::string::npos || space - key < 4) continue;
        add(file.parent_path() / line.substr(line.find_first_not_of(" \t", space)), files);
        add(file.parent_path() / line.substr(line.find_last_of(" \t") + 1), files);
        // Named by its place on another machine.
        add(file.parent_path() / line.substr(line.find_last_of(" \t/") + 1), files);
    }
}

void add_named_by(const fs::path& file, Files& files)
{
    const std::string extension = lower_extension(file);
    if (extension == ".gltf" || extension == ".glb")
        for (const fs::path& named : gltf::files_named_by(file)) add(named, files);
    if (extension == ".obj" || extension == ".mtl") add_obj_names(file, files);
}

void add_parts(const fs::path& recipe, Files& files)
{
    for (const Part& part : read_recipe(recipe).parts)
        if (!part.shape) add(find_data(part.file, recipe.parent_path()), files);
}

} // namespace

std::vector<fs::path> scene_files(const std::string& name)
{
    Files          files;
    const fs::path file = find_scene_file(name);
    try {
        if (is_frame(name)) return frame_files(file);
        add(file, files);
        add(file.string() + ".views.toml", files);
        if (lower_extension(file) == ".toml") add_parts(file, files);
    } catch (const std::runtime_error&) {
        // Damaged, or its data is not installed: loading the scene says so.
    }
    return files;
}

} // namespace ssrlab
