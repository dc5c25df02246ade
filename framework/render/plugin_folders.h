// Where the folders of techniques, structures and surface models lie. Folder-internal.
#pragma once

#include "core/error.h"
#include "core/files.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ssrlab {

/// The in-tree directory of techniques, then those in $SSRLAB_TECHNIQUES, then the others.
std::vector<std::filesystem::path> plugin_dirs(std::span<const std::filesystem::path> extra_dirs);

/// Of such a directory: itself or the folders in it, down to those `deepest` levels farther in. Throws SpecError when it does not exist.
std::vector<std::filesystem::path> plugin_folders(const std::filesystem::path& dir,
                                                  bool (*wanted)(const std::filesystem::path&), int deepest);

/// The same folder may be named twice, two folders of one id may not.
template <typename Item> void append_plugin(std::vector<Item>& items, Item item, const std::string& kind)
{
    const auto same = std::ranges::find(items, item.id, &Item::id);
    if (same == items.end())
        items.push_back(std::move(item));
    else if (!std::filesystem::equivalent(same->folder, item.folder))
        throw_spec_error("two {} are called '{}': {} and {}", kind, item.id, short_path(same->folder),
                         short_path(item.folder));
}

} // namespace ssrlab
