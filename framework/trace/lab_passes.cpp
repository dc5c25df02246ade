#include "trace/lab_passes.h"

#include "core/error.h"
#include "core/files.h"
#include "shared.h"
#include "trace/shader_sources.h"

#include <algorithm>
#include <bit>

namespace ssrlab {
namespace {

/// Walks by borders in whole numbers (shaders/api/grid.exact_arithmetic.glsl). A define, not a constant: 64-bit integers
/// must not even be declared on a device without them.
constexpr const char* exact_arithmetic = "EXACT_ARITHMETIC";

/// The choice of a parameter that asks for integers of 128 bits, "NAME = CHOICE"; empty: none does.
std::string exact_choice(const Technique& technique, const ParameterValues& values)
{
    for (const Parameter& parameter : technique.parameters) {
        const std::string chosen = format_parameter(parameter, values.at(parameter.name));
        const auto        define = parameter.defines.find(chosen);
        if (define != parameter.defines.end() && define->second == exact_arithmetic)
            return fmt::format("{} = {}", parameter.name, chosen);
    }
    return "";
}

/// Throws where this choice of a parameter needs what the device or the surface model does not have.
void require_exact_arithmetic(const Gpu& gpu, const Lab& lab, const std::string& chosen)
{
    if (const std::string missing = missing_feature(gpu, lab.technique, lab.values); !missing.empty())
        throw_failure("{}", missing);
    if (!std::filesystem::exists(lab.surface.shaders / "meeting_exact.glsl"))
        throw_spec_error("{} needs a surface model with meeting_exact.glsl, which {} does not have", chosen,
                         short_path(lab.surface.folder));
}

} // namespace

std::string missing_feature(const Gpu& gpu, const Technique& technique, const ParameterValues& values)
{
    const std::string chosen = exact_choice(technique, values);
    if (chosen.empty() || (gpu.info.int64 && gpu.info.float64)) return "";
    return fmt::format("{} needs 64-bit integers and doubles in shaders; the device '{}' has no {}", chosen,
                       gpu.info.name, gpu.info.int64 ? "shaderFloat64" : "shaderInt64");
}

RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, NumberFormat number_format, int rays_of_pixels)
{
    const uint64_t listed_bytes = rays_of_pixels > 0                       ? sizeof(uint32_t)
                                  : number_format == NumberFormat::float64 ? sizeof(PackedRay<double>)
                                                                           : sizeof(PackedRay<float>);
    const uint64_t rays         = std::max<uint64_t>(capacity, 1);
    const uint64_t largest      = rays * sizeof(glm::uvec3); // what was counted of each, a storage buffer
    if (largest > gpu.impl->limits.maxStorageBufferRange)
        throw_failure("{} rays need a buffer of {} MiB; the device allows {} MiB", rays, largest >> 20,
                      gpu.impl->limits.maxStorageBufferRange >> 20);
    RayBuffers buffers;
    buffers.number_format   = number_format;
    buffers.capacity        = capacity;
    buffers.count           = make_buffer(gpu, 16);
    buffers.launch          = make_buffer(gpu, 16);
    buffers.list            = make_texel_buffer(gpu, rays * listed_bytes,
                                     rays_of_pixels > 0 ? vk::Format::eR32Uint : vk::Format::eR32G32B32A32Uint);
    buffers.list.item_bytes = listed_bytes;
    buffers.rays_of_pixels  = rays_of_pixels;
    buffers.hits            = number_format == NumberFormat::float64
                                  ? make_texel_buffer(gpu, rays * sizeof(PackedHit<double>), vk::Format::eR32G32B32A32Uint)
                                  : make_texel_buffer(gpu, rays * sizeof(PackedHit<float>), vk::Format::eR32G32Uint);

    buffers.group_launch = make_buffer(gpu, 16);
    buffers.structures   = std::make_shared<StructureBuffers>();
    return buffers;
}

Bindings ray_bindings(const GBuffer& gbuffer, const RayBuffers& rays)
{
    Bindings bindings = surface_bindings(gbuffer);
    bindings.insert({{"RayCount", rays.count},
                     {"RayLaunch", rays.launch},
                     {"GroupLaunch", rays.group_launch},
                     {"Rays", rays.list},
                     {"Hits", rays.hits},
                     {"TileMasks", gbuffer.tiles.masks},
                     {"TileLaunch", gbuffer.tiles.launch},
                     {"TileCount", gbuffer.tiles.count},
                     {"Tiles", gbuffer.tiles.tiles},
                     {"PictureStatistics", gbuffer.tiles.statistics}});
    return bindings;
}

int rays_per_workgroup(const Gpu& gpu) { return RAYS_PER_GROUP * RAY_GROUP_INVOCATIONS / gpu.info.lanes; }

ComputePass make_launch_pass(Gpu& gpu, const RayBuffers& rays)
{
    Constants constants;
    constants.add(CONSTANT_RAYS_PER_WORKGROUP, rays_per_workgroup(gpu));
    return make_compute_pass(gpu, compile_shader(gpu, {.file = "trace/dispatch_args.comp"}),
                             {{"RayCount", rays.count}, {"RayLaunch", rays.launch}, {"GroupLaunch", rays.group_launch}},
                             constants);
}

void set_ray_count(Gpu& gpu, const RayBuffers& rays, size_t count)
{
    submit(gpu, [&](const Commands& commands) {
        const auto launch_of = [&](int items_per_group) {
            return groups_in_rows(count, static_cast<size_t>(items_per_group), LAUNCH_ROW_GROUPS);
        };
        commands.updateBuffer<uint32_t>(*rays.count.buffer, 0, static_cast<uint32_t>(count));
        commands.updateBuffer<glm::uvec3>(*rays.launch.buffer, 0, launch_of(RAYS_PER_GROUP));
        commands.updateBuffer<glm::uvec3>(*rays.group_launch.buffer, 0, launch_of(rays_per_workgroup(gpu)));
        barrier(commands);
    });
}

ShaderSource trace_source(const Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Bindings& bindings)
{
    const Technique& technique = lab.technique;
    const bool       in_double = rays.number_format == NumberFormat::float64;
    ShaderSource     source{
            .file          = technique.rays_per_invocation == 2 ? "trace/trace_pairs.comp" : "trace/trace.comp",
            .defines       = number_format_defines(gpu, rays.number_format),
            .include_files = structure_include_files(technique),
            .include_texts = {{"technique/parameters", parameter_declarations(technique.parameters, CONSTANT_PARAMETERS)},
                              {"technique/structures", structure_declarations(technique, nullptr, in_double)}},
            .include_folders = technique_folders(technique)};
    source.include_files.emplace("technique/trace.glsl", technique.folder / "trace.glsl");
    for (const auto& [id, file] : technique.unread)
        source.offered.emplace(fmt::format("structures = [\"{}\"] in technique.toml", id), file);
    add_surface(source, lab.surface, lab.settings.layers);
    source.defines.emplace("STRUCTURES", std::to_string(technique.structures.size()));
    for (const std::string& macro : shader_macros(technique, lab.values)) source.defines.emplace(macro, "1");
    source.defines.merge(store_defines(gpu, rays.hits));
    source.defines.merge(ray_list_defines(gpu, rays));
    if (technique.rays_per_invocation == 2)
        source.defines.insert({{"TRACES_PAIRS", "1"}, {"PAIR_GROUPS", gpu.info.lanes > 1 ? "2" : "1"}});
    if (bindings.contains("Work")) source.defines.emplace("COUNT_WORK", "1");
    if (bindings.contains("Visits")) source.defines.emplace("RECORD_VISITS", "1");
    return source;
}

ShaderSource ray_setup_source(const Gpu& gpu, const RayBuffers& rays)
{
    Defines defines = number_format_defines(gpu, rays.number_format);
    defines.merge(store_defines(gpu, rays.list));
    defines.merge(ray_list_defines(gpu, rays));
    return {.file = "rays/rays.comp", .defines = defines};
}

Constants trace_constants(const Gpu& gpu, const Lab& lab, const RayBuffers& rays)
{
    const std::string exact = exact_choice(lab.technique, lab.values);
    if (!exact.empty()) require_exact_arithmetic(gpu, lab, exact);
    Constants constants = settings_constants(lab.gbuffer->view, lab.settings, rays.number_format, !exact.empty());
    add_parameters(constants, lab.technique.parameters, lab.values, CONSTANT_PARAMETERS);
    return constants;
}

TechniquePasses make_technique_passes(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Bindings& bindings)
{
    const Constants constants = trace_constants(gpu, lab, rays);
    TechniquePasses passes;
    passes.structures = make_ray_structures(gpu, lab, rays, bindings);
    Bindings all      = bindings;
    all.merge(structure_bindings(gpu, lab.technique, *lab.gbuffer, rays));
    passes.trace = make_compute_pass(gpu, compile_shader(gpu, trace_source(gpu, lab, rays, bindings)), all, constants);
    return passes;
}

void record_depth_structures(const Commands& commands, const Lab& lab)
{
    for (const StructurePasses& structure : lab.structures) record_structure(commands, structure, nullptr);
}

void record_technique(const Commands& commands, const TechniquePasses& passes, const RayBuffers& rays)
{
    for (const StructurePasses& structure : passes.structures)
        record_structure(commands, structure, &rays.group_launch);
    dispatch_indirect(commands, passes.trace, rays.launch);
}

namespace {

/// As many invocations a workgroup as all devices allow, or as this one allows where passes are parallel: the last one
/// lists all tiles.
Classification make_classification(Gpu& gpu, const Bindings& bindings, const Constants& constants)
{
    const bool     by_pixel = gpu.info.lanes > 1;
    const uint32_t most = std::min(gpu.impl->limits.maxComputeWorkGroupInvocations, 64U * CLASSIFIED_TILES_BY_PIXEL);
    const uint32_t invocations = by_pixel ? std::bit_floor(most) : uint32_t{CLASSIFIED_TILES};
    const char*    file        = by_pixel ? "rays/classification_by_pixel.comp" : "rays/classification.comp";
    const Shader   shader =
        compile_shader(gpu, {.file = file, .defines = {{"CLASSIFICATION_INVOCATIONS", std::to_string(invocations)}}});
    return {make_compute_pass(gpu, shader, bindings, constants), by_pixel ? invocations / 64 : invocations};
}

} // namespace

TracePasses make_trace_passes(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Buffer& view,
                              const RayChoice& choice, const Counters& counters)
{
    const GBuffer& gbuffer  = *lab.gbuffer;
    Bindings       bindings = ray_bindings(gbuffer, rays);
    bindings.insert({"View", view});
    if (counters.work != nullptr) bindings.insert({"Work", *counters.work});
    if (counters.visits != nullptr) bindings.insert({"Visits", *counters.visits});
    Constants constants = settings_constants(gbuffer.view, lab.settings, rays.number_format);
    constants.add(CONSTANT_EVERY_SURFACE, choice.every_surface ? 1 : 0);
    constants.add(CONSTANT_RAYS_PER_PIXEL, choice.per_pixel);
    constants.add(CONSTANT_LOBE_RAYS, choice.from_lobe ? 1 : 0);
    constants.add(CONSTANT_TRACE_BLOCK_PX, choice.block_px);
    constants.add(CONSTANT_RAYS_PER_WORKGROUP, rays_per_workgroup(gpu));
    TracePasses passes;
    passes.classification = make_classification(gpu, bindings, constants);
    passes.rays      = make_compute_pass(gpu, compile_shader(gpu, ray_setup_source(gpu, rays)), bindings, constants);
    passes.technique = make_technique_passes(gpu, lab, rays, bindings);
    return passes;
}

namespace {

void record_marking(const Commands& commands, const Classification& classification, const GBuffer& gbuffer)
{
    const glm::uvec3 tiles = groups_of_8(gbuffer.view.size_px);
    const uint32_t   each  = classification.tiles_per_group;
    dispatch(commands, classification.pass, {(tiles.x + each - 1) / each, tiles.y, 1});
    barrier(commands);
}

} // namespace

void record_classification(const Commands& commands, const TracePasses& passes, const GBuffer& gbuffer)
{
    barrier(commands);
    record_marking(commands, passes.classification, gbuffer);
}

void record_ray_setup(const Commands& commands, const TracePasses& passes, const GBuffer& gbuffer)
{
    dispatch_indirect(commands, passes.rays, gbuffer.tiles.launch);
    barrier(commands);
}

void record_rays(const Commands& commands, const TracePasses& passes, const GBuffer& gbuffer)
{
    record_classification(commands, passes, gbuffer);
    record_ray_setup(commands, passes, gbuffer);
}

const GBufferCounts& count_gbuffer(Gpu& gpu, GBuffer& gbuffer, const TraceSettings& settings)
{
    const std::pair rule(settings.dielectric_min_f0, settings.dielectric_max_roughness);
    const auto      known = gbuffer.counts.find(rule);
    if (known != gbuffer.counts.end()) return known->second;
    Bindings bindings = surface_bindings(gbuffer);
    bindings.insert({{"View", gbuffer.view_uniforms},
                     {"TileMasks", gbuffer.tiles.masks},
                     {"PictureStatistics", gbuffer.tiles.statistics}});
    for (const char* unused : {"TileLaunch", "TileCount", "Tiles", "RayCount", "RayLaunch", "GroupLaunch"})
        bindings.insert({unused, gbuffer.tiles.launch}); // no list is made
    Constants constants;
    add_reflecting(constants, settings);
    constants.add(CONSTANT_COUNTS_PIXELS, 1);
    const Classification classification = make_classification(gpu, bindings, constants);
    submit(gpu, [&](const Commands& commands) {
        commands.fillBuffer(*gbuffer.tiles.statistics.buffer, 0, VK_WHOLE_SIZE, 0);
        barrier(commands);
        record_marking(commands, classification, gbuffer);
    });
    return gbuffer.counts.emplace(rule, download_as<GBufferCounts>(gpu, gbuffer.tiles.statistics, 1)[0]).first->second;
}

TraceCounts count_hits(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const RayChoice& choice)
{
    const GBuffer&    gbuffer  = *lab.gbuffer;
    const TracePasses passes   = make_trace_passes(gpu, lab, rays, gbuffer.view_uniforms, choice);
    const Buffer      counts   = make_buffer(gpu, 16);
    Bindings          bindings = ray_bindings(gbuffer, rays);
    bindings.insert({{"View", gbuffer.view_uniforms}, {"TraceStatistics", counts}});
    const ComputePass count = make_compute_pass(
        gpu, compile_shader(gpu, {.file = "trace/trace_statistics.comp", .defines = ray_list_defines(gpu, rays)}),
        bindings, settings_constants(gbuffer.view, lab.settings, NumberFormat::float32));
    submit(gpu, [&](const auto& commands) {
        commands.fillBuffer(*counts.buffer, 0, VK_WHOLE_SIZE, 0);
        record_rays(commands, passes, gbuffer);
        record_depth_structures(commands, lab);
        record_technique(commands, passes.technique, rays);
        barrier(commands);
        dispatch_indirect(commands, count, rays.launch);
        barrier(commands);
    });
    return download_as<TraceCounts>(gpu, counts, 1)[0];
}

} // namespace ssrlab
