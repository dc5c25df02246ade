#include "export/wgsl.h"

#include "core/files.h"

#include <fmt/format.h>

#include <regex>

namespace ssrlab {
namespace {

/// Functions in the place of those that the translator does not know or takes for others, and infinity as a variable, since
/// WGSL has no such constant.
constexpr const char* replacements =
    "uint infinity_bits = 0x7F800000u;\n"
    "bool is_infinite(float x) { return (floatBitsToUint(x) & 0x7FFFFFFFu) == 0x7F800000u; }\n"
    "bvec2 is_infinite(vec2 x) { return bvec2(is_infinite(x.x), is_infinite(x.y)); }\n"
    "bvec3 is_infinite(vec3 x) { return bvec3(is_infinite(x.xy), is_infinite(x.z)); }\n"
    "bvec4 is_infinite(vec4 x) { return bvec4(is_infinite(x.xyz), is_infinite(x.w)); }\n"
    "bool is_no_number(float x) { return (floatBitsToUint(x) & 0x7FFFFFFFu) > 0x7F800000u; }\n"
    "bvec2 is_no_number(vec2 x) { return bvec2(is_no_number(x.x), is_no_number(x.y)); }\n"
    "bvec3 is_no_number(vec3 x) { return bvec3(is_no_number(x.xy), is_no_number(x.z)); }\n"
    "bvec4 is_no_number(vec4 x) { return bvec4(is_no_number(x.xyz), is_no_number(x.w)); }\n"
    "int highest_bit(int x) { return findMSB(x); }\n"
    "int highest_bit(uint x) { return (x & 0x80000000u) != 0u ? 31 : findMSB(int(x)); }\n"
    "int lowest_bit(int x) { return findLSB(x); }\n"
    "int lowest_bit(uint x) { return findLSB(int(x)); }\n"
    "#define isinf is_infinite\n#define isnan is_no_number\n#define findMSB highest_bit\n#define findLSB lowest_bit\n";

} // namespace

std::string glsl_for_wgsl(const std::string& glsl)
{
    static const std::regex infinity(R"(uintBitsToFloat\(0[xX]7F800000[uU]\))");
    std::string             text      = std::regex_replace(glsl, infinity, "uintBitsToFloat(infinity_bits)");
    const size_t            extension = text.rfind("#extension");
    const size_t            first     = text.find('\n', extension == std::string::npos ? 0 : extension) + 1;
    return text.insert(first, replacements);
}

std::string with_read_access(std::string wgsl, const std::string& glsl, const Shader& shader)
{
    static const std::regex pattern(R"(\breadonly\s+buffer\s+(\w+))");
    for (std::sregex_iterator match(glsl.begin(), glsl.end(), pattern), end; match != end; ++match) {
        const auto found = shader.bindings.find(match->str(1));
        if (found == shader.bindings.end()) continue;
        static constexpr std::string_view both = "read_write";
        const std::string declared = fmt::format("@binding({}) \nvar<storage, {}", found->second.binding, both);
        if (const size_t at = wgsl.find(declared); at != std::string::npos)
            wgsl.replace(at + declared.size() - both.size(), both.size(), "read");
    }
    return wgsl;
}

std::filesystem::path web_folder() { return data_root() / "experiments/web"; }

} // namespace ssrlab
