// Words of messages: text from files made safe for a terminal, and counts.
#pragma once

#include <string>
#include <string_view>

namespace ssrlab {

/// Returns the text with \xNN for each byte that a terminal may obey or cannot show: control characters except newline
/// and tab, marks that turn the direction of writing, and invalid UTF-8.
std::string printable(std::string_view text);

/// "1 row", "2 rows".
std::string counted(size_t count, std::string_view singular);

} // namespace ssrlab
