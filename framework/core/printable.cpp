#include "core/printable.h"

#include "core/utf8.h"

#include <fmt/format.h>

namespace ssrlab {
namespace {

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
        const size_t bytes = utf8_length(text);
        const bool   shown = bytes > 0 && !is_control(text.substr(0, bytes));
        result +=
            shown ? std::string(text.substr(0, bytes)) : fmt::format("\\x{:02X}", static_cast<unsigned char>(text[0]));
        text.remove_prefix(shown ? bytes : 1);
    }
    return result;
}

std::string counted(size_t count, std::string_view singular)
{
    return fmt::format("{} {}{}", count, singular, count == 1 ? "" : "s");
}

} // namespace ssrlab
