#include "trace/structure_passes.h"

#include "core/pixel_index.h"
#include "shared.h"
#include "trace/shader_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace ssrlab {
namespace {

constexpr int first_binding = 32, group_fetches_binding = 31;

/// An element type of GLSL as the macros of shaders/layout/structure_buffers.glsl want it.
struct ElementType {
    int         words;
    const char *swizzle, *from_bits, *to_bits;
    vk::Format  texels;
};

ElementType element_type(const std::string& type)
{
    static const std::map<std::string, ElementType> types = {
        {"uint", {1, "x", "uint", "uint", vk::Format::eR32Uint}},
        {"uvec2", {2, "xy", "uvec2", "uvec2", vk::Format::eR32G32Uint}},
        {"uvec4", {4, "xyzw", "uvec4", "uvec4", vk::Format::eR32G32B32A32Uint}},
        {"float", {1, "x", "uintBitsToFloat", "floatBitsToUint", vk::Format::eR32Uint}},
        {"vec2", {2, "xy", "uintBitsToFloat", "floatBitsToUint", vk::Format::eR32G32Uint}},
        {"vec4", {4, "xyzw", "uintBitsToFloat", "floatBitsToUint", vk::Format::eR32G32B32A32Uint}},
        {"real2", {2, "xy", "uintBitsToFloat", "floatBitsToUint", vk::Format::eR32G32Uint}}};
    return types.at(type);
}

bool is_double(const StructureBuffer& buffer, bool in_double) { return in_double && buffer.type == "real2"; }

glm::ivec2 tiles_of(glm::ivec2 size_px, int tile_px) { return (size_px - 1) / tile_px + 1; }

size_t ray_groups(const RayBuffers& rays) { return (std::max<size_t>(rays.capacity, 1) - 1) / RAYS_PER_GROUP + 1; }

size_t element_count(const StructureBuffer& buffer, glm::ivec2 size_px, const RayBuffers& rays)
{
    const auto count = static_cast<size_t>(buffer.count);
    switch (buffer.per) {
    case SizeRule::tile: return count * pixel_count(tiles_of(size_px, buffer.tile_px));
    case SizeRule::cell: return count * pixel_count({level_size(size_px, 1).x, std::max(pyramid_root(size_px), 1)});
    case SizeRule::ray_group: return count * ray_groups(rays);
    default: return count * pixel_count(size_px);
    }
}

Buffer make_structure_buffer(Gpu& gpu, const StructureBuffer& buffer, glm::ivec2 size_px, const RayBuffers& rays)
{
    const size_t      elements = element_count(buffer, size_px, rays);
    const ElementType type     = element_type(buffer.type);
    if (is_double(buffer, rays.number_format == NumberFormat::float64))
        return make_buffer(gpu, elements * 2 * sizeof(double));
    return make_texel_buffer(gpu, elements * static_cast<size_t>(type.words) * sizeof(uint32_t), type.texels);
}

std::string group_fetches_key(const Structure& structure) { return structure.id + ".(group fetches)"; }

bool is_per_ray(const StructurePass& pass) { return pass.per == SizeRule::ray_group; }

bool is_of_style(const StructurePass& pass, const GpuInfo& device)
{
    return pass.style == PassStyle::by_device || (pass.style == PassStyle::parallel) == (device.lanes > 1);
}

bool builds_per_ray(const Structure& structure) { return std::ranges::any_of(structure.passes, is_per_ray); }

/// `id` and all that it reads.
std::set<std::string> read_by(const Technique& technique, const std::string& id)
{
    std::set<std::string> ids{id};
    for (const Structure& structure : technique.structures)
        if (structure.id == id)
            for (const std::string& read : structure.reads) ids.merge(read_by(technique, read));
    return ids;
}

bool belongs_to(const Parameter& parameter, const std::set<std::string>& ids)
{
    return ids.contains(parameter.name.substr(0, parameter.name.find('.'))) &&
           parameter.name.find('.') != std::string::npos;
}

ShaderSource shader_of(const Technique& technique, const Structure& structure, const StructurePass& pass,
                       bool in_double)
{
    const std::set<std::string> ids = read_by(technique, structure.id);
    std::string                 parameters;
    for (size_t i = 0; i < technique.parameters.size(); ++i)
        if (belongs_to(technique.parameters[i], ids))
            parameters += parameter_declarations(std::span(&technique.parameters[i], 1),
                                                 CONSTANT_PARAMETERS + static_cast<uint32_t>(i));
    ShaderSource source{
        .file            = std::filesystem::absolute(pass.shader),
        .include_files   = structure_include_files(technique),
        .include_texts   = {{"structure/parameters", parameters},
                            {"structure/buffers", structure_declarations(technique, &structure, in_double)}},
        .include_folders = technique_folders(technique)};
    source.defines.emplace("BUILDS_STRUCTURE", "1");
    source.defines.emplace("STRUCTURES", std::to_string(technique.structures.size()));
    return source;
}

int last_level(const Lab& lab, const StructurePass& pass, glm::ivec2 size_px)
{
    const auto* name = std::get_if<std::string>(&pass.last_level);
    const int   last = name != nullptr ? static_cast<int>(lab.values.at(*name)) : std::get<int>(pass.last_level);
    return std::min(last, pyramid_levels(size_px));
}

void add_dispatches(StructureDispatch& dispatch, const Lab& lab, const StructurePass& pass, glm::ivec2 size_px)
{
    switch (pass.per) {
    case SizeRule::tile: dispatch.groups.push_back(groups_of_8(tiles_of(size_px, pass.tile_px))); break;
    case SizeRule::ray_group: dispatch.per_ray = true; break;
    case SizeRule::level:
        for (int level = pass.first_level, last = last_level(lab, pass, size_px); level <= last;
             level += pass.levels_per_dispatch) {
            dispatch.levels.emplace_back(level, std::min(level + pass.levels_per_dispatch - 1, last));
            dispatch.groups.push_back(groups_of_8((level_size(size_px, level) - 1) / pass.cells_per_invocation + 1));
        }
        break;
    default: dispatch.groups.push_back(groups_of_8(size_px));
    }
}

/// 64 bits at once where the device can and each of the structure's buffers fits into a storage buffer.
Defines store_defines_of(const Gpu& gpu, const Structure& structure, const GBuffer& gbuffer, const RayBuffers& rays)
{
    Defines defines;
    for (const StructureBuffer& buffer : structure.buffers) {
        if (buffer.per == SizeRule::ray_group && !rays.structures) continue;
        const StructureBuffers& buffers = buffer.per == SizeRule::ray_group ? *rays.structures : *gbuffer.structures;
        const Buffer&           bytes =
            buffer.per == SizeRule::depth_cell ? gbuffer.depth.cells : buffers.at(structure.id + "." + buffer.name);
        defines = store_defines(gpu, bytes);
        if (defines.empty()) return {};
    }
    return defines;
}

StructureDispatch make_dispatch(Gpu& gpu, const Lab& lab, const Structure& structure, const StructurePass& pass,
                                const RayBuffers& rays, const Bindings& bindings)
{
    const ShaderSource source   = build_source(gpu, lab, structure, pass, rays, bindings.contains("Work"));
    StructureDispatch  dispatch = dispatches_of(lab, pass);
    dispatch.pass =
        make_compute_pass(gpu, compile_shader(gpu, source), bindings,
                          build_constants(lab, is_per_ray(pass) ? rays.number_format : NumberFormat::float32),
                          pass.per == SizeRule::level ? sizeof(glm::ivec2) : 0);
    return dispatch;
}

std::vector<StructurePasses> make_structures(Gpu& gpu, const Lab& lab, const RayBuffers& rays, Bindings bindings,
                                             bool per_ray)
{
    bindings.merge(structure_bindings(gpu, lab.technique, *lab.gbuffer, rays));
    std::vector<StructurePasses> structures;
    for (const Structure& structure : lab.technique.structures) {
        StructurePasses passes{structure.id, {}};
        if (per_ray && builds_per_ray(structure)) {
            const Buffer& fetches = rays.structures->at(group_fetches_key(structure));
            bindings.insert_or_assign("group_fetches_stored", fetches);
        }
        for (const StructurePass& pass : passes_on(gpu, structure))
            if (is_per_ray(pass) == per_ray)
                passes.dispatches.push_back(make_dispatch(gpu, lab, structure, pass, rays, bindings));
        structures.push_back(std::move(passes));
    }
    return structures;
}

std::string buffer_declarations(const StructureBuffer& buffer, int binding, bool stored, bool in_double)
{
    std::string text = fmt::format("#include \"layout/structure_buffers.glsl\"\nconst int {}_count = {};\n",
                                   buffer.name, buffer.count);
    if (is_double(buffer, in_double)) {
        text += fmt::format("LOADED_DOUBLES({}, {}, {})\n", binding, buffer.name, buffer.type);
        if (stored) text += fmt::format("STORED_DOUBLES({}, {}, {})\n", binding + 1, buffer.name, buffer.type);
        return text;
    }
    const ElementType type = element_type(buffer.type);
    text += fmt::format("LOADED_BUFFER({}, {}, {}, {}, {}, {})\n", binding, buffer.name, buffer.type, type.words,
                        type.from_bits, type.swizzle);
    if (stored)
        text += fmt::format("STORED_BUFFER_{}({}, {}, {}, {})\n", type.words, binding + 1, buffer.name, buffer.type,
                            type.to_bits);
    return text;
}

} // namespace

ShaderSource build_source(const Gpu& gpu, const Lab& lab, const Structure& structure, const StructurePass& pass,
                          const RayBuffers& rays, bool counts_work)
{
    ShaderSource source = shader_of(lab.technique, structure, pass, rays.number_format == NumberFormat::float64);
    add_surface(source, lab.surface, lab.settings.layers);
    source.defines.merge(number_format_defines(gpu, is_per_ray(pass) ? rays.number_format : NumberFormat::float32));
    source.defines.merge(store_defines_of(gpu, structure, *lab.gbuffer, rays));
    if (is_per_ray(pass)) source.defines.merge(ray_list_defines(gpu, rays));
    if (is_per_ray(pass) && counts_work) source.defines.emplace("COUNT_WORK", "1");
    return source;
}

Constants build_constants(const Lab& lab, NumberFormat number_format)
{
    Constants constants = settings_constants(lab.gbuffer->view, lab.settings, number_format);
    add_parameters(constants, lab.technique.parameters, lab.values, CONSTANT_PARAMETERS);
    return constants;
}

StructureDispatch dispatches_of(const Lab& lab, const StructurePass& pass)
{
    StructureDispatch dispatch;
    add_dispatches(dispatch, lab, pass, lab.gbuffer->view.size_px);
    return dispatch;
}

std::vector<StructurePass> passes_on(const Gpu& gpu, const Structure& structure)
{
    std::vector<StructurePass> passes;
    std::ranges::copy_if(structure.passes, std::back_inserter(passes),
                         [&](const StructurePass& pass) { return is_of_style(pass, gpu.info); });
    return passes;
}

size_t structure_buffer_bytes(const StructureBuffer& buffer, glm::ivec2 size_px, const RayBuffers& rays)
{
    const size_t word =
        is_double(buffer, rays.number_format == NumberFormat::float64) ? sizeof(double) : sizeof(uint32_t);
    return element_count(buffer, size_px, rays) * static_cast<size_t>(element_type(buffer.type).words) * word;
}

std::map<std::string, std::filesystem::path> structure_include_files(const Technique& technique)
{
    std::map<std::string, std::filesystem::path> files;
    for (const Structure& structure : technique.structures)
        if (const auto read = structure.folder / "read.glsl"; std::filesystem::exists(read))
            files.emplace("structure/" + structure.id + "/read.glsl", read);
    return files;
}

std::vector<StructurePasses> make_depth_structures(Gpu& gpu, const Lab& lab)
{
    Bindings bindings = surface_bindings(*lab.gbuffer);
    bindings.insert({"View", lab.gbuffer->view_uniforms});
    return make_structures(gpu, lab, RayBuffers{}, bindings, false);
}

std::vector<StructurePasses> make_ray_structures(Gpu& gpu, const Lab& lab, const RayBuffers& rays,
                                                 const Bindings& bindings)
{
    return make_structures(gpu, lab, rays, bindings, true);
}

std::vector<ShaderSource> structure_sources(Gpu& gpu, const Lab& lab, const RayBuffers& rays)
{
    structure_bindings(gpu, lab.technique, *lab.gbuffer, rays); // makes the buffers
    std::vector<ShaderSource> sources;
    for (const Structure& structure : lab.technique.structures)
        for (const StructurePass& pass : passes_on(gpu, structure))
            sources.push_back(build_source(gpu, lab, structure, pass, rays, false));
    return sources;
}

void record_structure(const Commands& commands, const StructurePasses& structure, const Buffer* group_launch)
{
    for (const StructureDispatch& dispatched : structure.dispatches) {
        if (dispatched.per_ray) dispatch_indirect(commands, dispatched.pass, *group_launch);
        for (size_t i = 0; i < dispatched.groups.size(); ++i) {
            if (!dispatched.levels.empty()) push(commands, dispatched.pass, dispatched.levels[i]);
            dispatch(commands, dispatched.pass, dispatched.groups[i]);
            barrier(commands);
        }
        barrier(commands);
    }
}

Bindings structure_bindings(Gpu& gpu, const Technique& technique, const GBuffer& gbuffer, const RayBuffers& rays)
{
    Bindings bindings;
    for (const Structure& structure : technique.structures) {
        for (const StructureBuffer& buffer : structure.buffers) {
            if (buffer.per == SizeRule::depth_cell) continue; // the depth's own
            const bool per_ray = buffer.per == SizeRule::ray_group;
            if (per_ray && !rays.structures) continue; // what is built on depth knows no rays
            StructureBuffers& buffers = per_ray ? *rays.structures : *gbuffer.structures;
            const std::string key     = structure.id + "." + buffer.name;
            if (!buffers.contains(key))
                buffers.emplace(key, make_structure_buffer(gpu, buffer, gbuffer.view.size_px, rays));
            bindings.insert({{buffer.name + "_loaded", buffers.at(key)}, {buffer.name + "_stored", buffers.at(key)}});
        }
        if (!builds_per_ray(structure) || !rays.structures) continue;
        if (const std::string key = group_fetches_key(structure); !rays.structures->contains(key))
            rays.structures->emplace(key,
                                     make_texel_buffer(gpu, ray_groups(rays) * sizeof(uint32_t), vk::Format::eR32Uint));
    }
    return bindings;
}

std::string structure_declarations(const Technique& technique, const Structure* built, bool in_double)
{
    const std::set<std::string> ids     = built == nullptr ? std::set<std::string>{} : read_by(technique, built->id);
    std::string                 text    = technique.structures.empty() ? "" : "#include \"api/structure_api.glsl\"\n";
    int                         binding = first_binding;
    for (size_t i = 0; i < technique.structures.size(); ++i)
        text += fmt::format("const int STRUCTURE_{} = {};\n", technique.structures[i].id, i);
    for (const Structure& structure : technique.structures) {
        const bool own = built != nullptr && structure.id == built->id;
        for (const StructureBuffer& buffer : structure.buffers) {
            if (buffer.per == SizeRule::depth_cell) continue;
            // What is built on depth is float in the double twin, too, and does not know the rays.
            if (built == nullptr || ids.contains(structure.id))
                text += buffer_declarations(buffer, binding, own, in_double);
            binding += 2;
        }
        if (!own && (built == nullptr || ids.contains(structure.id)) &&
            std::filesystem::exists(structure.folder / "read.glsl"))
            text += fmt::format("#include \"structure/{}/read.glsl\"\n", structure.id);
    }
    if (built != nullptr && builds_per_ray(*built))
        text += fmt::format("#ifdef COUNT_WORK\n#include \"layout/structure_buffers.glsl\"\nSTORED_BUFFER_1({}, "
                            "group_fetches, uint, uint)\n#else\n"
                            "void store_group_fetches(int group, uint fetches) {{}}\n#endif\n",
                            group_fetches_binding);
    return text;
}

std::vector<std::vector<uint32_t>> read_group_fetches(Gpu& gpu, const Technique& technique, const RayBuffers& rays)
{
    std::vector<std::vector<uint32_t>> fetches;
    for (const Structure& structure : technique.structures) {
        const std::string key = group_fetches_key(structure);
        fetches.push_back(builds_per_ray(structure) && rays.structures->contains(key)
                              ? download_as<uint32_t>(gpu, rays.structures->at(key), ray_groups(rays))
                              : std::vector<uint32_t>{});
    }
    return fetches;
}

} // namespace ssrlab
