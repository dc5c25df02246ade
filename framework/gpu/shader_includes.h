// Resolves #include in shaders.
#pragma once

#include "gpu/shader.h"

#include <glslang/Public/ShaderLang.h>

#include <list>
#include <memory>

namespace ssrlab {

/// Whether the folder is `other` or lies inside it.
bool lies_in(const std::filesystem::path& folder, const std::filesystem::path& other);

/// Resolves virtual names first, then files of the source, then of the project. Refusals become compile errors.
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
