#include "app/python_script.h"

#include "core/error.h"
#include "core/files.h"
#include "core/run_program.h"

namespace ssrlab {

void run_python(const std::string& script, const std::vector<std::string>& arguments)
{
    // Debian's python3 has Debian's matplotlib; another one may come first in PATH.
    std::vector<std::string> words{"/usr/bin/python3", (data_root() / script).string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    if (run_program(words, ProgramOutput::shown).code != 0)
        throw_failure("{} failed; /usr/bin/python3 says why above", words[1]);
}

} // namespace ssrlab
