#include "gpu/resolved_text.h"

#include "core/error.h"
#include "core/files.h"
#include "gpu/glslang_process.h"
#include "gpu/shader_errors.h"
#include "gpu/shader_includes.h"

#include <glslang/Public/ResourceLimits.h>

#include <cstdlib>
#include <list>
#include <memory>
#include <set>
#include <utility>

namespace ssrlab {
namespace {

// Each line after a directive of #if gets a number by a #pragma. The preprocessor passes on those pragmas whose branch is taken.
constexpr const char* mark = "ssrlab_branch_";

enum class Directive { none, opens, changes, closes, includes };

struct Line {
    std::string text;
    Directive   directive = Directive::none;
    int         branch    = -1; // that begins after this line
};

/// One inclusion of a file.
struct Inclusion {
    std::vector<Line> lines;
};

/// Whether a comment over several lines is open at the end of the line.
bool in_comment_after(std::string_view line, bool in_comment)
{
    for (size_t i = 0; i < line.size(); ++i) {
        const std::string_view two = line.substr(i, 2);
        if (!in_comment && two == "//") return false;
        if (two == (in_comment ? "*/" : "/*")) {
            in_comment = !in_comment;
            ++i;
        }
    }
    return in_comment;
}

Directive directive_of(std::string_view line)
{
    const size_t hash = line.find_first_not_of(" \t");
    if (hash == std::string_view::npos || line[hash] != '#') return Directive::none;
    const size_t begin = line.find_first_not_of(" \t", hash + 1);
    if (begin == std::string_view::npos) return Directive::none;
    const std::string_view word = line.substr(begin, line.find_first_of(" \t(\"<!", begin) - begin);
    if (word == "if" || word == "ifdef" || word == "ifndef") return Directive::opens;
    if (word == "elif" || word == "else") return Directive::changes;
    if (word == "endif") return Directive::closes;
    return word == "include" ? Directive::includes : Directive::none;
}

/// Hands out the same files with marks in them, and keeps what it handed out.
class MarkingIncluder : public glslang::TShader::Includer {
public:
    explicit MarkingIncluder(const ShaderSource& source) : files_(source) {}

    std::string                    marked_main_file() { return marked(files_.read_main_file()); }
    const std::vector<ShaderFile>& files() const { return files_.files(); }

    /// The text with marks.
    std::string marked(std::string_view text)
    {
        Inclusion   inclusion;
        std::string result;
        bool        in_comment = false, continues = false;
        for (size_t begin = 0; begin < text.size();) {
            const size_t end = std::min(text.find('\n', begin), text.size());
            Line         line{std::string(text.substr(begin, end - begin))};
            if (!in_comment && !continues) line.directive = directive_of(line.text);
            in_comment = in_comment_after(line.text, in_comment);
            continues  = line.text.ends_with('\\');
            result += line.text + '\n';
            if (line.directive == Directive::opens || line.directive == Directive::changes) pending_ = branches_++;
            if (pending_ >= 0 && !continues) { // behind the last line of a directive that continues
                result += fmt::format("#pragma {}{}\n", mark, pending_);
                line.branch = std::exchange(pending_, -1);
            }
            inclusion.lines.push_back(std::move(line));
            begin = end + 1;
        }
        inclusions_.push_back(std::move(inclusion));
        return result;
    }

    IncludeResult* includeLocal(const char* name, const char* from, size_t depth) override
    {
        IncludeResult* file = files_.includeLocal(name, from, depth);
        if (file->headerName.empty()) return file; // refused
        texts_.push_back(marked({file->headerData, file->headerLength}));
        results_.push_back(
            std::make_unique<IncludeResult>(file->headerName, texts_.back().data(), texts_.back().size(), nullptr));
        return results_.back().get();
    }
    IncludeResult* includeSystem(const char* name, const char* from, size_t depth) override
    {
        return includeLocal(name, from, depth);
    }
    void releaseInclude(IncludeResult*) override {}

    const std::vector<Inclusion>& inclusions() const { return inclusions_; }

private:
    ShaderIncluder                            files_;
    std::vector<Inclusion>                    inclusions_; // in the order of their #include
    int                                       branches_ = 0, pending_ = -1;
    std::list<std::string>                    texts_;
    std::list<std::unique_ptr<IncludeResult>> results_;
};

std::set<int> taken_branches(std::string_view preprocessed)
{
    std::set<int> taken;
    for (size_t at = preprocessed.find(mark); at != std::string_view::npos; at = preprocessed.find(mark, at + 1))
        taken.insert(std::atoi(preprocessed.data() + at + std::string_view(mark).size()));
    return taken;
}

/// Writes inclusion number `next` with what it includes.
void write(const std::vector<Inclusion>& inclusions, const std::set<int>& taken, size_t& next, std::string& text)
{
    std::vector<bool> active{true};
    for (const Line& line : inclusions[next++].lines) {
        if (line.directive == Directive::opens) active.push_back(false);
        if (line.branch >= 0) active.back() = taken.contains(line.branch);
        if (line.directive == Directive::closes) active.pop_back();
        if (!active.back() || line.directive == Directive::closes || line.branch >= 0) continue;
        if (line.directive == Directive::none) text += line.text + '\n';
        if (line.directive != Directive::includes) continue;
        text += '\n'; // or a comment above would seem to belong to what is included
        write(inclusions, taken, next, text);
    }
}

} // namespace

std::string resolved_text(const Gpu& gpu, ShaderSource source)
{
    start_glslang();
    add_device_defines(gpu, source);
    const std::string path = (shader_folder() / source.file).string();
    MarkingIncluder   includer(source);
    const std::string marked   = includer.marked_main_file();
    const std::string preamble = preamble_of(source);

    glslang::TShader shader(EShLangCompute);
    const char*      strings[] = {marked.c_str()};
    const char*      names[]   = {path.c_str()};
    const int        lengths[] = {static_cast<int>(marked.size())};
    shader.setStringsWithLengthsAndNames(strings, lengths, names, 1);
    shader.setPreamble(preamble.c_str());
    target_vulkan(shader, glslang::EShSourceGlsl, EShLangCompute);
    const auto  messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
    std::string preprocessed;
    if (!shader.preprocess(GetDefaultResources(), 460, ECoreProfile, false, false, messages, &preprocessed, includer))
        throw SpecError(shader_errors_in(shader.getInfoLog(), source, includer.files()));

    std::string text = preamble.substr(preamble.find("#define")); // without its extensions
    size_t      next = 0;
    write(includer.inclusions(), taken_branches(preprocessed), next, text);
    return text;
}

} // namespace ssrlab
