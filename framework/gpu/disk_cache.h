// What is expensive to make and may be lost at any time: compiled shaders and pipelines, in the user's cache folder.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ssrlab {

/// What was kept under this name, if it is there and intact. $XDG_CACHE_HOME/ssrlab or ~/.cache/ssrlab; without either, nothing is kept.
std::optional<std::string> read_cached(const std::string& name);

/// Never throws: a cache that cannot be written is no error; the first time, a warning on stderr.
void write_cached(const std::string& name, std::string_view bytes) noexcept;

} // namespace ssrlab
