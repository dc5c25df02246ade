#include "core/run_program.h"

#include "core/error.h"
#include "core/files.h"
#include "core/temporary_folder.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <sys/wait.h>
#include <unistd.h>

namespace ssrlab {

ProgramEnd run_program(const std::vector<std::string>& words, ProgramOutput output)
{
    std::optional<TemporaryFolder> folder;
    std::filesystem::path          file;
    if (output == ProgramOutput::kept) file = folder.emplace("ssrlab_program").path / "said";
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    std::fflush(nullptr); // what this process says comes first
    const pid_t child = ::fork();
    if (child < 0) throw_failure("{} cannot be started: {}", words[0], std::strerror(errno));
    if (child == 0) {
        if (folder) {
            const int kept = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            ::dup2(kept, STDOUT_FILENO);
            ::dup2(kept, STDERR_FILENO);
        }
        ::execvp(arguments[0], arguments.data());
        ::_exit(program_is_missing);
    }
    int status = 0;
    if (::waitpid(child, &status, 0) != child) throw_failure("{} was lost: {}", words[0], std::strerror(errno));
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), folder ? read_file(file) : ""};
}

} // namespace ssrlab
