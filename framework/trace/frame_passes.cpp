#include "trace/frame_passes.h"

#include "core/error.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "frame/layers.h"
#include "shared.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace ssrlab {
namespace {

/// Walks by borders in whole numbers (shaders/api/grid_exact.glsl). A define, not a constant: 64-bit integers must not even
/// be declared on a device without them.
constexpr const char* exact_arithmetic = "EXACT_ARITHMETIC";

/// shaders/api/slab.glsl says what the three numbers are.
struct Slab {
    double slope = 0, scale = 1, shift = 0;
};

/// Thickness 0 or more: of the back. Less: of a front that lies before the depth.
Slab slab_of(const View& view, const TraceSettings& trace, double thickness)
{
    if (std::isinf(thickness)) return {0, thickness > 0 ? 0 : 1e30, 0};
    if (view.projection == Projection::perspective) {
        if (!trace.thickness_relative) return {thickness / view.near_m, 1, 0};
        return {0, thickness > -1 ? 1 / (1 + thickness) : 1e30, 0};
    }
    const double range = view.far_m - view.near_m;
    return trace.thickness_relative ? Slab{0, 1 + thickness, thickness * view.far_m / range}
                                    : Slab{0, 1, thickness / range};
}

template <typename Real> void add_slab(Constants& constants, uint32_t first, const Slab& slab)
{
    constants.add(first, static_cast<Real>(slab.slope));
    constants.add(first + 1, static_cast<Real>(slab.scale));
    constants.add(first + 2, static_cast<Real>(slab.shift));
}
static_assert(CONSTANT_SLAB_SCALE == CONSTANT_SLAB_SLOPE + 1 && CONSTANT_SLAB_SHIFT == CONSTANT_SLAB_SLOPE + 2);
static_assert(CONSTANT_FRONT_SCALE == CONSTANT_FRONT_SLOPE + 1 && CONSTANT_FRONT_SHIFT == CONSTANT_FRONT_SLOPE + 2);

template <typename Real> void add_slabs(Constants& constants, const View& view, const TraceSettings& trace)
{
    add_slab<Real>(constants, CONSTANT_SLAB_SLOPE, slab_of(view, trace, trace.thickness_m));
    add_slab<Real>(constants, CONSTANT_FRONT_SLOPE, slab_of(view, trace, -trace.thickness_m));
}

} // namespace

void add_reflecting(Constants& constants, const TraceSettings& settings)
{
    constants.add(CONSTANT_DIELECTRIC_MIN_F0, static_cast<float>(settings.dielectric_min_f0));
    constants.add(CONSTANT_DIELECTRIC_MAX_ROUGHNESS, static_cast<float>(settings.dielectric_max_roughness));
}

namespace {

template <typename Real> void add_settings(Constants& constants, const View& view, const FrameSettings& settings)
{
    constants.add(CONSTANT_MAX_DISTANCE_M, static_cast<Real>(settings.trace.max_distance_m));
    constants.add(CONSTANT_RAY_OFFSET_M, static_cast<Real>(settings.trace.ray_offset_m));
    constants.add(CONSTANT_BEHIND, static_cast<int32_t>(settings.trace.behind));
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(view.projection == Projection::orthographic));
    add_reflecting(constants, settings.trace);
}

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
void require_exact_arithmetic(const Gpu& gpu, const PreparedFrame& frame, const std::string& chosen)
{
    if (const std::string missing = missing_feature(gpu, frame.technique, frame.values); !missing.empty())
        throw_failure("{}", missing);
    const Surface& surface = find_surface(frame.settings.trace.surface);
    if (!std::filesystem::exists(surface.shaders / "meeting_exact.glsl"))
        throw_spec_error("{} needs a surface model with meeting_exact.glsl, which {} does not have", chosen,
                         short_path(surface.folder));
}

} // namespace

Defines precision_defines(const Gpu& gpu, Precision precision)
{
    if (precision == Precision::float64) return {{"REAL_IS_DOUBLE", "1"}};
    if (gpu.info.cheap_doubles) return {{"DF64_IS_DOUBLE", "1"}};
    return {};
}

Defines ray_list_defines(const Gpu& gpu, const RayBuffers& rays)
{
    if (rays.rays_of_pixels == 0) return {};
    Defines defines = precision_defines(gpu, rays.precision);
    defines.emplace("RAYS_OF_PIXELS", std::to_string(rays.rays_of_pixels));
    defines.emplace("RAYS_FROM_LOBE", rays.from_lobe ? "1" : "0");
    return defines;
}

void add_surface(ShaderSource& source, const TraceSettings& settings)
{
    const Surface& surface = find_surface(settings.surface);
    for (const char* part : {"meeting.glsl", "meeting_exact.glsl", "held.glsl"})
        if (std::filesystem::exists(surface.shaders / part)) // only the exact one may be missing
            source.include_files.emplace(fmt::format("surface/{}", part), surface.shaders / part);
    source.include_folders.push_back(surface.shaders);
    if (surface.needs_gradient) source.defines.emplace("PIXEL_PLANES", "1");
    if (surface.needs_solid) source.defines.emplace("SURFACE_SOLID", "1");
    for (const std::string& macro : surface.defines) source.defines.emplace(macro, "1");
    source.defines.emplace("LAYERS", std::to_string(settings.layers));
}

std::string missing_feature(const Gpu& gpu, const Technique& technique, const ParameterValues& values)
{
    const std::string chosen = exact_choice(technique, values);
    if (chosen.empty() || (gpu.info.int64 && gpu.info.float64)) return "";
    return fmt::format("{} needs 64-bit integers and doubles in shaders; the device '{}' has no {}", chosen,
                       gpu.info.name, gpu.info.int64 ? "shaderFloat64" : "shaderInt64");
}

Defines store_defines(const Gpu& gpu, const Buffer& texels)
{
    const bool storable = gpu.info.int64 && texels.bytes <= gpu.impl->limits.maxStorageBufferRange;
    return storable ? Defines{{"STORES_64_BITS", "1"}} : Defines{};
}

Constants settings_constants(const PreparedFrame& frame, Precision precision, bool exact)
{
    Constants   constants;
    const View& view = frame.buffers->gbuffer->view;
    if (precision == Precision::float64)
        add_settings<double>(constants, view, frame.settings);
    else
        add_settings<float>(constants, view, frame.settings);
    if (precision == Precision::float64 || exact)
        add_slabs<double>(constants, view, frame.settings.trace);
    else
        add_slabs<float>(constants, view, frame.settings.trace);
    return constants;
}

namespace {

/// "depth_pyramid.kind" -> "depth_pyramid_kind"
std::string glsl_name(const Parameter& parameter)
{
    std::string name = parameter.name;
    std::ranges::replace(name, '.', '_');
    return name;
}

} // namespace

std::string parameter_declarations(std::span<const Parameter> parameters, uint32_t id)
{
    std::string text;
    for (const Parameter& parameter : parameters) {
        const char* declaration = parameter.type == ParameterType::real      ? "float {} = 0.0"
                                  : parameter.type == ParameterType::boolean ? "bool {} = false"
                                                                             : "int {} = 0";
        text += fmt::format("layout(constant_id = {}) const {};\n", id++,
                            fmt::format(fmt::runtime(declaration), glsl_name(parameter)));
        for (size_t i = 0; i < parameter.choices.size(); ++i)
            text += fmt::format("const int {}_{} = {};\n", glsl_name(parameter), parameter.choices[i], i);
    }
    return text;
}

void add_parameters(Constants& constants, std::span<const Parameter> parameters, const ParameterValues& values,
                    uint32_t id)
{
    for (const Parameter& parameter : parameters) {
        const double value = values.at(parameter.name);
        if (parameter.type == ParameterType::real)
            constants.add(id++, static_cast<float>(value));
        else
            constants.add(id++, static_cast<int32_t>(value));
    }
}

TileBuffers make_tile_buffers(Gpu& gpu, glm::ivec2 size_px)
{
    const glm::uvec3 tiles     = groups_of_8(size_px);
    const auto       two_words = [&] {
        return make_texel_buffer(gpu, static_cast<uint64_t>(tiles.x) * tiles.y * sizeof(glm::uvec2),
                                       vk::Format::eR32Uint);
    };
    return {two_words(), make_buffer(gpu, 16), two_words(), make_buffer(gpu, 16),
            make_buffer(gpu, sizeof(GBufferCounts))};
}

Bindings surface_bindings(const GBuffer& gbuffer)
{
    Bindings bindings{{"depth_words", {gbuffer.depth.cells, gbuffer.depth.words}},
                      {"depth_cells", gbuffer.depth.cells},
                      {"cell_pairs", {gbuffer.depth.cells, gbuffer.depth.pairs}},
                      {"StoredCells", {gbuffer.depth.cells, gbuffer.depth.pairs}},
                      {"StoredCell", gbuffer.depth.cells},
                      {"normal_image", gbuffer.normal},
                      {"material_image", gbuffer.material},
                      {"dielectric_image", gbuffer.dielectric},
                      {"solid_image", gbuffer.solid}};
    add_layers(bindings, gbuffer.layers);
    return bindings;
}

Bindings bindings_of(const FrameBuffers& buffers, const RayBuffers& rays)
{
    Bindings bindings = surface_bindings(*buffers.gbuffer);
    bindings.insert({{"RayCount", rays.count},
                     {"Rays", rays.list},
                     {"Hits", rays.hits},
                     {"TileMasks", buffers.tiles.masks},
                     {"TileCount", buffers.tiles.count},
                     {"Tiles", buffers.tiles.tiles},
                     {"PictureStatistics", buffers.tiles.statistics}});
    return bindings;
}

ComputePass make_launch_pass(Gpu& gpu, const Buffer& items, const Buffer& launch, int items_per_group)
{
    Constants constants;
    constants.add(CONSTANT_ITEMS_PER_GROUP, items_per_group);
    return make_compute_pass(gpu, compile_shader(gpu, {.file = "trace/dispatch_args.comp"}),
                             {{"ItemCount", items}, {"Launch", launch}}, constants);
}

namespace {

Shader compile_trace(const Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Bindings& bindings)
{
    const Technique& technique = frame.technique;
    const bool       in_double = rays.precision == Precision::float64;
    ShaderSource     source{
            .file          = technique.rays_per_invocation == 2 ? "trace/trace_pairs.comp" : "trace/trace.comp",
            .defines       = precision_defines(gpu, rays.precision),
            .include_files = structure_include_files(technique),
            .include_texts = {{"technique/parameters", parameter_declarations(technique.parameters, CONSTANT_PARAMETERS)},
                              {"technique/structures", structure_declarations(technique, nullptr, in_double)}},
            .include_folders = technique_folders(technique)};
    source.include_files.emplace("technique/trace.glsl", technique.folder / "trace.glsl");
    add_surface(source, frame.settings.trace);
    source.defines.emplace("STRUCTURES", std::to_string(technique.structures.size()));
    for (const std::string& macro : shader_macros(technique, frame.values)) source.defines.emplace(macro, "1");
    source.defines.merge(store_defines(gpu, rays.hits));
    source.defines.merge(ray_list_defines(gpu, rays));
    if (technique.rays_per_invocation == 2) source.defines.emplace("PAIR_GROUPS", gpu.info.lanes > 1 ? "2" : "1");
    if (bindings.contains("Work")) source.defines.emplace("COUNT_WORK", "1");
    if (bindings.contains("Visits")) source.defines.emplace("RECORD_VISITS", "1");
    return compile_shader(gpu, source);
}

/// One workgroup lists the tiles: as wide as every device allows, and as wide as this one allows where passes are parallel.
Shader compile_tile_list(const Gpu& gpu)
{
    const uint32_t most        = std::min(gpu.impl->limits.maxComputeWorkGroupInvocations, 1024U);
    const uint32_t invocations = gpu.info.lanes > 1 ? std::bit_floor(most) : 128;
    return compile_shader(
        gpu, {.file = "rays/tile_list.comp", .defines = {{"TILE_LIST_INVOCATIONS", std::to_string(invocations)}}});
}

} // namespace

TechniquePasses make_technique_passes(Gpu& gpu, const PreparedFrame& frame, const GBuffer& layer,
                                      const RayBuffers& rays, const Bindings& bindings)
{
    const std::string exact = exact_choice(frame.technique, frame.values);
    if (!exact.empty()) require_exact_arithmetic(gpu, frame, exact);
    Constants constants = settings_constants(frame, rays.precision, !exact.empty());
    add_parameters(constants, frame.technique.parameters, frame.values, CONSTANT_PARAMETERS);

    TechniquePasses passes;
    passes.structures   = make_ray_structures(gpu, frame, layer, rays, bindings);
    const auto is_built = [](const StructurePasses& structure) { return !structure.dispatches.empty(); };
    if (std::ranges::any_of(passes.structures, is_built))
        passes.group_launch = make_launch_pass(gpu, rays.count, rays.group_launch,
                                               RAYS_PER_GROUP * RAY_GROUP_INVOCATIONS / gpu.info.lanes);
    Bindings all = bindings;
    all.merge(structure_bindings(gpu, frame.technique, layer, rays));
    passes.trace = make_compute_pass(gpu, compile_trace(gpu, frame, rays, bindings), all, constants);
    return passes;
}

void record_depth_structures(const vk::raii::CommandBuffer& commands, const std::vector<StructurePasses>& structures)
{
    for (const StructurePasses& structure : structures) record_structure(commands, structure, nullptr);
}

void record_technique(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes, const RayBuffers& rays)
{
    for (const StructurePasses& structure : passes.structures) record_ray_structure(commands, passes, structure, rays);
    dispatch_indirect(commands, passes.trace, rays.launch);
}

void record_ray_structure(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes,
                          const StructurePasses& structure, const RayBuffers& rays)
{
    if (structure.dispatches.empty()) return;
    dispatch(commands, passes.group_launch, {1, 1, 1});
    barrier(commands);
    record_structure(commands, structure, &rays.group_launch);
}

TracePasses make_trace_passes(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Buffer& view,
                              const Buffer* work, const Buffer* visits)
{
    const FrameBuffers& buffers  = *frame.buffers;
    Bindings            bindings = bindings_of(buffers, rays);
    bindings.insert({"View", view});
    if (work != nullptr) bindings.insert({"Work", *work});
    if (visits != nullptr) bindings.insert({"Visits", *visits});
    Constants constants = settings_constants(frame, rays.precision);
    // What is counted is the technique's work on one ray from the centre of each pixel that reflects, whatever the passes.
    const bool counts    = work != nullptr;
    const auto of_passes = [&](const char* name) { return static_cast<int32_t>(frame.settings.passes.at(name)); };
    constants.add(CONSTANT_EVERY_SURFACE, !counts && of_passes("skip_unneeded_passes") == 0 ? 1 : 0);
    constants.add(CONSTANT_RAYS_PER_PIXEL, counts ? 1 : of_passes("rays_per_pixel"));
    constants.add(CONSTANT_LOBE_RAYS, !counts && draws_lobe_rays(frame.settings.passes) ? 1 : 0);
    constants.add(CONSTANT_TRACE_BLOCK_PX, counts ? 1 : trace_block_px(frame.settings.passes));
    TracePasses passes;
    passes.classification = make_classification(gpu, bindings, constants);
    passes.tile_list      = make_compute_pass(gpu, compile_tile_list(gpu), bindings, constants, sizeof(glm::ivec2));
    passes.tile_launch    = make_launch_pass(gpu, buffers.tiles.count, buffers.tiles.launch, 1);
    Defines ray_defines   = precision_defines(gpu, rays.precision);
    ray_defines.merge(store_defines(gpu, rays.list));
    ray_defines.merge(ray_list_defines(gpu, rays));
    passes.rays       = make_compute_pass(gpu, compile_shader(gpu, {.file = "rays/rays.comp", .defines = ray_defines}),
                                          bindings, constants);
    passes.ray_launch = make_launch_pass(gpu, rays.count, rays.launch, RAYS_PER_GROUP);
    passes.technique  = make_technique_passes(gpu, frame, *buffers.gbuffer, rays, bindings);
    return passes;
}

Classification make_classification(Gpu& gpu, const Bindings& bindings, const Constants& constants)
{
    const bool  by_pixel = gpu.info.lanes > 1;
    const char* file     = by_pixel ? "rays/classification_by_pixel.comp" : "rays/classification.comp";
    return {.pass            = make_compute_pass(gpu, compile_shader(gpu, {.file = file}), bindings, constants),
            .tiles_per_group = by_pixel ? uint32_t{CLASSIFIED_TILES_BY_PIXEL} : uint32_t{CLASSIFIED_TILES}};
}

void record_marking(const vk::raii::CommandBuffer& commands, const Classification& classification,
                    const FrameBuffers& buffers)
{
    barrier(commands);
    commands.fillBuffer(*buffers.tiles.statistics.buffer, 0, VK_WHOLE_SIZE, 0);
    barrier(commands);
    const glm::uvec3 tiles = groups_of_8(buffers.gbuffer->view.size_px);
    const uint32_t   each  = classification.tiles_per_group;
    dispatch(commands, classification.pass, {(tiles.x + each - 1) / each, tiles.y, 1});
    barrier(commands);
}

void record_classification(const vk::raii::CommandBuffer& commands, const TracePasses& passes,
                           const FrameBuffers& buffers)
{
    record_marking(commands, passes.classification, buffers);
    push(commands, passes.tile_list, glm::ivec2(groups_of_8(buffers.gbuffer->view.size_px)));
    dispatch(commands, passes.tile_list, {1, 1, 1});
    barrier(commands);
    dispatch(commands, passes.tile_launch, {1, 1, 1});
    dispatch(commands, passes.ray_launch, {1, 1, 1});
    barrier(commands);
}

void record_ray_setup(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const FrameBuffers& buffers)
{
    dispatch_indirect(commands, passes.rays, buffers.tiles.launch);
    barrier(commands);
}

void record_rays(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const FrameBuffers& buffers)
{
    record_classification(commands, passes, buffers);
    record_ray_setup(commands, passes, buffers);
}

uint32_t pack_pixel(glm::ivec2 pixel, int number)
{
    return static_cast<uint32_t>(pixel.x) | static_cast<uint32_t>(pixel.y) << PIXEL_BITS |
           static_cast<uint32_t>(number) << (2 * PIXEL_BITS);
}

glm::ivec2 unpack_pixel(uint32_t packed)
{
    return {packed & (MAX_IMAGE_PX - 1), (packed >> PIXEL_BITS) & (MAX_IMAGE_PX - 1)};
}

TraceStatus unpack_status(uint32_t packed)
{
    return static_cast<TraceStatus>(number_to_status(static_cast<int>(packed >> (2 * PIXEL_BITS))));
}

uint8_t unpack_layer(uint32_t packed)
{
    return static_cast<uint8_t>(number_to_layer(static_cast<int>(packed >> (2 * PIXEL_BITS))));
}

size_t work_words(const Technique& technique) { return 2 + std::max<size_t>(technique.structures.size(), 1); }

template <typename Real>
TraceResult read_result(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Buffer* work)
{
    const glm::ivec2 size_px    = frame.buffers->gbuffer->view.size_px;
    const auto&      structures = frame.technique.structures;
    const auto       listed     = read_list<Real>(gpu, rays);
    const size_t     count = listed.size(), words = work_words(frame.technique);
    const auto       hits = download_as<PackedHit<Real>>(gpu, rays.hits, count);
    const auto  works = work != nullptr ? download_as<uint32_t>(gpu, *work, count * words) : std::vector<uint32_t>{};
    const auto  group_fetches = work != nullptr ? read_group_fetches(gpu, frame.technique, rays)
                                                : std::vector<std::vector<uint32_t>>(structures.size());
    TraceResult result        = make_trace_result(size_px, work != nullptr);
    for (const Structure& structure : structures)
        if (work != nullptr)
            result.structure_fetches.push_back({structure.id, std::vector<uint32_t>(pixel_count(size_px))});
    for (size_t i = 0; i < count; ++i) {
        const glm::ivec2 pixel = unpack_pixel(listed[i].pixel);
        const size_t     index = pixel_index(pixel, size_px);
        result.traced_order.push_back(index);
        result.status[index]       = unpack_status(hits[i].pixel);
        result.hit_pixel[index]    = unpack_pixel(hits[i].pixel);
        result.hit_layer[index]    = unpack_layer(hits[i].pixel);
        result.hit_t[index]        = static_cast<double>(hits[i].t);
        result.hit_px_depth[index] = glm::dvec3(listed[i].origin) + result.hit_t[index] * glm::dvec3(listed[i].delta);
        if (work == nullptr) continue;
        if (result.status[index] == TraceStatus::impossible) {
            result.steps[index]     = works[i * words];
            result.hit_pixel[index] = {static_cast<int>(works[i * words + 1]), static_cast<int>(works[i * words + 2])};
            continue;
        }
        result.steps[index]         = works[i * words];
        result.depth_fetches[index] = works[i * words + 1];
        for (size_t s = 0; s < structures.size(); ++s) {
            uint32_t& fetches = result.structure_fetches[s].fetches[index];
            fetches           = works[i * words + 2 + s];
            // Those for a whole group of rays count once, with its first ray.
            if (i % RAYS_PER_GROUP == 0 && !group_fetches[s].empty()) fetches += group_fetches[s][i / RAYS_PER_GROUP];
        }
    }
    return result;
}
template TraceResult read_result<float>(Gpu&, const PreparedFrame&, const RayBuffers&, const Buffer*);
template TraceResult read_result<double>(Gpu&, const PreparedFrame&, const RayBuffers&, const Buffer*);

float half_to_float(uint16_t half) { return glm::unpackHalf1x16(half); }

} // namespace ssrlab
