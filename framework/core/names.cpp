#include "core/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <regex>
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

// GLSL 4.60, section 3.6: keywords and what is reserved; and the project's own entry points and their argument.
constexpr std::string_view glsl_keywords =
    " "
    "active asm atomic_uint attribute bool break buffer case cast centroid class coherent common "
    "const continue default discard do double else enum extern external false filter fixed flat float "
    "for goto half highp if in inline inout input int interface invariant layout long lowp main "
    "mediump namespace noinline noperspective out output partition patch precise precision public ray "
    "readonly resource restrict return sample shared short sizeof smooth static struct subroutine "
    "superp switch template this trace true typedef uint uniform union unsigned using varying void "
    "volatile while writeonly ";
constexpr const char* glsl_types = "[biudhf]?vec[234]|real[234]?|d?mat[234](x[234])?|[iu]?subpassInput(MS)?|"
                                   "[iu]?sampler([1-9CS]\\w*|Buffer)?|[iu]?(image|texture)([1-9C]\\w*|Buffer)";

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
           glsl_keywords.find(" " + name + " ") == std::string_view::npos &&
           !std::regex_match(name, std::regex(glsl_types));
}

} // namespace ssrlab
