// The shaders of a lab before they are compiled: by files and texts, with their constants and dispatches. Folder-internal.
#pragma once

#include "trace/lab_passes.h"

namespace ssrlab {

/// The constants of a trace. Throws where the values ask for arithmetic that the device or the surface model lacks.
Constants trace_constants(const Gpu& gpu, const Lab& lab, const RayBuffers& rays);

/// The passes of a structure that build it on this device, in order: those of its style.
std::vector<StructurePass> passes_on(const Gpu& gpu, const Structure& structure);
/// The shader of one of them.
ShaderSource build_source(const Gpu& gpu, const Lab& lab, const Structure& structure, const StructurePass& pass,
                          const RayBuffers& rays, bool counts_work);
/// Its constants, in the precision of the rays where it is built for them.
Constants build_constants(const Lab& lab, NumberFormat number_format);
/// Its dispatches, without the pass.
StructureDispatch dispatches_of(const Lab& lab, const StructurePass& pass);
/// Of a buffer that is not the depth's own.
size_t structure_buffer_bytes(const StructureBuffer& buffer, glm::ivec2 size_px, const RayBuffers& rays);

} // namespace ssrlab
