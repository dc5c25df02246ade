// The lab's passes: G-buffer to list of rays, and list to hits. For the folders trace/ and frame/.
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
    std::vector<StructurePasses> structures; // those that depend on depth alone
};

/// A ray of the list (shaders/layout/packed_ray.glsl).
template <typename Real> struct PackedRay {
    glm::vec<3, Real> origin{0};
    Real              length_m = 0;
    glm::vec<3, Real> delta{0};
    uint32_t          pixel = 0; // packed with the status of a miss
};
static_assert(sizeof(PackedRay<float>) == 2 * 16 && sizeof(PackedRay<double>) == 4 * 16); // texels

/// The result of a ray of the list (shaders/layout/packed_hit.glsl).
template <typename Real> struct PackedHit {
    uint32_t pixel = 0; // packed with the status
    Real     t     = 0;
};
static_assert(sizeof(PackedHit<float>) == 8 && sizeof(PackedHit<double>) == 16); // texels

/// The list of rays and their results (shaders/rays/rays.comp, shaders/trace/trace.comp).
struct RayBuffers {
    NumberFormat                      number_format = NumberFormat::float32;
    size_t                            capacity      = 0;
    Buffer                            count, list, hits;
    Buffer                            launch, group_launch; // dispatch arguments: of the trace, of passes per ray group
    std::shared_ptr<StructureBuffers> structures = {};      // those that depend on this list
    int  rays_of_pixels = 0;     // above 0: the list holds pixels, each this many times, and shaders make the rays
    bool from_lobe      = false; // such rays are drawn from the lobe of a rough surface
};
RayBuffers make_ray_buffers(Gpu& gpu, size_t capacity, NumberFormat number_format, int rays_of_pixels = 0);
/// Sets the number of rays in a list that is uploaded, and their launches.
void set_ray_count(Gpu& gpu, const RayBuffers& rays, size_t count);
/// Returns the pass that sets the launches of a list that other passes have filled and counted.
ComputePass make_launch_pass(Gpu& gpu, const RayBuffers& rays);
/// Returns the rays of a workgroup of a structure's pass per ray group.
int rays_per_workgroup(const Gpu& gpu);

/// Which pixels of a G-buffer have rays, and how many each. The default is the mirror ray of each pixel that reflects.
struct RayChoice {
    bool every_surface = false; // also surfaces that do not reflect
    int  per_pixel     = 1;
    bool from_lobe     = false; // drawn from the lobe of rough surfaces
    int  block_px      = 1;     // one pixel in each block of this side has rays
};

/// The passes of a technique on one list of rays.
struct TechniquePasses {
    std::vector<StructurePasses> structures; // those that depend on the list
    ComputePass                  trace;
};

/// The pass that marks and lists tiles, with the number of adjacent tiles per workgroup.
struct Classification {
    ComputePass pass;
    uint32_t    tiles_per_group = 1;
};

struct TracePasses {
    Classification  classification;
    ComputePass     rays;
    TechniquePasses technique;
};

/// Buffers that counting pipelines write; null in timed pipelines.
struct Counters {
    const Buffer* work   = nullptr; // steps, depth fetches and structure fetches of each ray
    const Buffer* visits = nullptr; // reads of the only ray of the list (shaders/trace/visits.glsl)
};

/// Returns the passes from the lab's G-buffer to hits. `view`: its uniform block in the precision of the rays.
TracePasses make_trace_passes(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Buffer& view,
                              const RayChoice& choice = {}, const Counters& counters = {});
/// Returns the passes of the technique on a list. `bindings`: list, G-buffer and view; "Work" and "Visits" count.
TechniquePasses make_technique_passes(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Bindings& bindings);
/// Records building the structures that depend on depth alone.
void record_depth_structures(const Commands& commands, const Lab& lab);
/// Records building all structures that depend on the list, then the trace.
void record_technique(const Commands& commands, const TechniquePasses& passes, const RayBuffers& rays);

/// Records classification and ray set-up.
void record_rays(const Commands& commands, const TracePasses& passes, const GBuffer& gbuffer);
void record_classification(const Commands& commands, const TracePasses& passes, const GBuffer& gbuffer);
void record_ray_setup(const Commands& commands, const TracePasses& passes, const GBuffer& gbuffer);

/// Returns the counts of the G-buffer by the settings' rule of what reflects; counted once for each rule.
const GBufferCounts& count_gbuffer(Gpu& gpu, GBuffer& gbuffer, const TraceSettings& settings);
/// Traces once and returns how the rays ended.
TraceCounts count_hits(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const RayChoice& choice);

// What shaders are composed with.
/// Returns G-buffer, tiles, list and hits by their names in shaders, without the view.
Bindings ray_bindings(const GBuffer& gbuffer, const RayBuffers& rays);
/// Returns the macros for a shader that reads or writes this list.
Defines ray_list_defines(const Gpu& gpu, const RayBuffers& rays);
/// Returns the number types of shaders/api/real.glsl and rays/double_float.glsl.
Defines number_format_defines(const Gpu& gpu, NumberFormat number_format);
/// Adds the surface model and the layers to a shader (shaders/surfaces/).
void add_surface(ShaderSource& source, const Surface& surface, int layers);
/// Returns the macros for a shader that stores texels of this buffer (shaders/layout/stored_texels.glsl).
Defines store_defines(const Gpu& gpu, const Buffer& texels);
/// Adds the constants of shaders/rays/reflecting.glsl.
void add_reflecting(Constants& constants, const TraceSettings& settings);
/// Returns view and settings as constants. `exact`: for a shader compiled with EXACT_ARITHMETIC (slab in double).
Constants settings_constants(const View& view, const TraceSettings& settings, NumberFormat number_format,
                             bool exact = false);
/// Returns GLSL that declares one constant per parameter, from constant `id` on, and PARAMETER_CHOICE for each choice.
std::string parameter_declarations(std::span<const Parameter> parameters, uint32_t id);
void        add_parameters(Constants& constants, std::span<const Parameter> parameters, const ParameterValues& values,
                           uint32_t id);

/// Returns the shaders that trace and that set rays up. With "Work" and "Visits" in bindings, one that counts.
ShaderSource trace_source(const Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Bindings& bindings);
ShaderSource ray_setup_source(const Gpu& gpu, const RayBuffers& rays);

// What shaders wrote.
/// Packs a pixel and a number into one word, as shaders/layout/packed_pixel.glsl does.
uint32_t   pack_pixel(glm::ivec2 pixel, int number);
glm::ivec2 unpack_pixel(uint32_t packed);
/// Returns how a ray ended, in any layer.
TraceStatus unpack_status(uint32_t packed);
uint8_t     unpack_layer(uint32_t packed);
/// Downloads the list of rays.
template <typename Real> std::vector<PackedRay<Real>> read_list(Gpu& gpu, const RayBuffers& rays)
{
    return download_as<PackedRay<Real>>(gpu, rays.list, download_as<uint32_t>(gpu, rays.count, 1)[0]);
}

/// Returns the words per ray of the counting pipeline's buffer: steps, depth fetches, fetches of each structure; for an
/// impossible result, the status and pixel that the technique returned.
size_t work_words(const Technique& technique);
/// Downloads the result of each pixel. `work`: null for a result without counts.
template <typename Real> TraceImage read_result(Gpu& gpu, const Lab& lab, const RayBuffers& rays, const Buffer* work);

float half_to_float(uint16_t half);

} // namespace ssrlab
