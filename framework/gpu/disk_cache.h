// A cache of compiled shaders and pipelines in the user's cache folder. It may be deleted at any time.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace ssrlab {

/// Returns $XDG_CACHE_HOME/ssrlab or ~/.cache/ssrlab, which need not exist; empty if neither variable is set.
std::filesystem::path cache_folder();

/// Returns what was kept under this name if it is there and intact.
std::optional<std::string> read_cached(const std::string& name);

/// Never throws. If the cache cannot be written, it warns once on stderr.
void write_cached(const std::string& name, std::string_view bytes) noexcept;

} // namespace ssrlab
