// How structures are built on the device, and the GLSL by which shaders read and write them. Folder-internal.
#pragma once

#include "trace/gbuffer.h"

namespace ssrlab {

struct RayBuffers;

/// One pass with all its dispatches.
struct StructureDispatch {
    ComputePass             pass;
    bool                    per_ray = false; // the list of rays says how many groups
    std::vector<glm::ivec2> levels;          // first and last level of each dispatch, as push constants
    std::vector<glm::uvec3> groups;          // of each dispatch
};

/// A structure's passes for one depth buffer or one list of rays; empty if it has none of that kind.
struct StructurePasses {
    std::string                    id;
    std::vector<StructureDispatch> dispatches;
};

/// Returns the structures of the lab's technique that depend on depth alone, in the order of building.
std::vector<StructurePasses> make_depth_structures(Gpu& gpu, const Lab& lab);
/// Returns those that depend on a list of rays. `bindings`: list, G-buffer and view; with "Work" fetches are counted.
std::vector<StructurePasses> make_ray_structures(Gpu& gpu, const Lab& lab, const RayBuffers& rays,
                                                 const Bindings& bindings);
/// Returns the shaders of both, timed, not counted.
std::vector<ShaderSource> structure_sources(Gpu& gpu, const Lab& lab, const RayBuffers& rays);
/// Records building a structure. `group_launch`: dispatch arguments for the list of rays; null without such a pass.
void record_structure(const Commands& commands, const StructurePasses& structure, const Buffer* group_launch);

/// Returns the buffers of a technique's structures, by the names of structure_declarations().
Bindings structure_bindings(Gpu& gpu, const Technique& technique, const GBuffer& gbuffer, const RayBuffers& rays);
/// Returns GLSL for a shader of the technique: STRUCTURE_ID, load_BUFFER(index) and read.glsl of each structure. For a
/// shader that builds one of them (`built`): only the structures that it reads, with load_BUFFER and
/// store_BUFFER(index, value) of its own buffers.
std::string structure_declarations(const Technique& technique, const Structure* built, bool in_double);
/// Returns the file behind each include of "structure/ID/read.glsl".
std::map<std::string, std::filesystem::path> structure_include_files(const Technique& technique);
/// Returns, per structure of the technique, the fetches of building it for each group of rays; empty without any.
std::vector<std::vector<uint32_t>> read_group_fetches(Gpu& gpu, const Technique& technique, const RayBuffers& rays);

} // namespace ssrlab
