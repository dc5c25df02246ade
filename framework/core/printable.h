// Text from files, made safe for messages on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace ssrlab {

/// Returns the text with \xNN for each byte that a terminal may obey or cannot show: control characters except newline
/// and tab, marks that turn the direction of writing, and invalid UTF-8.
std::string printable(std::string_view text);

} // namespace ssrlab
