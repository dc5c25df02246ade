#include "core/printable.h"

#include <fmt/format.h>

#include <algorithm>

namespace ssrlab {
namespace {

/// Bytes of the character that begins here; 0 where it is no UTF-8.
size_t character_bytes(std::string_view text)
{
    const auto   first     = static_cast<unsigned char>(text[0]);
    const size_t length    = first < 0x80                    ? 1
                             : first >= 0xC2 && first < 0xE0 ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
    const auto   continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80; };
    if (length == 0 || length > text.size()) return 0;
    return std::ranges::all_of(text.substr(1, length - 1), continues) ? length : 0;
}

bool is_control(std::string_view character)
{
    const auto byte = [&](size_t i) { return static_cast<unsigned char>(character[i]); };
    if (character.size() == 1) return (byte(0) < 0x20 && byte(0) != '\n' && byte(0) != '\t') || byte(0) == 0x7F;
    if (character.size() == 2) return byte(0) == 0xC2 && byte(1) < 0xA0;
    return character.starts_with("\xE2\x80") && byte(2) >= 0xA8 && byte(2) <= 0xAE;
}

} // namespace

std::string printable(std::string_view text)
{
    std::string result;
    while (!text.empty()) {
        const size_t bytes = character_bytes(text);
        const bool   shown = bytes > 0 && !is_control(text.substr(0, bytes));
        result +=
            shown ? std::string(text.substr(0, bytes)) : fmt::format("\\x{:02X}", static_cast<unsigned char>(text[0]));
        text.remove_prefix(shown ? bytes : 1);
    }
    return result;
}

} // namespace ssrlab
