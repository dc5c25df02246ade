// The lab's passes: from a G-buffer to the list of rays, and from the list to hits. For the folders trace/ and frame/.
#pragma once

#include "trace/gbuffer.h"
#include "trace/structure_passes.h"

namespace ssrlab {

using Defines = std::map<std::string, std::string>;

struct Lab {
    GBufferPtr                   gbuffer;
    Technique                    technique;
    ParameterValues              values;
    TraceSettings                settings;
    Surface                      surface;
    std::vector<StructurePasses> structures; // that depend on depth alone
};

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
RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, Precision precision, int rays_of_pixels = 0);

/// Which pixels of a G-buffer have rays, and how many each. The default is the mirror ray of each pixel that reflects.
struct RayChoice {
    bool every_surface = false; // also where nothing reflects
    int  per_pixel     = 1;
    bool from_lobe     = false; // drawn from the lobe of rough surfaces
    int  block_px      = 1;     // side of the blocks in which one pixel has rays
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

/// What the counting pipelines write; null: nothing, as in the pipelines that are timed.
struct Counters {
    const Buffer* work   = nullptr; // steps, depth fetches and structure fetches of each ray
    const Buffer* visits = nullptr; // what the only ray of the list looks at (shaders/trace/visits.glsl)
};

/// view: of the lab's G-buffer, in the precision of the rays.
TracePasses make_trace_passes(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Buffer& view,
                              const RayChoice& choice = {}, const Counters& counters = {});
/// The technique on a list. bindings: the list, the G-buffer and the view; with "Work" and "Visits" it counts.
TechniquePasses make_technique_passes(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Bindings& bindings);
/// The structures that depend on depth alone.
void record_depth_structures(const vk::raii::CommandBuffer& commands, const Lab& lab);
/// One that depends on the list of rays, if it does.
void record_ray_structure(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes,
                          const StructurePasses& structure, const RayBuffers& rays);
/// All of those, then the trace.
void record_technique(const vk::raii::CommandBuffer& commands, const TechniquePasses& passes, const RayBuffers& rays);

/// Classification and ray set-up.
void record_rays(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const GBuffer& gbuffer);
void record_classification(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const GBuffer& gbuffer);
void record_ray_setup(const vk::raii::CommandBuffer& commands, const TracePasses& passes, const GBuffer& gbuffer);

/// Counted once for each rule of what reflects: the number of reflecting pixels decides how large a list of rays is.
const GBufferCounts& count_gbuffer(Gpu& gpu, GBuffer& gbuffer, const TraceSettings& settings);
/// Traces once and counts how the rays ended.
TraceCounts count_hits(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const RayChoice& choice);

ComputePass make_launch_pass(Gpu& gpu, const Buffer& items, const Buffer& launch, int items_per_group);

// What shaders are composed with.
/// G-buffer, tiles, list and hits by the names that shaders give them; without the view.
Bindings ray_bindings(const GBuffer& gbuffer, const RayBuffers& rays);
/// For a shader that reads this list or makes it.
Defines ray_list_defines(const Gpu& gpu, const RayBuffers& rays);
/// The number types that shaders/api/real.glsl and rays/double_float.glsl stand for.
Defines precision_defines(const Gpu& gpu, Precision precision);
/// The surface model and the layers that a shader is composed with (shaders/surfaces/).
void add_surface(ShaderSource& source, const Surface& surface, int layers);
/// For a shader that stores texels of this buffer (shaders/layout/store_texel.glsl): 64 bits at once where the device can.
Defines store_defines(const Gpu& gpu, const Buffer& texels);
/// What shaders/rays/reflecting.glsl asks.
void add_reflecting(Constants& constants, const TraceSettings& settings);
/// exact: for a shader that is compiled with EXACT_ARITHMETIC, whose slab is in double precision.
Constants settings_constants(const View& view, const TraceSettings& settings, Precision precision, bool exact = false);
/// One constant per parameter from `id` on, under its own name, and names for the choices: PARAMETER_CHOICE.
std::string parameter_declarations(std::span<const Parameter> parameters, uint32_t id);
void        add_parameters(Constants& constants, std::span<const Parameter> parameters, const ParameterValues& values,
                           uint32_t id);

// What shaders wrote.
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
template <typename Real> TraceResult read_result(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Buffer* work);

float half_to_float(uint16_t half);

} // namespace ssrlab
