#include "export/macros.h"

#include "export/glsl_text.h"

#include <map>
#include <optional>
#include <set>
#include <vector>

namespace ssrlab {
namespace {

struct Macro {
    bool                     takes_arguments = false;
    std::vector<std::string> parameters;
    std::string              body;
};
using Macros = std::map<std::string, Macro, std::less<>>;

/// The pieces between commas outside brackets, trimmed. at: behind the opening bracket; then behind the closing one.
std::vector<std::string> read_arguments(std::string_view text, size_t& at)
{
    std::vector<std::string> arguments;
    size_t                   begin = at;
    for (int depth = 1; at < text.size() && depth > 0; ++at) {
        const char c = text[at];
        depth += c == '(' || c == '[' || c == '{' ? 1 : c == ')' || c == ']' || c == '}' ? -1 : 0;
        if (depth > 0 && !(c == ',' && depth == 1)) continue;
        const std::string_view piece = trimmed(text.substr(begin, at - begin));
        if (c == ',' || !arguments.empty() || !piece.empty()) arguments.emplace_back(piece);
        begin = at + 1;
    }
    return arguments;
}

std::string without_comments(std::string_view text)
{
    std::string result;
    for (size_t at = 0; at < text.size();) {
        const size_t end = comment_end(text, at);
        if (end == at) result += text[at++];
        at = end > at ? end : at;
    }
    return std::string(trimmed(result));
}

/// Continued lines become lines of their own, without the indentation that lined them up.
std::string joined(std::string_view body)
{
    std::string result;
    for (size_t at = 0; at < body.size(); ++at) {
        if (body[at] != '\\' || at + 1 >= body.size() || body[at + 1] != '\n') {
            result += body[at];
            continue;
        }
        while (!result.empty() && is_space(result.back())) result.pop_back();
        result += '\n';
        while (at + 1 < body.size() && is_space(body[at + 1])) ++at;
    }
    return result;
}

/// "#define NAME(a, b) body" behind the word define.
std::pair<std::string, Macro> read_macro(std::string_view definition)
{
    definition       = trimmed(definition);
    size_t      end  = word_end(definition, 0);
    std::string name = std::string(definition.substr(0, end));
    Macro       macro;
    if (end < definition.size() && definition[end] == '(') {
        macro.takes_arguments = true;
        macro.parameters      = read_arguments(definition, ++end);
    }
    macro.body = joined(without_comments(definition.substr(end)));
    return {name, macro};
}

bool is_name(std::string_view text)
{
    return !text.empty() && begins_name(text[0]) && word_end(text, 0) == text.size();
}

/// The body with arguments in the place of parameters, and what ## pastes pasted.
std::string filled(const Macro& macro, const std::vector<std::string>& arguments)
{
    std::string result;
    for (size_t at = 0; at < macro.body.size();) {
        if (macro.body.compare(at, 2, "##") == 0) {
            while (!result.empty() && is_space(result.back())) result.pop_back();
            at += 2;
            while (at < macro.body.size() && is_space(macro.body[at])) ++at;
        } else if (is_in_name(macro.body[at])) {
            const size_t      end  = word_end(macro.body, at);
            const std::string word = macro.body.substr(at, end - at);
            size_t            i    = 0;
            while (i < macro.parameters.size() && macro.parameters[i] != word) ++i;
            result += i < macro.parameters.size() && i < arguments.size() ? arguments[i] : word;
            at = end;
        } else
            result += macro.body[at++];
    }
    return result;
}

std::string expanded(std::string_view text, const Macros& macros, const std::set<std::string>& hidden);

/// What a name that ends at `at` stands for, with the arguments that follow it; then `at` is behind those. Nothing: itself.
std::optional<std::string> meaning(std::string name, std::string_view text, size_t& at, const Macros& macros,
                                   std::set<std::string> hidden)
{
    const auto find  = [&] { return hidden.contains(name) ? macros.end() : macros.find(name); };
    auto       found = find();
    if (found == macros.end()) return std::nullopt;
    while (found != macros.end() && !found->second.takes_arguments && is_name(found->second.body)) {
        hidden.insert(name);
        name  = found->second.body;
        found = find();
    }
    if (found == macros.end()) return name;
    hidden.insert(name);
    if (!found->second.takes_arguments) return expanded(found->second.body, macros, hidden);
    size_t open = at;
    while (open < text.size() && is_space(text[open])) ++open;
    if (open >= text.size() || text[open] != '(') return name;
    at = open + 1;
    return expanded(filled(found->second, read_arguments(text, at)), macros, hidden);
}

/// Adds text whose lines are as far in as the last line of the result.
void add_indented(std::string& result, std::string_view added)
{
    const size_t      begin = result.find_last_of('\n') + 1; // npos + 1 = 0
    const size_t      text  = std::min(result.find_first_not_of(' ', begin), result.size());
    const std::string indentation(text - begin, ' ');
    for (const char c : added) {
        result += c;
        if (c == '\n') result += indentation;
    }
}

/// Of text without directives.
std::string expanded(std::string_view text, const Macros& macros, const std::set<std::string>& hidden)
{
    std::string result;
    for (size_t at = 0; at < text.size();) {
        size_t end = comment_end(text, at);
        if (end == at && is_in_name(text[at])) {
            end                    = word_end(text, at);
            const std::string name = std::string(text.substr(at, end - at));
            if (const auto means = meaning(name, text, end, macros, hidden)) {
                add_indented(result, *means);
                while (means->empty() && end < text.size() && text[end] == ' ') ++end;
                at = end;
                continue;
            }
        }
        end = std::max(end, at + 1);
        result += text.substr(at, end - at);
        at = end;
    }
    return result;
}

/// Takes a definition in, or returns the line as it stays. What goes leaves an empty line, so that a comment above it does
/// not seem to belong to what follows.
std::string directive(std::string_view line, Macros& macros)
{
    const std::string_view words = trimmed(trimmed(line).substr(1));
    const std::string      same  = std::string(line) + '\n';
    if (words.starts_with("undef")) return macros.erase(std::string(trimmed(words.substr(5)))) > 0 ? "\n" : same;
    if (!words.starts_with("define")) return same;
    auto [name, macro] = read_macro(words.substr(6));
    macros.erase(name);
    if (!macro.takes_arguments && !macro.body.empty() && !is_name(macro.body)) return expanded(line, macros, {}) + '\n';
    macros.emplace(name, macro);
    return "\n";
}

} // namespace

std::string expand_macros(std::string_view text)
{
    Macros      macros;
    std::string result;
    size_t      code       = 0; // what is not yet written, up to the next directive
    const auto  write_code = [&](size_t end) { result += expanded(text.substr(code, end - code), macros, {}); };
    for (size_t at = 0; at < text.size();) {
        const size_t first = text.find_first_not_of(" \t", at);
        if (first != std::string_view::npos && text[first] == '#') {
            write_code(at);
            const size_t end = line_end(text, first);
            result += directive(text.substr(first, end - first), macros);
            code = at = std::min(end + 1, text.size());
            continue;
        }
        // To the next line, over a comment of several.
        size_t next = at;
        while (next < text.size() && text[next] != '\n') next = std::max(comment_end(text, next), next + 1);
        at = std::min(next + 1, text.size());
    }
    write_code(text.size());
    return result;
}

} // namespace ssrlab
