// Runs another program.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace ssrlab {

/// Where stdout and stderr of a program go: to those of this process, or into ProgramEnd::output.
enum class ProgramOutput : uint8_t { shown, kept };

inline constexpr int program_is_missing = 127;

struct ProgramEnd {
    int         code = 0; // exit code; 128 and more: ended by a signal
    std::string output;   // empty where it was shown
};

/// Runs a program, which is looked for in PATH unless its name has a slash, and waits for its end. Throws Failure if no
/// process can be started.
ProgramEnd run_program(const std::vector<std::string>& words, ProgramOutput output);

} // namespace ssrlab
