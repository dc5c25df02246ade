// The final image.
#include "render/passes/pass_helpers.h"

#include <glm/gtc/packing.hpp>

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& /*facts*/, const FrameStatistics& /*statistics*/,
                    const ParameterValues& /*values*/)
{
    return {PassDecision::needed, "every frame"};
}

RecordFunction prepare(Gpu& gpu, PreparedFrame& frame)
{
    // Without rays, hit_colour does not run, which clears the reflection.
    const bool no_rays = frame.buffers->statistics.gbuffer.reflecting_pixels == 0;
    return [&frame, no_rays, pass = make_shared_pass(gpu, frame, "passes/composite.comp")](const auto& commands) {
        if (no_rays) record_clear_reflection(commands, frame.buffers->reflection);
        dispatch(commands, *pass, groups_of_8(frame.buffers->gbuffer->view.size_px));
    };
}

} // namespace

Pass composite_pass()
{
    return {.id         = "composite",
            .summary    = "Blends reflected over own light: C = C_own + (C_reflected - C_own) * beta",
            .cite       = {"J. Somerville Roberts, Screen Space Reflections"},
            .parameters = {choice_parameter(Reflectance::metallic,
                                            "metallic: beta = weight * metallic ^ metallic_exponent; ggx: beta = "
                                            "weight * directional albedo of a GGX surface"),
                           real_parameter("metallic_exponent", 3, 0, 64,
                                          "exponent of reflectance = metallic; 0: the factor is 1")},
            .decide     = decide,
            .prepare    = prepare};
}

Image composite_reflection(Gpu& gpu, const PreparedFrame& frame, std::span<const glm::vec4> reflection)
{
    std::vector<uint64_t> texels;
    texels.reserve(reflection.size());
    for (const glm::vec4& value : reflection) texels.push_back(glm::packHalf4x16(value));
    FrameBuffers& buffers = *frame.buffers;
    upload(gpu, buffers.reflection, texels.data(), texels.size() * sizeof(uint64_t));
    const ComputePass pass = make_pass(gpu, frame, "passes/composite.comp");
    submit(gpu, [&](const auto& commands) {
        barrier(commands);
        dispatch(commands, pass, groups_of_8(buffers.gbuffer->view.size_px));
        barrier(commands);
    });
    return read_shaded(gpu, frame);
}

} // namespace ssrlab
