#include "harness/chip_cost.h"

#include "core/error.h"
#include "frame/frame.h"

#include <algorithm>
#include <filesystem>

namespace ssrlab {
namespace {

bool is_built_for_rays(const Structure& structure)
{
    return std::ranges::count(structure.passes, SizeRule::ray_group, &StructurePass::per) > 0;
}

/// What traces rays: "trace/trace.comp", or "trace/trace_pairs.comp" with two rays for each invocation.
const CompiledPipeline& trace_of(const CompiledFrame& frame, const std::string& technique)
{
    const auto found = std::ranges::find_if(frame.pipelines, [](const CompiledPtr& pipeline) {
        const std::filesystem::path file = pipeline->shader;
        return file.parent_path().filename() == "trace" && file.filename().string().starts_with("trace");
    });
    if (found == frame.pipelines.end() || !(*found)->statistics.contains("Instructions") || (*found)->assembly.empty())
        throw_failure("{}: the chip's compiler does not say which instructions its trace takes", technique);
    return **found;
}

} // namespace

ChipCode compile_for_chip(Gpu& chip, const Catalogue& catalogue, const Run& run)
{
    const Technique&        technique = find_technique(catalogue.techniques, run.technique);
    const CompiledFrame     frame     = compile_frame(chip, catalogue, technique, run.values, run.settings);
    const CompiledPipeline& trace     = trace_of(frame, technique.id);
    const bool              in_pairs  = std::filesystem::path(trace.shader).stem() == "trace_pairs";
    const double            share     = in_pairs ? 0.5 : 1; // of an invocation, for a ray
    const double            pixels    = static_cast<double>(frame.size_px.x) * frame.size_px.y;
    ChipCode                code;
    code.loop   = share * innermost_loop(trace.assembly).instructions;
    code.of_ray = share * static_cast<double>(trace.statistics.at("Instructions"));
    code.wave   = static_cast<int>(trace.lanes) * (in_pairs ? 2 : 1);
    for (const Structure& structure : technique.structures)
        for (const PassTraffic& pass : frame.passes)
            if (pass.pass == structure.id) // of a frame in which every pixel has a ray
                (is_built_for_rays(structure) ? code.of_ray : code.of_pixel) +=
                    static_cast<double>(pass.instructions) / pixels;
    return code;
}

std::optional<double> instructions_of(const ChipCode& code, const Record& row, glm::ivec2 size_px)
{
    const char* column = code.wave <= 32   ? "warp32_iterations_mean"
                         : code.wave <= 64 ? "wave64_iterations_mean"
                                           : "wave128_iterations_mean";
    const auto  rays = number_of(row, "rays"), iterations = number_of(row, column);
    if (!rays || !iterations || *rays == 0) return std::nullopt;
    return code.of_pixel * size_px.x * size_px.y / *rays + code.of_ray + code.loop * std::max(*iterations - 1, 0.0);
}

} // namespace ssrlab
