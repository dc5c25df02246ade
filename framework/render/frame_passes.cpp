#include "render/frame_passes.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "shared.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// shaders/api/slab.glsl says what the three numbers are.
struct Slab {
    double slope = 0, scale = 1, shift = 0;
};

Slab slab_of(const View& view, const TraceSettings& trace)
{
    const double thickness = trace.thickness_m;
    if (std::isinf(thickness)) return {0, 0, 0};
    if (view.projection == Projection::perspective)
        return trace.thickness_relative ? Slab{0, 1 / (1 + thickness), 0} : Slab{thickness / view.near_m, 1, 0};
    const double range = view.far_m - view.near_m;
    return trace.thickness_relative ? Slab{0, 1 + thickness, thickness * view.far_m / range}
                                    : Slab{0, 1, thickness / range};
}

template <typename Real> void add_slab(Constants& constants, const View& view, const FrameSettings& settings)
{
    const Slab slab = slab_of(view, settings.trace);
    constants.add(CONSTANT_SLAB_SLOPE, static_cast<Real>(slab.slope));
    constants.add(CONSTANT_SLAB_SCALE, static_cast<Real>(slab.scale));
    constants.add(CONSTANT_SLAB_SHIFT, static_cast<Real>(slab.shift));
}

template <typename Real> void add_settings(Constants& constants, const View& view, const FrameSettings& settings)
{
    constants.add(CONSTANT_MAX_DISTANCE_M, static_cast<Real>(settings.trace.max_distance_m));
    constants.add(CONSTANT_RAY_OFFSET_M, static_cast<Real>(settings.trace.ray_offset_m));
    constants.add(CONSTANT_FACING, static_cast<int32_t>(settings.trace.facing));
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(view.projection == Projection::orthographic));
}

/// The parameter `arithmetic` chooses what shaders/api/trace_api.glsl crosses borders in. A define, not a constant: 64-bit integers must not even be
/// declared on a device without them.
bool exact_arithmetic(const Gpu& gpu, const PreparedFrame& frame)
{
    const auto parameter = std::ranges::find(frame.technique.parameters, "arithmetic", &Parameter::name);
    if (parameter == frame.technique.parameters.end() || parameter->type != ParameterType::choice ||
        format_parameter(*parameter, frame.values.at("arithmetic")) != "exact")
        return false;
    if (!gpu.info.int64 || !gpu.info.float64)
        throw_failure("arithmetic = exact needs 64-bit integers and doubles in shaders; the device '{}' has no {}",
                      gpu.info.name, gpu.info.int64 ? "shaderFloat64" : "shaderInt64");
    return true;
}

/// An input reads the technique's parameters of these names, if it has them.
double parameter_or(const PreparedFrame& frame, const std::string& name, double otherwise)
{
    const auto value = frame.values.find(name);
    return value != frame.values.end() ? value->second : otherwise;
}

bool has_input(const PreparedFrame& frame, const char* name)
{
    return std::ranges::count(frame.technique.inputs, name) > 0;
}

/// Walks by exact crossings pass over nothing.
bool reads_beams(const Gpu& gpu, const PreparedFrame& frame)
{
    return (has_input(frame, "ray_beams") || has_input(frame, "front_beams")) && !exact_arithmetic(gpu, frame) &&
           parameter_or(frame, "beams", 1) != 0;
}

} // namespace

Defines precision_defines(const Gpu& gpu, Precision precision)
{
    if (precision == Precision::float64) return {{"REAL_IS_DOUBLE", "1"}};
    if (gpu.info.cheap_doubles) return {{"WIDE_IS_DOUBLE", "1"}};
    return {};
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
        add_slab<double>(constants, view, frame.settings);
    else
        add_slab<float>(constants, view, frame.settings);
    return constants;
}

std::string parameter_declarations(std::span<const Parameter> parameters, uint32_t id)
{
    std::string text;
    for (const Parameter& parameter : parameters) {
        const char* declaration = parameter.type == ParameterType::real      ? "float {} = 0.0"
                                  : parameter.type == ParameterType::boolean ? "bool {} = false"
                                                                             : "int {} = 0";
        text += fmt::format("layout(constant_id = {}) const {};\n", id++,
                            fmt::format(fmt::runtime(declaration), parameter.name));
        for (size_t i = 0; i < parameter.choices.size(); ++i)
            text += fmt::format("const int {}_{} = {};\n", parameter.name, parameter.choices[i], i);
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

std::vector<PyramidPush> pyramid_pushes(glm::ivec2 size_px, int top)
{
    std::vector<PyramidPush> levels;
    for (int level = 1; level <= std::min(pyramid_levels(size_px), top); ++level)
        levels.push_back({level_size(size_px, level - 1), level_size(size_px, level), pyramid_root(size_px) >> level,
                          pyramid_size(size_px).y});
    return levels;
}

PyramidPasses make_pyramid_passes(Gpu& gpu, const PreparedFrame& frame, const DepthPyramid& pyramid)
{
    if (!has_input(frame, "depth_pyramid")) return {};
    const Shader shader = compile_shader({.file = "depth_pyramid.comp", .defines = store_defines(gpu, pyramid.cells)});
    const auto   make   = [&](bool from_pixels) {
        Constants constants = settings_constants(frame, Precision::float32);
        constants.add(CONSTANT_PYRAMID_KIND, static_cast<int32_t>(parameter_or(frame, "pyramid", PYRAMID_OCCUPANCY)));
        constants.add(CONSTANT_FROM_PIXELS, static_cast<int32_t>(from_pixels));
        return make_compute_pass(gpu, shader,
                                     {{"cell_pairs", pyramid.pairs}, {"StoredCells", {pyramid.cells, pyramid.pairs}}},
                                     constants, sizeof(PyramidPush));
    };
    PyramidPasses passes;
    passes.cells_per_invocation = 2;
    passes.from_pixels          = make(true);
    passes.from_cells           = make(false);
    passes.levels = pyramid_pushes(pyramid.size_px, static_cast<int>(parameter_or(frame, "top_level", 31)));
    if (reads_beams(gpu, frame)) {
        Constants constants = settings_constants(frame, Precision::float32);
        constants.add(CONSTANT_BEAMS_IN_FRONT, static_cast<int32_t>(has_input(frame, "front_beams")));
        passes.patches      = level_size(pyramid.size_px, PATCH_BITS);
        passes.patch_planes = make_compute_pass(gpu, compile_shader({.file = "patch_planes.comp"}),
                                                {{"View", frame.buffers->view},
                                                 {"cell_pairs", pyramid.pairs},
                                                 {"depth_words", pyramid.words},
                                                 {"PatchPlanes", pyramid.patch_planes}},
                                                constants);
    }
    return passes;
}

TileBuffers make_tile_buffers(Gpu& gpu, glm::ivec2 size_px)
{
    const glm::uvec3 tiles     = groups_of_8(size_px);
    const auto       two_words = [&] {
        return make_texel_buffer(gpu, static_cast<uint64_t>(tiles.x) * tiles.y * sizeof(glm::uvec2),
                                       vk::Format::eR32Uint);
    };
    return {two_words(), make_buffer(gpu, 16), two_words(), make_buffer(gpu, 16),
            make_buffer(gpu, sizeof(PictureCounts))};
}

Bindings surface_bindings(const GBuffer& gbuffer)
{
    return {{"depth_words", gbuffer.depth.words}, {"depth_pyramid", gbuffer.depth.cells},
            {"cell_pairs", gbuffer.depth.pairs},  {"PatchPlanes", gbuffer.depth.patch_planes},
            {"normal_image", gbuffer.normal},     {"material_image", gbuffer.material}};
}

Bindings bindings_of(const FrameBuffers& buffers, const RayBuffers& rays)
{
    Bindings bindings = surface_bindings(*buffers.gbuffer);
    bindings.insert({{"RayCount", rays.count},
                     {"Rays", rays.list},
                     {"Hits", rays.hits},
                     {"Beams", rays.beams},
                     {"BeamWork", rays.beam_work},
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
    return make_compute_pass(gpu, compile_shader({.file = "trace/dispatch_args.comp"}), {{"ItemCount", items}, {"Launch", launch}},
                             constants);
}

TechniquePasses make_technique_passes(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays,
                                      const Bindings& bindings)
{
    const Precision precision = rays.precision;
    ShaderSource                trace{.file          = "trace/trace.comp",
                                      .defines       = precision_defines(gpu, precision),
                                      .include_files = {{"technique/trace.glsl", frame.technique.folder / "trace.glsl"}},
                                      .include_texts = {{"technique/parameters",
                                                         parameter_declarations(frame.technique.parameters, CONSTANT_PARAMETERS)}},
                                      .include_folders = {frame.technique.folder}};
    const bool                  exact = exact_arithmetic(gpu, frame);
    trace.defines.merge(store_defines(gpu, rays.hits));
    if (exact) trace.defines.emplace("EXACT_ARITHMETIC", "1");
    if (bindings.contains("Work")) trace.defines.emplace("COUNT_WORK", "1");
    Constants constants = settings_constants(frame, precision, exact);
    add_parameters(constants, frame.technique.parameters, frame.values, CONSTANT_PARAMETERS);

    TechniquePasses passes;
    passes.reads_beams = reads_beams(gpu, frame);
    if (passes.reads_beams) {
        trace.defines.emplace("RAY_BEAMS", "1");
        ShaderSource beams{.file = "ray_beams.comp", .defines = precision_defines(gpu, precision)};
        if (bindings.contains("Work")) beams.defines.emplace("COUNT_WORK", "1");
        Constants beam_constants = settings_constants(frame, precision);
        beam_constants.add(CONSTANT_TOP_LEVEL, static_cast<int32_t>(parameter_or(frame, "top_level", 31)));
        beam_constants.add(CONSTANT_BEAMS_IN_FRONT, static_cast<int32_t>(has_input(frame, "front_beams")));
        passes.beam_launch = make_launch_pass(gpu, rays.count, rays.beam_launch, RAYS_PER_GROUP * BEAMS_PER_GROUP);
        passes.beams       = make_compute_pass(gpu, compile_shader(beams), bindings, beam_constants);
    }
    passes.trace = make_compute_pass(gpu, compile_shader(trace), bindings, constants);
    return passes;
}

void record_technique(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes, const RayBuffers& rays)
{
    if (passes.reads_beams) {
        dispatch(commands, passes.beam_launch, {1, 1, 1});
        barrier(commands);
        dispatch_indirect(commands, passes.beams, rays.beam_launch);
        barrier(commands);
    }
    dispatch_indirect(commands, passes.trace, rays.launch);
}

TracePasses make_trace_passes(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Buffer& view,
                              const Buffer* work)
{
    const FrameBuffers& buffers  = *frame.buffers;
    Bindings            bindings = bindings_of(buffers, rays);
    bindings.insert({"View", view});
    if (work != nullptr) bindings.insert({"Work", *work});
    Constants constants = settings_constants(frame, rays.precision);
    // What is counted is the technique's work on one ray from the centre of each pixel that reflects, whatever the effects.
    const bool counts     = work != nullptr;
    const auto of_effects = [&](const char* name) { return static_cast<int32_t>(frame.settings.effects.at(name)); };
    constants.add(CONSTANT_EVERY_SURFACE, !counts && of_effects("plan") == 0 ? 1 : 0);
    constants.add(CONSTANT_RAYS_PER_PIXEL, counts ? 1 : of_effects("rays_per_pixel"));
    constants.add(CONSTANT_TRACE_BLOCK_PX, counts ? 1 : trace_block_px(frame.settings.effects));
    TracePasses passes;
    passes.classification =
        make_compute_pass(gpu, compile_shader({.file = "rays/classification.comp"}), bindings, constants);
    passes.tile_list =
        make_compute_pass(gpu, compile_shader({.file = "rays/tile_list.comp"}), bindings, constants, sizeof(glm::ivec2));
    passes.tile_launch  = make_launch_pass(gpu, buffers.tiles.count, buffers.tiles.launch, 1);
    Defines ray_defines = precision_defines(gpu, rays.precision);
    ray_defines.merge(store_defines(gpu, rays.list));
    passes.rays =
        make_compute_pass(gpu, compile_shader({.file = "rays/rays.comp", .defines = ray_defines}), bindings, constants);
    passes.ray_launch = make_launch_pass(gpu, rays.count, rays.launch, RAYS_PER_GROUP);
    passes.technique  = make_technique_passes(gpu, frame, rays, bindings);
    return passes;
}

void record_marking(const vk::raii::CommandBuffer& commands, const ComputePass& classification,
                    const FrameBuffers& buffers)
{
    barrier(commands);
    commands.fillBuffer(*buffers.tiles.statistics.buffer, 0, VK_WHOLE_SIZE, 0);
    barrier(commands);
    const glm::uvec3 tiles = groups_of_8(buffers.gbuffer->view.size_px);
    dispatch(commands, classification, {(tiles.x + CLASSIFIED_TILES - 1) / CLASSIFIED_TILES, tiles.y, 1});
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

void record_pyramid(const vk::raii::CommandBuffer& commands, const PyramidPasses& passes)
{
    if (passes.patches != glm::ivec2(0)) {
        dispatch(commands, passes.patch_planes, groups_of_8(passes.patches));
        barrier(commands);
    }
    for (const PyramidPush& level : passes.levels) {
        const ComputePass& pass = &level == &passes.levels.front() ? passes.from_pixels : passes.from_cells;
        push(commands, pass, level);
        const int per_invocation = passes.cells_per_invocation;
        dispatch(commands, pass, groups_of_8({(level.size.x + per_invocation - 1) / per_invocation, level.size.y}));
        barrier(commands);
    }
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
    return static_cast<TraceStatus>((packed >> (2 * PIXEL_BITS)) & (TRACE_SECOND_LAYER - 1));
}

bool in_second_layer(uint32_t packed) { return ((packed >> (2 * PIXEL_BITS)) & TRACE_SECOND_LAYER) != 0; }

template <typename Real>
TraceResult read_result(Gpu& gpu, glm::ivec2 size_px, const RayBuffers& rays, const Buffer* work)
{
    const auto   listed = read_list<Real>(gpu, rays);
    const size_t count  = listed.size();
    const auto   hits   = download_as<ListedHit<Real>>(gpu, rays.hits, count);
    const auto   works  = work != nullptr ? download_as<glm::uvec3>(gpu, *work, count) : std::vector<glm::uvec3>{};
    TraceResult  result = make_trace_result(size_px, work != nullptr);
    for (size_t i = 0; i < count; ++i) {
        const glm::ivec2 pixel     = unpack_pixel(listed[i].pixel);
        const size_t     index     = pixel_index(pixel, size_px);
        result.status[index]       = unpack_status(hits[i].pixel);
        result.hit_pixel[index]    = unpack_pixel(hits[i].pixel);
        result.hit_t[index]        = static_cast<double>(hits[i].t);
        result.hit_px_depth[index] = glm::dvec3(listed[i].origin) + result.hit_t[index] * glm::dvec3(listed[i].delta);
        if (work == nullptr) continue;
        result.steps[index]           = works[i].x;
        result.depth_fetches[index]   = works[i].y;
        result.pyramid_fetches[index] = works[i].z;
    }
    return result;
}
template TraceResult read_result<float>(Gpu&, glm::ivec2, const RayBuffers&, const Buffer*);
template TraceResult read_result<double>(Gpu&, glm::ivec2, const RayBuffers&, const Buffer*);

float half_to_float(uint16_t half) { return glm::unpackHalf1x16(half); }

} // namespace ssrlab
