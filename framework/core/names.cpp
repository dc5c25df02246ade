#include "core/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

namespace ssrlab {
namespace {

/// Levenshtein distance; one row of the table at a time.
size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        size_t diagonal = std::exchange(row[0], i);
        for (size_t j = 1; j <= b.size(); ++j) {
            const size_t replaced = diagonal + (a[i - 1] != b[j - 1] ? 1 : 0);
            diagonal              = row[j];
            row[j]                = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row[b.size()];
}

constexpr auto glsl_keywords = std::to_array<std::string_view>(
    {"bool",   "break",  "buffer", "case",  "centroid", "const",   "continue", "default", "discard",
     "do",     "double", "else",   "false", "float",    "for",     "if",       "in",      "inout",
     "input",  "int",    "main",   "out",   "output",   "real",    "return",   "sampler", "shared",
     "struct", "switch", "trace",  "true",  "uint",     "uniform", "using",    "void",    "while"});

} // namespace

std::string unknown_name(const std::string& kind, const std::string& name, std::span<const std::string> known)
{
    std::string message = fmt::format("unknown {} '{}'", kind, name);
    if (known.empty()) return message + " (there is none)";
    const auto distance = [&](const std::string& candidate) { return edit_distance(name, candidate); };
    const auto nearest  = std::ranges::min_element(known, {}, distance);
    // Farther than a third of the word, the guess confuses more than it helps.
    if (distance(*nearest) <= std::max<size_t>(1, nearest->size() / 3)) {
        message += fmt::format(": did you mean '{}'?", *nearest);
    }
    return message + fmt::format(" (known: {})", fmt::join(known, ", "));
}

bool is_glsl_name(const std::string& name)
{
    const auto letter  = [](unsigned char c) { return c < 128 && (std::isalpha(c) != 0 || c == '_'); };
    const auto allowed = [&](unsigned char c) { return letter(c) || (c < 128 && std::isdigit(c) != 0); };
    return !name.empty() && letter(static_cast<unsigned char>(name.front())) && std::ranges::all_of(name, allowed) &&
           !name.starts_with("gl_") && name.find("__") == std::string::npos &&
           std::ranges::find(glsl_keywords, name) == glsl_keywords.end();
}

} // namespace ssrlab
