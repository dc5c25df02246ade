// Characters in UTF-8 text.
#pragma once

#include <cstddef>
#include <string_view>

namespace ssrlab {

/// Returns the length in bytes of the code point that begins at `at`; 0 if none does.
size_t utf8_length(std::string_view text, size_t at = 0);

} // namespace ssrlab
