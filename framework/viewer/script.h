// Commands of a file in the place of mouse and keyboard: docs/how-to/viewer.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ssrlab {

struct ScriptCommand {
    std::string              place; // file:line
    std::string              word;
    std::vector<std::string> arguments;
};

/// Throws SpecError for unknown commands and wrong numbers of arguments.
std::vector<ScriptCommand> read_script(const std::filesystem::path& file);

/// Argument i as a finite number; throws SpecError.
double number_of(const ScriptCommand& command, size_t i);

} // namespace ssrlab
