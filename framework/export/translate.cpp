#include "export/translate.h"

#include "core/error.h"
#include "core/files.h"
#include "core/temporary_folder.h"
#include "gpu/spirv.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <span>
#include <sys/wait.h>
#include <unistd.h>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// Gives the variable of each block without a name the name of the block, "View" becomes "view": translators write
/// "view_size_px" then, and not "_376_size_px".
std::vector<uint32_t> with_named_blocks(const std::vector<uint32_t>& spirv)
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
        if (name.empty()) {
            named.insert(named.end(), words.begin(), words.end());
            return;
        }
        const char first = static_cast<char>(std::tolower(static_cast<unsigned char>(name[0])));
        name             = first == name[0] ? name + "_buffer" : first + name.substr(1);
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
    case ExportLanguage::glsl: return {};
    case ExportLanguage::hlsl: return {"--hlsl", "--shader-model", "60"};
    case ExportLanguage::msl: return {"--msl", "--msl-version", "20200", "--msl-decoration-binding"};
    case ExportLanguage::essl: return {"--es", "--version", "310"};
    }
    return {};
}

/// Exit code of the program with its output in a file; 127: it is not there.
int run_program(const std::vector<std::string>& words, const fs::path& output)
{
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child < 0) throw_failure("{} cannot be started: {}", words[0], std::strerror(errno));
    if (child == 0) {
        const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        ::execvp(arguments[0], arguments.data());
        ::_exit(127);
    }
    int status = 0;
    if (::waitpid(child, &status, 0) != child) throw_failure("{} was lost: {}", words[0], std::strerror(errno));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

} // namespace

std::string translated(const Shader& shader, ExportLanguage language, const std::string& comment)
{
    const TemporaryFolder folder("ssrlab_export");
    const fs::path        spirv = folder.path / "shader.spv", text = folder.path / "text", said = folder.path / "said";
    const std::vector<uint32_t> named = with_named_blocks(shader.spirv);
    write_file_atomically(spirv, {reinterpret_cast<const char*>(named.data()), named.size() * sizeof(uint32_t)});
    std::vector<std::string> words{"spirv-cross", spirv.string(), "--output", text.string()};
    for (const std::string& option : options_of(language)) words.push_back(option);
    const int code = run_program(words, said);
    if (code == 127) throw_failure("spirv-cross is not installed: install Debian's package spirv-cross");
    if (code != 0) {
        std::string why = read_file(said);
        why             = why.substr(0, why.find('\n'));
        throw_failure("{}: spirv-cross cannot translate it: {}", short_path(shader.name), why);
    }
    const std::string result = read_file(text);
    // GLSL's #version stays the first line.
    const size_t first = result.starts_with("#version") ? result.find('\n') + 1 : 0;
    return result.substr(0, first) + comment + result.substr(first);
}

} // namespace ssrlab
