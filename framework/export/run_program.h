// Starts the translators and the browser. Folder-internal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

inline constexpr int program_is_missing = 127;

struct ProgramOutput {
    int         code = 0; // exit code; 128 and more: ended by a signal
    std::string text;     // stdout and stderr
};

/// Runs the program to its end. Throws Failure if it cannot be started for another reason than that it is missing.
ProgramOutput run_program(const std::vector<std::string>& words);

/// The scripts for WGSL, and where npm puts the packages that they need.
std::filesystem::path web_folder();

} // namespace ssrlab
