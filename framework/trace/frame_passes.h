// The passes of a frame, as frame.cpp strings them together. Folder-internal.
#pragma once

#include "frame/frame_history.h"
#include "frame/gbuffer.h"
#include "trace/structure_passes.h"

#include <map>

namespace ssrlab {

using Defines = std::map<std::string, std::string>;

/// shaders/layout/packed_ray.glsl
template <typename Real> struct PackedRay {
    glm::vec<3, Real> origin{0};
    Real              length_m = 0;
    glm::vec<3, Real> delta{0};
    uint32_t          pixel = 0; // with the status of a miss
};
static_assert(sizeof(PackedRay<float>) == 2 * 16 && sizeof(PackedRay<double>) == 4 * 16); // texels

/// What a ray of the list found (shaders/layout/packed_hit.glsl).
template <typename Real> struct PackedHit {
    uint32_t pixel = 0; // with the status
    Real     t     = 0;
};
static_assert(sizeof(PackedHit<float>) == 8 && sizeof(PackedHit<double>) == 16); // texels

/// The list of rays and what each found (shaders/rays/rays.comp, shaders/trace/trace.comp).
struct RayBuffers {
    Precision                         precision = Precision::float32;
    size_t                            capacity  = 0;
    Buffer                            count, launch, list, hits;
    Buffer                            group_launch;    // of passes with an invocation for each group of rays
    std::shared_ptr<StructureBuffers> structures = {}; // that depend on this list
    int  rays_of_pixels = 0;     // above 0: the list holds pixels, each so many times, and shaders make the rays anew
    bool from_lobe      = false; // likewise: drawn from the lobe of a rough surface
};
/// The uniform block of shaders/api/view.glsl.
Buffer     upload_view(Gpu& gpu, const View& view, Precision precision);
void       write_view(Gpu& gpu, Buffer& target, const View& view, Precision precision);
RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, Precision precision, int rays_of_pixels = 0);

/// For a shader that reads this list or makes it.
Defines ray_list_defines(const Gpu& gpu, const RayBuffers& rays);

/// Rays that come from other rays: a list of their own, and of each the ray or pixel that it belongs to.
struct DerivedRays {
    RayBuffers rays;
    Buffer     sources;
    Buffer     throughputs; // bounces: what a ray's light still weighs in the reflection it belongs to, RGB
};

/// What cones look up (shaders/passes/cone_pyramid.comp).
struct ConePyramid {
    GpuImage cells;  // RGBA16F: colour, visibility
    GpuImage ranges; // RG32F: nearest and farthest distance in metres
};

/// What each ray of a rough pixel brought back, ray after ray, each an image high (shaders/passes/ray_reuse.comp).
struct LobeRayImages {
    GpuImage light; // RGBA16F: colour, weight; with one ray per pixel the reflection takes its place
    GpuImage end;   // RGBA32F: the point in view space, and the density of the ray's direction
};

/// The tiles to trace (shaders/rays/classification.comp) and the counts for the plan.
struct TileBuffers {
    Buffer masks, count, tiles, launch, statistics;
};
TileBuffers make_tile_buffers(Gpu& gpu, glm::ivec2 size_px);

struct FrameBuffers {
    GBufferPtr                                           gbuffer;
    Buffer                                               view; // float
    TileBuffers                                          tiles;
    std::map<std::pair<double, double>, FrameStatistics> statistics; // by what reflects; nothing is traced yet
    std::map<std::tuple<size_t, int, bool>, std::shared_ptr<RayBuffers>> rays; // by capacity and what they hold; float
    GBufferPtr                                                     second_layer; // empty until a frame asks for it
    std::shared_ptr<ConePyramid>                                   cone;         // empty until a frame asks for it
    std::map<std::pair<size_t, int>, std::shared_ptr<DerivedRays>> derived_rays; // by capacity, and which of two
    std::map<int, std::shared_ptr<LobeRayImages>>                  lobe_rays;    // by rays per pixel
    GpuImage          reflection;   // RGBA16F: colour, weight; weight < 0 where no ray started
    GpuImage          filtered;     // RGBA16F: a reflection that a filter is writing, or an earlier one
    GpuImage          small_colour; // RGBA16F, half size or less: lit colour as rays at a lower resolution find it
    GpuImage          block_pixel;  // R32UI, half size or less: which pixel of a block has rays, or NO_PIXEL
    GpuImage          shaded;       // RGBA16F
    GpuImage          dfg_table;    // RG16F: dfg_table()
    Buffer            ambient;      // vec3: the scene's ambient radiance, or 0
    vk::raii::Sampler dfg_sampler = nullptr;
};

/// The technique on one list of rays.
struct TechniquePasses {
    std::vector<StructurePasses> structures; // that depend on the list
    ComputePass                  group_launch, trace;
};

/// Marks tiles: a workgroup so many side by side.
struct Classification {
    ComputePass pass;
    uint32_t    tiles_per_group = 1;
};

struct TracePasses {
    Classification  classification;
    ComputePass     tile_list, tile_launch, rays, ray_launch;
    TechniquePasses technique;
};

struct PreparedFrame {
    FrameBuffersPtr              buffers;
    Technique                    technique;
    ParameterValues              values;
    FrameSettings                settings;
    std::shared_ptr<RayBuffers>  rays;
    std::vector<StructurePasses> structures; // that depend on depth alone
    TracePasses                  trace;
    FrameFacts                   facts;
    FrameStatistics              statistics;
    double                       counting_s = 0; // that it took to count what the rays hit, for the plan
    std::vector<PlannedPass>     plan;
    std::vector<RecordFunction>  record_functions;     // of the passes that run
    bool                         hidden_layer = false; // hits may lie in the second layer
    bool                         cone         = false; // rough surfaces look up cones
    FrameHistoryPtr              history;              // of the frame before, or null
    MotionBuffers                motion;               // since that frame; empty without a history to use
    Timestamps                   timestamps;
};

/// work: steps, depth and pyramid fetches per ray, or null for the pipeline that is timed. visits: what the only ray of the list looks at
/// (shaders/trace/visits.glsl), or null.
TracePasses make_trace_passes(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Buffer& view,
                              const Buffer* work, const Buffer* visits = nullptr);
/// The technique on a list and the layer that is bound.
TechniquePasses make_technique_passes(Gpu& gpu, const PreparedFrame& frame, const GBuffer& layer,
                                      const RayBuffers& rays, const Bindings& bindings);
/// The structures that depend on depth alone.
void record_depth_structures(const vk::raii::CommandBuffer& commands, const std::vector<StructurePasses>& structures);
/// One that depends on the list of rays, if it does.
void record_ray_structure(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes,
                          const StructurePasses& structure, const RayBuffers& rays);
/// All of those, then the trace.
void record_technique(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes, const RayBuffers& rays);
ComputePass make_launch_pass(Gpu& gpu, const Buffer& items, const Buffer& launch, int items_per_group);
/// What a picture shows at each pixel, by the names that shaders give it.
Bindings surface_bindings(const GBuffer& gbuffer);
/// That and everything else that shaders may read and write; without the view.
Bindings bindings_of(const FrameBuffers& buffers, const RayBuffers& rays);
/// The number types that shaders/api/real.glsl and rays/double_float.glsl stand for.
Defines precision_defines(const Gpu& gpu, Precision precision);
/// The surface model and the layers that a shader is composed with (shaders/surfaces/).
void add_surface(ShaderSource& source, const TraceSettings& settings);
/// For a shader that stores texels of this buffer (shaders/layout/store_texel.glsl): 64 bits at once where the device can.
Defines store_defines(const Gpu& gpu, const Buffer& texels);
/// What shaders/rays/reflecting.glsl asks.
void add_reflecting(Constants& constants, const TraceSettings& settings);
/// exact: for a shader that is compiled with EXACT_ARITHMETIC, whose slab is in double precision.
Constants settings_constants(const PreparedFrame& frame, Precision precision, bool exact = false);
/// One constant per parameter from `id` on, under its own name, and names for the choices: PARAMETER_CHOICE.
std::string parameter_declarations(std::span<const Parameter> parameters, uint32_t id);
void        add_parameters(Constants& constants, std::span<const Parameter> parameters, const ParameterValues& values,
                           uint32_t id);

/// Classification and ray set-up.
void record_rays(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const FrameBuffers& buffers);
Classification make_classification(Gpu& gpu, const Bindings& bindings, const Constants& constants);
/// Marks and counts alone, without a list.
void record_marking(const vk::raii::CommandBuffer& commands, const Classification& classification,
                    const FrameBuffers& buffers);
void record_classification(const vk::raii::CommandBuffer& commands, const TracePasses& passes,
                           const FrameBuffers& buffers);
void record_ray_setup(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const FrameBuffers& buffers);

/// A pixel and a number in one word, as in shaders/api/view.glsl.
uint32_t   pack_pixel(glm::ivec2 pixel, int number);
glm::ivec2 unpack_pixel(uint32_t packed);
/// How a ray ended, in whichever layer.
TraceStatus unpack_status(uint32_t packed);
uint8_t     unpack_layer(uint32_t packed);
/// The list of rays as it is on the device.
template <typename Real> std::vector<PackedRay<Real>> read_list(Gpu& gpu, const RayBuffers& rays)
{
    return download_as<PackedRay<Real>>(gpu, rays.list, download_as<uint32_t>(gpu, rays.count, 1)[0]);
}

/// Words of the counting pipeline's buffer for each ray: steps, depth fetches, fetches of each structure; of what is no answer
/// the status and the pixel that the technique returned.
size_t work_words(const Technique& technique);
/// work: null for a result without counts.
template <typename Real>
TraceResult read_result(Gpu& gpu, const PreparedFrame& frame, const RayBuffers& rays, const Buffer* work);

float half_to_float(uint16_t half);

} // namespace ssrlab
