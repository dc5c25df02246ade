// Where characters begin and end.
#pragma once

#include <cstddef>
#include <string_view>

namespace ssrlab {

/// Bytes of the code point that begins at `at`; 0 where none does.
size_t utf8_length(std::string_view text, size_t at = 0);

} // namespace ssrlab
