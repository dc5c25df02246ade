#include "render/plugin_folders.h"

#include <cstdlib>

namespace ssrlab {

namespace fs = std::filesystem;

std::vector<fs::path> plugin_dirs(std::span<const fs::path> extra_dirs)
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

std::vector<fs::path> plugin_folders(const fs::path& dir, bool (*wanted)(const fs::path&), int deepest)
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

} // namespace ssrlab
