#include "gpu/shader_errors.h"

#include "core/files.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <regex>
#include <sstream>

namespace ssrlab {

namespace fs = std::filesystem;

std::string without_comments(std::string text)
{
    for (size_t i = 0; i + 1 < text.size(); ++i) {
        if (text[i] != '/' || (text[i + 1] != '/' && text[i + 1] != '*')) continue;
        const bool   line = text[i + 1] == '/';
        const size_t end  = std::min(text.find(line ? "\n" : "*/", i + 2), text.size() - 1) + (line ? 0 : 1);
        for (; i <= std::min(end, text.size() - 1); ++i)
            if (text[i] != '\n') text[i] = ' ';
    }
    return text;
}

namespace {

/// The line of the first '{' that is not closed; 0: none.
int unclosed_brace(const std::string& text)
{
    std::vector<int> open;
    int              line = 1;
    for (const char c : without_comments(text)) {
        line += c == '\n';
        if (c == '{') open.push_back(line);
        if (c == '}' && !open.empty()) open.pop_back();
    }
    return open.empty() ? 0 : open.front();
}

/// Where what a file lacks is said to be missing.
std::ptrdiff_t last_line(const fs::path& file)
{
    return std::max<std::ptrdiff_t>(std::ranges::count(read_file(file), '\n'), 1);
}

/// The first line that defines a function of this name; 0: none.
int line_defining(const std::string& text, const std::string& name)
{
    const std::string plain = without_comments(text);
    std::smatch       found;
    if (!std::regex_search(plain, found, std::regex("\\b\\w+\\s+(" + name + ")\\s*\\("))) return 0;
    return 1 + static_cast<int>(std::count(plain.begin(), plain.begin() + found.position(1), '\n'));
}

/// "path:12: 'x' : undeclared identifier". The project's shaders have no errors of their own: what is found in them is
/// missing from the plug-in's file.
std::string error_text(const std::string& error, const ShaderSource& source)
{
    if (source.include_files.empty() || !error.starts_with(shader_folder().string())) return error;
    for (const auto& [name, file] : source.include_files)
        if (const int line = unclosed_brace(read_file(file)); line > 0)
            return fmt::format("{}:{}: this '{{' is never closed", file.string(), line);
    if (error.find("'main' : function already has a body") != std::string::npos)
        for (const auto& [name, file] : source.include_files)
            if (const int line = line_defining(read_file(file), "main"); line > 0)
                return fmt::format("{}:{}: 'main' is reserved: the framework defines it", file.string(), line);
    const auto technique = source.include_files.find("technique/trace.glsl");
    if (technique != source.include_files.end()) {
        if (error.find("'trace' : no matching overloaded function found") != std::string::npos)
            return fmt::format("{}:{}: trace.glsl defines no TraceResult trace(Ray)", technique->second.string(),
                               last_line(technique->second));
        // It follows from the missing trace().
        if (error.find("'store_result' : no matching overloaded function found") != std::string::npos) return "";
    }
    for (const auto& [name, file] : source.include_files)
        if (error.starts_with(file.string() + ":")) return error; // a surface model of the project's files
    const fs::path& file = source.include_files.rbegin()->second;
    return fmt::format("{}:{}: {} (found where the file is used: {})", file.string(), last_line(file),
                       std::regex_replace(error, std::regex("^[^:]*:[0-9]+: "), ""), error.substr(0, error.find(": ")));
}

/// What the plug-in would have to write so that the name that is not found is there; empty: nothing would help.
std::string cure_of(const std::string& error, const ShaderSource& source, const std::vector<ShaderFile>& read)
{
    std::smatch      found;
    const std::regex unknown("'(\\w+)' : (no matching overloaded function found|undeclared identifier)");
    if (!std::regex_search(error, found, unknown)) return "";
    for (const auto& [line, file] : source.offered)
        if (line_defining(read_file(file), found[1]) > 0) return fmt::format(" (write {})", line);
    for (const fs::directory_entry& entry : fs::directory_iterator(shader_folder() / "api")) {
        const fs::path& file = entry.path();
        const auto      same = [&](const ShaderFile& other) { return other.name == file.string(); };
        if (file.stem().has_extension() || std::ranges::any_of(read, same)) continue; // a variant of another file
        if (line_defining(read_file(file), found[1]) > 0)
            return fmt::format(" (write #include \"api/{}\")", file.filename().string());
    }
    return "";
}

} // namespace

std::string shader_errors_in(const std::string& log, const ShaderSource& source, const std::vector<ShaderFile>& read)
{
    std::istringstream       lines(log);
    std::vector<std::string> errors;
    for (std::string line; std::getline(lines, line);) {
        constexpr std::string_view prefix = "ERROR: ";
        // The compiler's last line counts its errors.
        if (!line.starts_with(prefix) || line.ends_with("No code generated.")) continue;
        std::string error = error_text(line.substr(prefix.size()), source);
        if (!error.empty()) error += cure_of(error, source, read);
        if (!error.empty() && std::ranges::count(errors, error) == 0) errors.push_back(error);
    }
    return errors.empty() ? log : fmt::format("{}", fmt::join(errors, "\n"));
}

} // namespace ssrlab
