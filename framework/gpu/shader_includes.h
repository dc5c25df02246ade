// Resolves #include in shaders.
#pragma once

#include "gpu/shader_files.h"

#include <glslang/Public/ShaderLang.h>

#include <list>
#include <memory>

namespace ssrlab {

/// Adds what every shader of this device is compiled with.
void add_device_defines(const Gpu& gpu, ShaderSource& source);
/// What comes before the text of a source: extensions and its defines.
std::string preamble_of(const ShaderSource& source);

/// Whether the folder is `other` or lies inside it.
bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& other);

/// Resolves virtual names first, then files of the source, then of the project. Refusals become compile errors.
/// A file is read once: where it is included again, nothing stands. NAME.macro.glsl stands for NAME.glsl where the
/// source defines MACRO.
class ShaderIncluder : public glslang::TShader::Includer {
public:
    /// `source` must outlive it.
    explicit ShaderIncluder(const ShaderSource& source) : source_(source) {}

    /// Returns the text of the file that includes all others.
    std::string read_main_file();
    /// What was read, in order.
    const std::vector<ShaderFile>& files() const { return files_; }

    IncludeResult* includeLocal(const char* name, const char* from, size_t depth) override;
    IncludeResult* includeSystem(const char* name, const char* from, size_t depth) override;
    void           releaseInclude(IncludeResult*) override {}

private:
    std::vector<std::filesystem::path> candidates(const std::string& name, const std::filesystem::path& beside) const;
    IncludeResult*                     found(const std::string& shown, std::string text);
    IncludeResult*                     found_file(std::filesystem::path path);
    IncludeResult*                     refused(std::string why);
    std::string                        read_once(const std::string& shown, const std::string& text);

    const ShaderSource&                       source_;
    std::vector<ShaderFile>                   files_;
    std::set<std::filesystem::path>           read_;
    std::list<std::string>                    texts_;
    std::list<std::unique_ptr<IncludeResult>> results_;
};

} // namespace ssrlab
