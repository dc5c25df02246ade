#include "gpu/shader_includes.h"

#include "core/files.h"
#include "gpu/shader_errors.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// The file of that name in a folder; empty: none. A link does not lead out of it.
fs::path file_in(const fs::path& folder, const std::string& name)
{
    const fs::path path = folder / name;
    if (!fs::is_regular_file(path)) return {};
    const fs::path way = fs::canonical(path).lexically_relative(fs::canonical(folder));
    return *way.begin() == ".." ? fs::path() : path;
}

/// NAME.macro.glsl for NAME.glsl, of those macros that are defined.
std::vector<fs::path> variants_of(const fs::path& path, const std::map<std::string, std::string>& defines)
{
    std::vector<fs::path> variants;
    for (const auto& [macro, value] : defines) {
        std::string ending = macro;
        std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
        const fs::path variant =
            file_in(path.parent_path(), path.stem().string() + "." + ending + path.extension().string());
        if (!variant.empty()) variants.push_back(variant);
    }
    return variants;
}

/// Lines that hold more than comments and blanks.
int count_code_lines(const std::string& text)
{
    std::istringstream lines(without_comments(text));
    int                count = 0;
    for (std::string line; std::getline(lines, line);) count += line.find_first_not_of(" \t\r") != std::string::npos;
    return count;
}

} // namespace

bool lies_in(const fs::path& folder, const fs::path& other)
{
    const fs::path from_other = fs::weakly_canonical(folder).lexically_relative(fs::weakly_canonical(other));
    return !from_other.empty() && *from_other.begin() != "..";
}

glslang::TShader::Includer::IncludeResult* ShaderIncluder::includeLocal(const char* name, const char* from,
                                                                        size_t depth)
{
    constexpr size_t max_depth = 32;
    if (depth > max_depth) return refused("includes are nested more than 32 deep");
    if (const auto text = source_.include_texts.find(name); text != source_.include_texts.end())
        return found(name, read_once(name, text->second));
    if (const auto file = source_.include_files.find(name); file != source_.include_files.end())
        return found_file(file->second);
    if (fs::path(name).is_absolute() || std::ranges::count(fs::path(name), "..") > 0)
        return refused("may only name files of its own folder or of the project's shaders, without '..'");
    const std::vector<fs::path> files = candidates(name, fs::path(from).parent_path());
    if (files.empty()) return refused("no such file in its own folder or among the project's shaders");
    // One would silently stand for the other: for the trace API, say.
    if (files.size() > 1) return refused("may be " + files[0].string() + " or " + files[1].string());
    return found_file(files[0]);
}

glslang::TShader::Includer::IncludeResult* ShaderIncluder::includeSystem(const char* name, const char* from,
                                                                         size_t depth)
{
    return includeLocal(name, from, depth);
}

/// Beside the including file, else in the source's folders; and always those of the project.
std::vector<fs::path> ShaderIncluder::candidates(const std::string& name, const fs::path& beside) const
{
    std::vector<fs::path> files;
    const auto            add = [&](const fs::path& folder) {
        const fs::path path = file_in(folder, name);
        const auto     same = [&](const fs::path& file) { return fs::equivalent(file, path); };
        if (!path.empty() && std::ranges::none_of(files, same)) files.push_back(path);
    };
    std::vector<fs::path> own = source_.include_folders;
    own.push_back(shader_folder());
    own.push_back(technique_folder());
    if (std::ranges::any_of(own, [&](const fs::path& folder) { return lies_in(beside, folder); })) add(beside);
    if (files.empty())
        for (const fs::path& folder : source_.include_folders) add(folder);
    add(shader_folder());
    add(technique_folder());
    return files;
}

std::string ShaderIncluder::read_main_file()
{
    const fs::path path = shader_folder() / source_.file;
    return read_once(path.string(), read_file(path));
}

/// The text, or nothing where it was read before.
std::string ShaderIncluder::read_once(const std::string& shown, const std::string& text)
{
    if (!read_.insert(fs::weakly_canonical(shown)).second) return "";
    files_.push_back({shown, count_code_lines(text)});
    return text;
}

glslang::TShader::Includer::IncludeResult* ShaderIncluder::found_file(fs::path path)
{
    for (auto variants = variants_of(path, source_.defines); !variants.empty();
         variants      = variants_of(path, source_.defines)) {
        if (variants.size() > 1) return refused("may be " + variants[0].string() + " or " + variants[1].string());
        path = variants[0];
    }
    return found(path.string(), read_once(path.string(), read_file(path)));
}

glslang::TShader::Includer::IncludeResult* ShaderIncluder::found(const std::string& shown, std::string text)
{
    texts_.push_back(std::move(text));
    results_.push_back(std::make_unique<IncludeResult>(shown, texts_.back().data(), texts_.back().size(), nullptr));
    return results_.back().get();
}

/// Without a name, the text becomes the error.
glslang::TShader::Includer::IncludeResult* ShaderIncluder::refused(std::string why)
{
    return found("", std::move(why));
}

} // namespace ssrlab
