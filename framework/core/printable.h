// What files say, in messages for a terminal.
#pragma once

#include <string>
#include <string_view>

namespace ssrlab {

/// The text with \xNN in place of each byte that a terminal may obey or cannot show: control characters except new line and tab,
/// marks that turn the direction of writing, and what is no UTF-8.
std::string printable(std::string_view text);

} // namespace ssrlab
