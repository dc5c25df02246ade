#include "export/run_program.h"

#include "core/error.h"
#include "core/files.h"
#include "core/temporary_folder.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace ssrlab {

ProgramOutput run_program(const std::vector<std::string>& words)
{
    const TemporaryFolder       folder("ssrlab_program");
    const std::filesystem::path output = folder.path / "said";
    std::vector<char*>          arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child < 0) throw_failure("{} cannot be started: {}", words[0], std::strerror(errno));
    if (child == 0) {
        const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        ::dup2(file, STDOUT_FILENO);
        ::dup2(file, STDERR_FILENO);
        ::execvp(arguments[0], arguments.data());
        ::_exit(program_is_missing);
    }
    int status = 0;
    if (::waitpid(child, &status, 0) != child) throw_failure("{} was lost: {}", words[0], std::strerror(errno));
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(output)};
}

std::filesystem::path web_folder() { return data_root() / "experiments/web"; }

} // namespace ssrlab
