// The lab's passes as shaders that are composed but not yet compiled, for whoever takes them elsewhere (export/).
#pragma once

#include "gpu/compute.h"
#include "trace/lab.h"

namespace ssrlab {

struct ComposedPass {
    std::string             structure; // that it builds; empty: the trace
    ShaderSource            source;
    Constants               constants;
    int                     rays_per_workgroup = 0; // above 0: a workgroup for so many rays of the list
    std::vector<glm::ivec2> levels; // per level: the first and the last that each dispatch makes, pushed
    std::vector<glm::uvec3> groups; // of each dispatch, where the rays do not decide
    std::string             rule;   // how many workgroups, in words, for any image and list
};

/// A buffer of a structure, "structure.buffer", which shaders call buffer_loaded and buffer_stored.
struct ComposedBuffer {
    std::string structure, name;
    size_t      bytes = 0;
    std::string rule; // how many elements, in words
};

struct ComposedLab {
    std::vector<ComposedPass>   passes; // in the order in which they run; the trace is the last
    std::vector<ComposedBuffer> buffers;
    size_t depth_bytes = 0; // of the depth with all levels and planes, filled with BACKGROUND_DEPTH
};

/// For so many rays, in single precision, without counters.
ComposedLab compose_lab(Gpu& gpu, const Lab& lab, size_t rays);

/// A shader of this file with the lab's surface model, view and settings.
ShaderSource compose_shader(const Lab& lab, const std::filesystem::path& file);
Constants    compose_constants(const Lab& lab);

/// The words that the host gives to the passes beside its depth, and those that it gets back.
struct FrameWords {
    std::vector<uint32_t> view;      // the uniform block of shaders/api/view.glsl
    std::vector<uint32_t> gradients; // row by row, as core/plane_gradient.h packs them
    std::vector<uint32_t> normals;   // row by row: four floats, the normal in view space and the roughness
    std::vector<uint32_t> solids; // row by row: floats, the depth where the solid behind the pixel ends, 0: it is thin
};
FrameWords            read_frame_words(Gpu& gpu, const Lab& lab);
std::vector<uint32_t> pack_rays(std::span<const RayInput> rays);
std::vector<uint32_t> pack_outcomes(std::span<const RayOutcome> outcomes);

} // namespace ssrlab
