#include "app/python_script.h"

#include "core/error.h"
#include "core/files.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <sys/wait.h>
#include <unistd.h>

namespace ssrlab {

void run_python(const std::string& script, const std::vector<std::string>& arguments)
{
    // Debian's python3 has Debian's matplotlib; another one may come first in PATH.
    const std::string  path = (data_root() / script).string();
    std::vector<char*> words{const_cast<char*>("python3"), const_cast<char*>(path.c_str())};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child < 0) throw_failure("the plot script cannot be started: {}", std::strerror(errno));
    if (child == 0) {
        ::execv("/usr/bin/python3", words.data());
        ::_exit(127);
    }
    int status = 0;
    if (::waitpid(child, &status, 0) != child) throw_failure("the plot script was lost: {}", std::strerror(errno));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw_failure("{} failed; it needs /usr/bin/python3 with matplotlib and pandas", path);
}

} // namespace ssrlab
