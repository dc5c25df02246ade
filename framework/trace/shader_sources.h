// The shaders of a lab before they are compiled: files and texts, with constants and dispatches. Folder-internal.
#pragma once

#include "trace/lab_passes.h"

namespace ssrlab {

/// Returns the constants of a trace. Throws if the values ask for arithmetic that the device (Failure) or the surface
/// model (SpecError) lacks.
Constants trace_constants(const Gpu& gpu, const Lab& lab, const RayBuffers& rays);

/// Returns the passes that build a structure on this device, in order: those of the device's style.
std::vector<StructurePass> passes_on(const Gpu& gpu, const Structure& structure);
/// Returns the shader of one of them.
ShaderSource build_source(const Gpu& gpu, const Lab& lab, const Structure& structure, const StructurePass& pass,
                          const RayBuffers& rays, bool counts_work);
/// Returns its constants, in the number format of the rays if it is built for rays.
Constants build_constants(const Lab& lab, NumberFormat number_format);
/// Returns its dispatches, without the pass.
StructureDispatch dispatches_of(const Lab& lab, const StructurePass& pass);
/// Returns the size of a structure's buffer, which must not be the depth's own.
size_t structure_buffer_bytes(const StructureBuffer& buffer, glm::ivec2 size_px, const RayBuffers& rays);

} // namespace ssrlab
