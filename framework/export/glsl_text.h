// Reading GLSL as text: names, comments and balanced brackets. Folder-internal.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace ssrlab {

inline bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
inline bool is_in_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)) != 0; }
inline bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// The end of the name or number that begins here.
inline size_t word_end(std::string_view text, size_t at)
{
    while (at < text.size() && is_in_name(text[at])) ++at;
    return at;
}

/// The end of the comment that begins here; `at` itself where none does. A line's end does not belong to it.
inline size_t comment_end(std::string_view text, size_t at)
{
    const std::string_view two = text.substr(at, 2);
    if (two == "//") return std::min(text.find('\n', at), text.size());
    if (two != "/*") return at;
    const size_t end = text.find("*/", at + 2);
    return end == std::string_view::npos ? text.size() : end + 2;
}

/// The end of the line that begins here, with its continuations; the line's end does not belong to it.
inline size_t line_end(std::string_view text, size_t at)
{
    size_t end = std::min(text.find('\n', at), text.size());
    while (end < text.size() && text[end - 1] == '\\') end = std::min(text.find('\n', end + 1), text.size());
    return end;
}

inline std::string_view trimmed(std::string_view text)
{
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// Calls visit(name) for each name outside comments.
template <typename Visit> void for_each_name(std::string_view text, const Visit& visit)
{
    for (size_t at = 0; at < text.size();) {
        if (const size_t end = comment_end(text, at); end > at)
            at = end;
        else if (is_in_name(text[at])) {
            const size_t word = word_end(text, at);
            if (begins_name(text[at])) visit(text.substr(at, word - at));
            at = word;
        } else
            ++at;
    }
}

} // namespace ssrlab
