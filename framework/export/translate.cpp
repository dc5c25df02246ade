#include "export/translate.h"

#include "core/error.h"
#include "core/files.h"
#include "core/run_program.h"
#include "core/temporary_folder.h"
#include "export/wgsl.h"
#include "gpu/spirv.h"

#include <cctype>
#include <cstring>
#include <regex>
#include <span>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// Gives the variable of each block without a name the name of the block, "View" becomes "view": translators write
/// "view_size_px" then, and not "_376_size_px". Takes the types of the arguments from the names of functions.
std::vector<uint32_t> with_plain_names(const std::vector<uint32_t>& spirv)
{
    constexpr uint32_t              op_name = 5, op_type_pointer = 32, op_variable = 59; // SPIR-V 1.6, section 3
    std::map<uint32_t, std::string> names;                                               // by id
    std::map<uint32_t, uint32_t>    pointed, type_of;
    for_each_instruction(spirv, [&](std::span<const uint32_t> words) {
        const uint32_t opcode = opcode_of(words);
        if (opcode == op_name) names[words[1]] = reinterpret_cast<const char*>(&words[2]);
        if (opcode == op_type_pointer) pointed[words[1]] = words[3];
        if (opcode == op_variable) type_of[words[2]] = words[1];
    });
    std::vector<uint32_t> named(spirv.begin(), spirv.begin() + spirv_header_words);
    for_each_instruction(spirv, [&](std::span<const uint32_t> words) {
        const bool  is_nameless = opcode_of(words) == op_name && words[2] == 0 && type_of.contains(words[1]);
        std::string name        = is_nameless ? names[pointed[type_of[words[1]]]] : "";
        if (!name.empty()) {
            const char first = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
            name             = first == name[0] ? name + "_buffer" : first + name.substr(1);
        } else if (opcode_of(words) == op_name)
            name = names[words[1]].substr(0, names[words[1]].find('('));
        if (name.empty()) {
            named.insert(named.end(), words.begin(), words.end());
            return;
        }
        std::vector<uint32_t> text(name.size() / 4 + 1);
        std::memcpy(text.data(), name.data(), name.size());
        named.push_back(static_cast<uint32_t>(text.size() + 2) << 16 | op_name);
        named.push_back(words[1]);
        named.insert(named.end(), text.begin(), text.end());
    });
    return named;
}

std::vector<std::string> options_of(ExportLanguage language)
{
    switch (language) {
    case ExportLanguage::glsl:
    case ExportLanguage::wgsl: return {};
    // Not every device of D3D12 loads four floats from an unordered access view.
    case ExportLanguage::hlsl: return {"--hlsl", "--shader-model", "60", "--hlsl-nonwritable-uav-texture-as-srv"};
    case ExportLanguage::msl: return {"--msl", "--msl-version", "20200", "--msl-decoration-binding"};
    case ExportLanguage::essl: return {"--es", "--version", "310"};
    }
    return {};
}

/// Throws Failure where the program is missing or fails.
void run_translator(const Shader& shader, const std::vector<std::string>& words, const std::string& package)
{
    const ProgramEnd   done = run_program(words, ProgramOutput::kept);
    const std::string& name = words[0];
    if (done.code == program_is_missing)
        throw_failure("{} is not installed: install Debian's package {}", name, package);
    if (done.code != 0)
        throw_failure("{}: {} cannot translate it: {}", short_path(shader.name), name,
                      done.output.substr(0, done.output.find('\n')));
}

/// The shader as a file of SPIR-V, with names for the translators and without what its constants leave unused.
void write_spirv(const Shader& shader, const std::vector<uint32_t>& spirv, const fs::path& file)
{
    const std::vector<uint32_t> named = with_plain_names(spirv);
    write_file_atomically(file, {reinterpret_cast<const char*>(named.data()), named.size() * sizeof(uint32_t)});
    run_translator(
        shader,
        {"spirv-opt", "--eliminate-dead-branches", "--eliminate-dead-functions", file.string(), "-o", file.string()},
        "spirv-tools");
}

/// naga takes SPIR-V up to version 1.3, so the file is compiled again. It is written in GLSL by glsl_for_wgsl().
std::string translated_to_wgsl(const Shader& shader, const fs::path& folder)
{
    const fs::path spirv = folder / "shader.spv", text = folder / "text";
    const fs::path web = web_folder();
    if (!fs::exists(web / "node_modules/naga-wasm"))
        throw_failure("naga-wasm, which writes WGSL, is not installed: npm ci --prefix {}", web.string());
    run_translator(
        shader, {"glslangValidator", "-V", "--target-env", "vulkan1.1", "--quiet", shader.name, "-o", spirv.string()},
        "glslang-tools");
    const std::string     bytes = read_file(spirv);
    std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
    write_spirv(shader, words, spirv);
    run_translator(shader, {"node", (web / "to_wgsl.mjs").string(), spirv.string(), text.string()}, "nodejs");
    return with_read_access(read_file(text), read_file(shader.name), shader);
}

std::string translated_without_comment(const Shader& shader, ExportLanguage language)
{
    const TemporaryFolder folder("ssrlab_export");
    if (language == ExportLanguage::wgsl) return translated_to_wgsl(shader, folder.path);
    const fs::path spirv = folder.path / "shader.spv", text = folder.path / "text";
    write_spirv(shader, shader.spirv, spirv);
    std::vector<std::string> words{"spirv-cross", spirv.string(), "--output", text.string()};
    for (const std::string& option : options_of(language)) words.push_back(option);
    run_translator(shader, words, "spirv-cross");
    return read_file(text);
}

} // namespace

std::string translated(const Shader& shader, ExportLanguage language, const std::string& comment,
                       Translations& translations)
{
    std::string& result = translations[{language, shader.spirv}];
    if (result.empty()) result = translated_without_comment(shader, language);
    // GLSL's #version stays the first line.
    const size_t first = result.starts_with("#version") ? result.find('\n') + 1 : 0;
    return result.substr(0, first) + comment + result.substr(first);
}

std::map<uint32_t, std::string> hlsl_registers(const std::string& hlsl)
{
    static const std::regex         pattern(R"(: register\(([tub])(\d+))");
    std::map<uint32_t, std::string> registers;
    for (std::sregex_iterator match(hlsl.begin(), hlsl.end(), pattern), end; match != end; ++match)
        registers.emplace(static_cast<uint32_t>(std::stoul(match->str(2))), match->str(1) + match->str(2));
    return registers;
}

} // namespace ssrlab
