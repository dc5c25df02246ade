#include "core/names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <numeric>
#include <regex>
#include <string_view>
#include <utility>
#include <vector>

namespace ssrlab {
namespace {

/// Letters to add, drop, replace, or swap with their neighbour; three rows of the table at a time.
size_t edit_distance(std::string_view a, std::string_view b)
{
    std::vector<size_t> before, last, row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 1; i <= a.size(); ++i) {
        before = std::exchange(last, row);
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1] ? 1 : 0)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

// A longer list beside a suggestion hides it.
constexpr size_t most_names_beside_suggestion = 24;

// GLSL 4.60, section 3.6: keywords and what is reserved.
constexpr std::string_view glsl_keywords =
    " "
    "active asm atomic_uint attribute bool break buffer case cast centroid class coherent common "
    "const continue default discard do double else enum extern external false filter fixed flat float "
    "for goto half highp if in inline inout input int interface invariant layout long lowp main "
    "mediump namespace noinline noperspective out output partition patch precise precision public "
    "readonly resource restrict return sample shared short sizeof smooth static struct subroutine "
    "superp switch template this true typedef uint uniform union unsigned using varying void "
    "volatile while writeonly ";
constexpr const char* glsl_types = "[biudhf]?vec[234]|real[234]?|d?mat[234](x[234])?|[iu]?subpassInput(MS)?|"
                                   "[iu]?sampler([1-9CS]\\w*|Buffer)?|[iu]?(image|texture)([1-9C]\\w*|Buffer)";

} // namespace

std::string suggestion(const std::string& name, std::span<const std::string> known)
{
    if (known.empty()) return "";
    const auto lower = [](std::string text) {
        std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        return text;
    };
    const auto distance = [&](const std::string& candidate) { return edit_distance(lower(name), lower(candidate)); };
    const auto nearest  = std::ranges::min_element(known, {}, distance);
    // Farther than a third of the word, the guess confuses more than it helps.
    const bool near = distance(*nearest) <= std::max<size_t>(1, nearest->size() / 3);
    return near ? fmt::format(": did you mean '{}'?", *nearest) : "";
}

std::string unknown_name(const std::string& kind, const std::string& name, std::span<const std::string> known,
                         std::span<const std::string> also)
{
    std::vector<std::string> all(known.begin(), known.end());
    all.insert(all.end(), also.begin(), also.end());
    const std::string near    = suggestion(name, all);
    std::string       message = fmt::format("unknown {} '{}'{}", kind, name, near);
    if (known.empty()) return message + " (there is none)";
    if (!near.empty() && known.size() > most_names_beside_suggestion) return message;
    return message + fmt::format(" (known: {})", fmt::join(known, ", "));
}

std::string glsl_name_fault(const std::string& name)
{
    const auto letter  = [](unsigned char c) { return c < 128 && (std::isalpha(c) != 0 || c == '_'); };
    const auto allowed = [&](unsigned char c) { return letter(c) || (c < 128 && std::isdigit(c) != 0); };
    if (name.empty() || !std::ranges::all_of(name, allowed)) return "expected letters, digits and underscores";
    if (!letter(static_cast<unsigned char>(name.front()))) return "expected a letter first";
    if (name.starts_with("gl_") || name.find("__") != std::string::npos) return "GLSL reserves 'gl_' and '__'";
    if (name == "trace" || name == "ray") return "it is a name of the shader functions";
    if (glsl_keywords.find(" " + name + " ") != std::string_view::npos ||
        std::regex_match(name, std::regex(glsl_types)))
        return "it is a word of GLSL";
    return "";
}

} // namespace ssrlab
