// What #include may name in a shader, and where that is found.
#pragma once

#include "gpu/shader.h"

#include <glslang/Public/ShaderLang.h>

#include <list>
#include <memory>

namespace ssrlab {

/// Is this folder that one, or inside it?
bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& other);

/// Resolves includes: virtual names first, then files of the source's folders, then those of the project. What it refuses becomes the compiler's error.
class ShaderIncluder : public glslang::TShader::Includer {
public:
    /// `source` must outlive it.
    explicit ShaderIncluder(const ShaderSource& source) : source_(source) {}

    IncludeResult* includeLocal(const char* name, const char* from, size_t depth) override;
    IncludeResult* includeSystem(const char* name, const char* from, size_t depth) override;
    void           releaseInclude(IncludeResult*) override {}

private:
    std::vector<std::filesystem::path> candidates(const std::string& name, const std::filesystem::path& beside) const;
    IncludeResult*                     found(const std::string& shown, std::string text);
    IncludeResult*                     refused(std::string why);

    const ShaderSource&                       source_;
    std::list<std::string>                    texts_;
    std::list<std::unique_ptr<IncludeResult>> results_;
};

} // namespace ssrlab
