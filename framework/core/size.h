// Sizes as people write them.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <string_view>

namespace ssrlab {

/// "1280x720": two whole numbers; nothing if the text is anything else.
std::optional<glm::ivec2> parse_size(std::string_view text);

} // namespace ssrlab
