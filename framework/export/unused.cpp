#include "export/unused.h"

#include "export/glsl_text.h"

#include <algorithm>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace ssrlab {
namespace {

using Names = std::set<std::string, std::less<>>;

/// A function, a declaration or a directive, with the comments before it.
struct Item {
    std::string text;
    Names       declares, uses;
    bool        is_needed = false; // whoever uses it
};

/// Behind spaces and comments.
size_t code_begin(std::string_view text, size_t at)
{
    while (at < text.size()) {
        const size_t end = comment_end(text, at);
        if (end == at && !is_space(text[at])) break;
        at = std::max(end, at + 1);
    }
    return at;
}

/// Behind the comment on the same line and the line's end, if nothing else stands there.
size_t with_rest_of_line(std::string_view text, size_t at)
{
    size_t end = at;
    while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
    end = comment_end(text, end);
    return end < text.size() && text[end] == '\n' ? end + 1 : at;
}

/// The end of a function or declaration whose code begins here.
size_t item_end(std::string_view text, size_t at)
{
    int  depth       = 0;
    char last        = ' '; // before this one
    bool is_function = false;
    while (at < text.size()) {
        if (const size_t end = comment_end(text, at); end > at) {
            at = end;
            continue;
        }
        const char c = text[at++];
        if (c == '{' && depth == 0) is_function = last == ')';
        depth += c == '{' || c == '(' ? 1 : c == '}' || c == ')' ? -1 : 0;
        if (depth == 0 && (c == ';' || (c == '}' && is_function))) break;
        if (!is_space(c)) last = c;
    }
    return with_rest_of_line(text, at);
}

/// Names before the end, a comma, a value or an array's size, outside brackets: what "float a = f(x), b[2];" declares.
void add_declared(std::string_view code, Names& names)
{
    int         depth    = 0;
    bool        in_value = false;
    std::string name;
    for (size_t at = 0; at < code.size();) {
        if (const size_t end = comment_end(code, at); end > at) {
            at = end;
        } else if (is_in_name(code[at])) {
            const size_t word = word_end(code, at);
            if (depth == 0 && !in_value) name = std::string(code.substr(at, word - at));
            at = word;
        } else {
            const char c = code[at++];
            if (depth == 0 && !in_value && (c == ';' || c == ',' || c == '=' || c == '[') && !name.empty())
                names.insert(name);
            if (depth == 0) in_value = c == '=' || (in_value && c != ',' && c != ';');
            depth += c == '(' || c == '[' || c == '{' ? 1 : c == ')' || c == ']' || c == '}' ? -1 : 0;
        }
    }
}

/// The last name before a position.
std::string name_before(std::string_view code, size_t end)
{
    std::string last;
    for_each_name(code.substr(0, end), [&](std::string_view name) { last = name; });
    return last;
}

/// What a function or declaration declares.
Names declared_by(std::string_view code)
{
    Names        names;
    const size_t layout = code.starts_with("layout") ? code.find(')') + 1 : 0;
    code                = code.substr(layout);
    const size_t open = code.find('{'), bracket = code.find('('), value = std::min(code.find('='), code.find(';'));
    if (bracket < std::min(open, value)) {
        names.insert(name_before(code, bracket));
    } else if (open < value) { // a struct or a block
        const size_t close = code.rfind('}');
        names.insert(name_before(code, open));
        if (!code.starts_with("struct"))
            add_declared(code.substr(open + 1, close - open - 1), names); // members are seen outside
        add_declared(code.substr(close + 1), names);
    } else
        add_declared(code, names);
    return names;
}

Item directive_item(std::string text, std::string_view code)
{
    Item                   item{std::move(text), {}, {}, true};
    const std::string_view words = trimmed(code.substr(1));
    if (!words.starts_with("define")) return item;
    const std::string_view definition = trimmed(words.substr(6));
    item.is_needed                    = false;
    item.declares.emplace(definition.substr(0, word_end(definition, 0)));
    return item;
}

/// Of what stands before an item, what follows the last empty line: other comments are about something else.
std::string with_own_comment(std::string_view before)
{
    size_t own = 0;
    for (size_t begin = 0, end = before.find('\n'); end != std::string_view::npos;
         begin = end + 1, end = before.find('\n', begin))
        if (trimmed(before.substr(begin, end - begin)).empty()) own = end + 1;
    return (own > 0 ? "\n" : "") + std::string(before.substr(own));
}

std::vector<Item> items_of(std::string_view text)
{
    std::vector<Item> items;
    for (size_t at = 0; at < text.size();) {
        const size_t begin = code_begin(text, at);
        if (begin >= text.size()) break;
        const bool   is_directive = text[begin] == '#';
        const size_t end = is_directive ? std::min(line_end(text, begin) + 1, text.size()) : item_end(text, begin);
        const std::string_view code = text.substr(begin, end - begin);
        const std::string      own  = with_own_comment(text.substr(at, begin - at)) + std::string(code);
        Item item = is_directive ? directive_item(own, code) : Item{own, declared_by(code), {}, false};
        for_each_name(code, [&](std::string_view name) { item.uses.emplace(name); });
        item.is_needed |=
            item.declares.contains("main") || item.declares.contains("in"); // layout(local_size_x = 8) in;
        items.push_back(std::move(item));
        at = end;
    }
    return items;
}

/// What the body of a void function calls, if it does nothing else.
std::optional<Names> only_calls(std::string_view function)
{
    static const std::regex body(R"(void\s+\w+\s*\([^(){}]*\)\s*\{((\s*\w+\s*\([^;{}]*\);)*)\s*\}\s*)"),
        call(R"((\w+)\s*\([^;]*\);)");
    const std::string code(function.substr(code_begin(function, 0)));
    std::smatch       parts;
    if (!std::regex_match(code, parts, body)) return std::nullopt;
    Names             called;
    const std::string calls = parts.str(1);
    for (std::sregex_iterator one(calls.begin(), calls.end(), call), end; one != end; ++one) called.insert(one->str(1));
    return called;
}

/// The names of functions that do nothing, or call only such functions.
Names empty_functions(std::span<const Item> items)
{
    std::multimap<std::string, std::optional<Names>> bodies;
    for (const Item& item : items)
        for (const std::string& name : item.declares) bodies.emplace(name, only_calls(item.text));
    Names empty;
    for (const auto& [name, calls] : bodies) empty.insert(name);
    empty.erase("main");
    for (size_t before = 0; before != empty.size();) {
        before = empty.size();
        for (const auto& [name, calls] : bodies)
            if (!calls || !std::ranges::all_of(*calls, [&](const std::string& one) { return empty.contains(one); }))
                empty.erase(name);
    }
    return empty;
}

/// Without the statements that call one of these.
std::string without_calls(const std::string& text, const Names& names)
{
    std::string result = text;
    for (const std::string& name : names) {
        const std::regex call("([;{}])\\s*\\b" + name + R"(\s*\([^;{}]*\);)");
        for (std::string before; before != result;)
            before = std::exchange(result, std::regex_replace(result, call, "$1"));
    }
    return result;
}

} // namespace

std::string without_empty_calls(std::string_view text)
{
    return without_calls(std::string(text), empty_functions(items_of(text)));
}

std::string without_unused(std::string_view text)
{
    std::vector<Item>                                      items = items_of(text);
    std::map<std::string, std::vector<Item*>, std::less<>> declaring;
    std::vector<Item*>                                     waiting;
    for (Item& item : items) {
        for (const std::string& name : item.declares) declaring[name].push_back(&item);
        if (item.is_needed) waiting.push_back(&item);
    }
    while (!waiting.empty()) {
        const Item* item = waiting.back();
        waiting.pop_back();
        for (const std::string& name : item->uses)
            if (const auto found = declaring.find(name); found != declaring.end())
                for (Item* used : found->second)
                    if (!std::exchange(used->is_needed, true)) waiting.push_back(used);
    }
    std::string result;
    for (const Item& item : items)
        if (item.is_needed) result += item.text;
    return result;
}

} // namespace ssrlab
