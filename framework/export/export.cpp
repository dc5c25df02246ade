#include "export/export.h"

#include "core/error.h"
#include "core/files.h"
#include "export/blocks.h"
#include "export/passes.h"
#include "export/translate.h"
#include "export/wgsl.h"
#include "trace/lab_passes.h"

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// One frame inside the lab: its rays, and what they found.
struct Traced {
    LabPtr                  lab;
    std::vector<RayInput>   rays;
    std::vector<RayOutcome> outcomes;
};

Traced trace(Gpu& gpu, const Export& what, const ExportFrame& frame)
{
    Traced traced;
    traced.lab =
        make_lab(gpu, what.catalogue, upload_gbuffer(gpu, frame.gbuffer), what.technique, what.values, what.settings);
    const size_t    pixels = frame.gbuffer.depth.size();
    const TracerPtr tracer = make_tracer(gpu, traced.lab, frame.rays.empty() ? pixels : frame.rays.size());
    traced.rays            = frame.rays.empty() ? set_up_rays(gpu, *tracer) : frame.rays;
    traced.outcomes        = trace_rays(gpu, *tracer, traced.rays);
    return traced;
}

Cost cost_of(const std::string& frame, std::span<const RayOutcome> outcomes)
{
    Cost cost{.frame = frame};
    for (const RayOutcome& outcome : outcomes) {
        cost.steps += outcome.steps;
        cost.depth_fetches += outcome.depth_fetches;
        cost.structure_fetches += outcome.structure_fetches;
    }
    const double rays = std::max<double>(1, static_cast<double>(outcomes.size()));
    return {frame, cost.steps / rays, cost.depth_fetches / rays, cost.structure_fetches / rays};
}

void make_folders(const fs::path& folder)
{
    std::error_code error;
    for (const char* name : {"frames", "expected"})
        if (!fs::create_directories(folder / name, error) && error)
            throw_failure("{}: cannot be created: {}", (folder / name).string(), error.message());
}

/// What a file begins with, above its shader.
std::string comment_of(const Export& what, const View& view, const ExportedPass& pass, bool is_trace)
{
    if (is_trace) return head_comment(what, view, pass);
    return fmt::format("// {}: a pass of the technique '{}'. README.md says how to run it.\n"
                       "// SPDX-License-Identifier: MIT. Copyright (c) 2026 the ssrlab authors\n\n",
                       pass.name, what.technique.id);
}

/// Behind the line #version, which comes first.
std::string with_comment(const std::string& glsl, const std::string& comment)
{
    const size_t line = glsl.find('\n') + 1;
    return glsl.substr(0, line) + comment + glsl.substr(line);
}

/// The pass as it is written, or as its translator gets it.
std::string glsl_for(ExportLanguage language, const ExportedPass& pass, const ResourceOf& resource_of,
                     const std::string& comment)
{
    if (language == ExportLanguage::hlsl) return with_one_block_where_written(pass.glsl, resource_of);
    if (language == ExportLanguage::wgsl) return glsl_for_wgsl(with_one_block_where_written(pass.glsl, resource_of));
    return with_comment(pass.glsl, comment);
}

void write_passes(Gpu& gpu, const Export& what, const View& view, const ComposedLab& composed,
                  std::vector<ExportedPass>& passes, Translations& translations, const fs::path& folder)
{
    for (ExportedPass& pass : passes) {
        const std::string comment  = comment_of(what, view, pass, &pass == &passes.back());
        const fs::path    glsl     = fs::absolute(folder / (pass.name + file_ending(ExportLanguage::glsl)));
        const auto        resource = [&](const std::string& name) {
            return resource_of(name, composed, short_path(pass.pass.source.file));
        };
        write_file_atomically(glsl, glsl_for(what.language, pass, resource, comment));
        const Shader shader = compile_shader(gpu, {.file = glsl});
        for (const auto& [name, binding] : shader.bindings) pass.bindings.emplace(binding.binding, resource(name));
        if (what.language == ExportLanguage::glsl) continue;
        const std::string text = translated(shader, what.language, comment, translations);
        if (what.language == ExportLanguage::hlsl) pass.registers = hlsl_registers(text);
        write_file_atomically(folder / (pass.name + file_ending(what.language)), text);
        fs::remove(glsl);
    }
}

} // namespace

const char* file_ending(ExportLanguage language)
{
    switch (language) {
    case ExportLanguage::glsl: return ".comp";
    case ExportLanguage::hlsl: return ".hlsl";
    case ExportLanguage::msl: return ".metal";
    case ExportLanguage::essl: return ".essl";
    case ExportLanguage::wgsl: return ".wgsl";
    }
    return "";
}

namespace {

void write_into(Gpu& gpu, const Export& what, std::span<const ExportFrame> frames, Translations& translations,
                const fs::path& folder)
{
    make_folders(folder);
    if (what.language == ExportLanguage::wgsl)
        write_file_atomically(folder / "run.js", read_file(web_folder() / "run.js"));
    std::vector<ExportedPass> passes;
    for (const ExportFrame& frame : frames) {
        const Traced              traced   = trace(gpu, what, frame);
        const ComposedLab         composed = compose_lab(gpu, *traced.lab, traced.rays.size());
        std::vector<ExportedPass> of_frame = export_passes(gpu, *traced.lab, composed, what.kept);
        if (passes.empty()) write_passes(gpu, what, frame.gbuffer.view, composed, of_frame, translations, folder);
        for (size_t i = 0; i < of_frame.size() && !passes.empty(); ++i) {
            if (of_frame[i].glsl != passes[i].glsl)
                throw std::logic_error("write_export: frames need different shaders");
            of_frame[i].bindings  = passes[i].bindings;
            of_frame[i].registers = passes[i].registers;
        }
        passes = std::move(of_frame);
        write_frame(gpu, *traced.lab, composed, passes, frame, traced.rays, traced.outcomes, what.language, folder);
        if (&frame == &frames.back())
            write_file_atomically(folder / "README.md", readme(what, frame.gbuffer.view, passes, composed,
                                                               cost_of(frame.name, traced.outcomes)));
    }
}

} // namespace

void write_export(Gpu& gpu, const Export& what, std::span<const ExportFrame> frames, Translations& translations,
                  const fs::path& folder)
{
    const bool is_there = fs::exists(folder);
    if (is_there && (!fs::is_directory(folder) || !fs::is_empty(folder)))
        throw_spec_error("-o {}: expected a new or empty folder", folder.string());
    try {
        write_into(gpu, what, frames, translations, folder);
    } catch (...) { // the corrected command must not find a part of this one
        std::error_code error;
        if (is_there)
            for (const auto& entry : fs::directory_iterator(folder, error)) fs::remove_all(entry.path(), error);
        else
            fs::remove_all(folder, error);
        throw;
    }
}

} // namespace ssrlab
