#include "export/glsl.h"

#include "core/error.h"
#include "export/glsl_text.h"
#include "export/macros.h"
#include "export/unused.h"
#include "gpu/resolved_text.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <regex>
#include <set>

namespace ssrlab {
namespace {

template <typename T> T value_of(const Constants& constants, uint32_t id)
{
    T value{};
    for (const vk::SpecializationMapEntry& entry : constants.entries)
        if (entry.constantID == id && entry.size == sizeof(T))
            std::memcpy(&value, constants.bytes.data() + entry.offset, sizeof(T));
    return value;
}

bool has_value(const Constants& constants, uint32_t id)
{
    return std::ranges::any_of(constants.entries, [&](const auto& entry) { return entry.constantID == id; });
}

/// "0.1", "1.0", "1e+09": the shortest that is read as the same number.
template <typename Real> std::string real_literal(Real value)
{
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

/// What begins the literal of an infinite number. It is no constant expression.
constexpr const char* bits_of_infinity = "uintBitsToFloat(";

std::string literal(const std::string& type, const Constants& constants, uint32_t id)
{
    if (type == "int") return std::to_string(value_of<int32_t>(constants, id));
    if (type == "bool") return value_of<int32_t>(constants, id) != 0 ? "true" : "false";
    if (type == "double") return real_literal(value_of<double>(constants, id)) + "LF";
    const float value = value_of<float>(constants, id);
    return std::isfinite(value) ? real_literal(value)
                                : fmt::format("{}{:#X}u)", bits_of_infinity, std::bit_cast<uint32_t>(value));
}

/// The number that a macro of the text, or a literal, stands for.
uint32_t number_of(const std::string& word, const std::string& text)
{
    std::smatch found;
    const auto  definition = std::regex("#define\\s+" + word + "\\s+(\\d+)");
    return static_cast<uint32_t>(std::stoul(std::regex_search(text, found, definition) ? found.str(1) : word));
}

/// Replaces each match by what `replaced` returns for it.
template <typename Replaced>
std::string replace_all(const std::string& text, const std::regex& pattern, const Replaced& replaced)
{
    std::string result;
    auto        behind = text.begin();
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match) {
        result.append(behind, text.begin() + match->position()).append(replaced(*match));
        behind = text.begin() + match->position() + match->length();
    }
    return result.append(behind, text.end());
}

/// Specialization constants get their values. One without a value keeps its default; those in `kept` stay what they are.
std::string with_values(const std::string& text, const Constants& constants, const std::set<std::string>& kept)
{
    static const std::regex declaration(
        R"(layout\s*\(\s*constant_id\s*=\s*(\w+)\s*\)\s*const\s+(\w+)\s+(\w+)\s*=\s*([^;]*);)");
    return replace_all(text, declaration, [&](const std::smatch& match) {
        const uint32_t    id    = number_of(match.str(1), text);
        const std::string value = has_value(constants, id) ? literal(match.str(2), constants, id) : match.str(4);
        const bool        stays = kept.contains(match.str(3));
        const std::string kind  = stays ? fmt::format("layout(constant_id = {}) const ", id)
                                  : value.starts_with(bits_of_infinity) ? ""
                                                                        : "const ";
        return fmt::format("{}{} {} = {};", kind, match.str(2), match.str(3), value);
    });
}

/// Blocks in the layouts that every language has, and push constants in a uniform block.
std::string with_common_layouts(const std::string& text)
{
    static const std::regex block(R"(layout\s*\(([^()]*)\)\s*((?:\w+\s+)*)(uniform|buffer)(\s+\w+\s*\{))");
    return replace_all(text, block, [&](const std::smatch& match) {
        std::string qualifiers = std::regex_replace(match.str(1), std::regex(R"(\s*,?\s*\bscalar\b)"), "");
        qualifiers             = std::regex_replace(qualifiers, std::regex(R"(\bpush_constant\b)"),
                                                    fmt::format("set = 0, binding = {}", push_binding));
        return fmt::format("layout({}, {}) {}{}{}", match.str(3) == "uniform" ? "std140" : "std430",
                           trimmed(qualifiers), match.str(2), match.str(3), match.str(4));
    });
}

/// "float(1)" becomes "1.0".
std::string with_plain_numbers(const std::string& text)
{
    static const std::regex whole(R"(\bfloat\((\d+)\))"), real(R"(\bfloat\((\d*\.\d+|\d+(\.\d+)?e-?\d+)\))");
    return std::regex_replace(std::regex_replace(text, whole, "$1.0"), real, "$1");
}

/// Extensions come first.
std::string with_extensions_first(const std::string& text)
{
    std::set<std::string>   extensions;
    static const std::regex extension(R"(#extension [^\n]*\n)");
    const std::string       rest = replace_all(text, extension, [&](const std::smatch& match) {
        extensions.insert(match.str());
        return "";
    });
    std::string             first;
    for (const std::string& line : extensions) first += line;
    return first + rest;
}

std::string with_single_blank_lines(const std::string& text)
{
    std::string result;
    for (const char c : text)
        if (c != '\n' || !result.ends_with("\n\n")) result += c;
    return result.substr(std::min(result.find_first_not_of('\n'), result.size()));
}

} // namespace

std::string export_glsl(const Gpu& gpu, const ShaderSource& source, const Constants& constants,
                        const std::set<std::string>& kept)
{
    ShaderSource exported = source;
    exported.defines.emplace("ROWS_IN_ORDER", "1");
    std::string text = expand_macros(resolved_text(gpu, exported));
    text             = with_plain_numbers(with_common_layouts(with_values(text, constants, kept)));
    return "#version 460\n" + with_extensions_first(with_single_blank_lines(without_unused(without_empty_calls(text))));
}

} // namespace ssrlab
