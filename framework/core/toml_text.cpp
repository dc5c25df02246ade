#include "core/toml_text.h"

#include "core/error.h"
#include "core/utf8.h"

#include <algorithm>

namespace ssrlab {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
constexpr int              most_key_dots   = 100; // each is a table in a table, and toml++ calls itself for each

struct Reader {
    const std::string& file;
    std::string_view   text;
    size_t             at       = 0;
    bool               in_value = false; // behind "=", in a list
    std::string        open     = {};    // brackets of the lists and tables that it is in
    int                key_dots = 0;

    bool   more() const { return at < text.size(); }
    bool   next_is(std::string_view expected) const { return text.substr(at, expected.size()) == expected; }
    bool   beyond_ascii() const { return more() && static_cast<unsigned char>(text[at]) >= 0x80; }
    void   skip(std::string_view some) { at = std::min(text.find_first_not_of(some, at), text.size()); }
    size_t line() const { return static_cast<size_t>(std::count(text.begin(), text.begin() + at, '\n')) + 1; }
};

[[noreturn]] void refuse_letter(const Reader& reader, const std::string& where)
{
    throw_spec_error("{}:{}: expected ASCII {}, got '{}'", reader.file, reader.line(), where,
                     reader.text.substr(reader.at, utf8_length(reader.text, reader.at)));
}

/// To the end of its line, or of the quotes.
void skip_string(Reader& reader)
{
    const std::string quote(1, reader.text[reader.at]), three = quote + quote + quote;
    const bool        several_lines = reader.next_is(three), escapes = quote == "\"";
    const std::string end = several_lines ? three : quote;
    for (reader.at += end.size(); reader.more() && !reader.next_is(end); ++reader.at) {
        if (!several_lines && reader.next_is("\n")) return;
        if (!escapes || !reader.next_is("\\")) continue;
        const size_t escaped = ++reader.at;
        if (several_lines) reader.skip(" \t\r\n");
        if (several_lines && reader.beyond_ascii())
            refuse_letter(reader,
                          "after a backslash, or after a line that ends with one (\\u and its number is ASCII)");
        if (reader.at > escaped) --reader.at;
    }
    reader.at = std::min(reader.at + end.size(), reader.text.size());
    // Up to two more quotes belong to a string of several lines.
    for (int more = 0; several_lines && more < 2 && reader.next_is(quote); ++more) ++reader.at;
}

/// A number, a date, a word: toml++ looks on to where it ends, whatever stands there.
void skip_bare_value(Reader& reader)
{
    const size_t end = std::min(reader.text.find_first_of(" \t\n\v\f\r]},#", reader.at + 1), reader.text.size());
    for (; reader.at < end; ++reader.at)
        if (reader.beyond_ascii()) refuse_letter(reader, "outside quotes and comments");
}

void pass_sign(Reader& reader)
{
    const char sign = reader.text[reader.at++];
    if (std::string_view("=\n,{").find(sign) != std::string_view::npos) reader.key_dots = 0;
    if (!reader.in_value && sign == '.' && ++reader.key_dots > most_key_dots)
        throw_spec_error("{}:{}: expected a key of at most {} parts, got more", reader.file, reader.line(),
                         most_key_dots + 1);
    const bool closes = (sign == ']' && reader.open.ends_with('[')) || (sign == '}' && reader.open.ends_with('{'));
    if (!reader.in_value && sign != '=' && !closes) return;
    if (closes) reader.open.pop_back();
    if (sign == '[' || sign == '{') reader.open += sign;
    const bool key_follows =
        sign == '{' || (sign == ',' && reader.open.ends_with('{')) || (sign == '\n' && reader.open.empty());
    reader.in_value = !key_follows;
}

} // namespace

void check_toml_text(const std::string& file, std::string_view text)
{
    Reader reader{file, text};
    for (; reader.more(); reader.at += utf8_length(text, reader.at))
        if (utf8_length(text, reader.at) == 0)
            throw_spec_error("{}:{}: expected UTF-8, got the byte 0x{:02x}", file, reader.line(),
                             static_cast<unsigned char>(text[reader.at]));
    reader.at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    while (reader.more()) {
        if (reader.beyond_ascii()) refuse_letter(reader, "outside quotes and comments");
        if (reader.next_is("\"") || reader.next_is("'"))
            skip_string(reader);
        else if (reader.next_is("#"))
            reader.at = std::min(text.find('\n', reader.at), text.size());
        else if (reader.in_value && std::string_view(" \t\r\n,[]{}").find(text[reader.at]) == std::string_view::npos)
            skip_bare_value(reader);
        else
            pass_sign(reader);
    }
}

} // namespace ssrlab
