#include "viewer/script.h"

#include "core/error.h"
#include "core/files.h"
#include "core/names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace ssrlab {
namespace {

struct KnownCommand {
    const char* word;
    size_t      arguments;
};
constexpr std::array<KnownCommand, 8> known_commands = {{{"set", 1},
                                                         {"orbit", 2},
                                                         {"look", 2},
                                                         {"fly", 3},
                                                         {"approach", 1},
                                                         {"cursor", 2},
                                                         {"print", 0},
                                                         {"screenshot", 1}}};

void require_known(const ScriptCommand& command)
{
    const auto found = std::ranges::find(known_commands, command.word, &KnownCommand::word);
    if (found == known_commands.end()) {
        std::vector<std::string> words;
        for (const KnownCommand& one : known_commands) words.emplace_back(one.word);
        throw_spec_error("{}: {}", command.place, unknown_name("command", command.word, words));
    }
    if (command.arguments.size() != found->arguments)
        throw_spec_error("{}: '{}' has {} arguments, got {}", command.place, command.word, found->arguments,
                         command.arguments.size());
}

} // namespace

std::vector<ScriptCommand> read_script(const std::filesystem::path& file)
{
    if (!std::filesystem::exists(file)) throw_spec_error("{}: no such file", file.string());
    const std::vector<unsigned char> bytes = read_regular_file(file, 1U << 20U);
    std::istringstream               lines(std::string(bytes.begin(), bytes.end()));
    std::vector<ScriptCommand>       commands;
    std::string                      line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::istringstream words(line.substr(0, line.find('#')));
        ScriptCommand      command{fmt::format("{}:{}", file.string(), number), {}, {}};
        if (!(words >> command.word)) continue;
        for (std::string word; words >> word;) command.arguments.push_back(word);
        require_known(command);
        commands.push_back(std::move(command));
    }
    return commands;
}

double number_of(const ScriptCommand& command, size_t i)
{
    const std::string& text  = command.arguments[i];
    double             value = 0;
    const auto         read  = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(value))
        throw_spec_error("{}: expected a number, got '{}'", command.place, text);
    return value;
}

} // namespace ssrlab
