// How structures are built on the device, and the GLSL by which shaders read and write them. Folder-internal.
#pragma once

#include "trace/gbuffer.h"

namespace ssrlab {

struct RayBuffers;

/// One pass with all its dispatches.
struct StructureDispatch {
    ComputePass             pass;
    bool                    per_ray = false; // the list of rays says how many groups
    std::vector<glm::ivec2> levels;          // per level: the first and the last that each dispatch makes, pushed
    std::vector<glm::uvec3> groups;          // of each dispatch
};

/// A structure's passes on one depth, or on one list of rays. None where it has none of that kind.
struct StructurePasses {
    std::string                    id;
    std::vector<StructureDispatch> dispatches;
};

/// Those of the lab's technique that depend on its depth alone, in the order in which structures are built.
std::vector<StructurePasses> make_depth_structures(Gpu& gpu, const Lab& lab);
/// Those that depend on a list of rays, too. bindings: the list, the G-buffer and the view; with "Work" fetches are counted.
std::vector<StructurePasses> make_ray_structures(Gpu& gpu, const Lab& lab, const RayBuffers& rays,
                                                 const Bindings& bindings);
/// group_launch: groups of workgroups for the list of rays; null where no pass is per ray group.
void record_structure(const vk::raii::CommandBuffer& commands, const StructurePasses& structure,
                      const Buffer* group_launch);

/// The buffers of a technique's structures by the names of structure_declarations().
Bindings structure_bindings(Gpu& gpu, const Technique& technique, const GBuffer& gbuffer, const RayBuffers& rays);
/// For a shader of the technique: STRUCTURE_ID, the number of each structure, and load_BUFFER(index) of their buffers, each
/// structure followed by its read.glsl. For a shader that builds one of them (`built`), only what that one reads, and
/// load_BUFFER and store_BUFFER(index, value) of its own.
std::string structure_declarations(const Technique& technique, const Structure* built, bool in_double);
/// Where "structure/ID/read.glsl" lies.
std::map<std::string, std::filesystem::path> structure_include_files(const Technique& technique);
/// Fetches that building for each group of rays took: of each structure of the technique, or none.
std::vector<std::vector<uint32_t>> read_group_fetches(Gpu& gpu, const Technique& technique, const RayBuffers& rays);

} // namespace ssrlab
