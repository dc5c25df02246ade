// Sizes as text.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <string_view>

namespace ssrlab {

/// Parses "1280x720". Returns nullopt if the text is anything else.
std::optional<glm::ivec2> parse_size(std::string_view text);

} // namespace ssrlab
