// The final image.
#include "frame/passes/pass_helpers.h"

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
    const bool no_rays = frame.statistics.gbuffer.reflecting_pixels == 0;
    return [&frame, no_rays, pass = make_shared_pass(gpu, frame, "passes/composite.comp")](const auto& commands) {
        if (no_rays) record_clear_reflection(commands, frame.buffers->reflection);
        dispatch(commands, *pass, groups_of_8(frame.buffers->gbuffer->view.size_px));
    };
}

} // namespace

Pass composite_pass()
{
    return {
        .id      = "composite",
        .summary = "Adds the reflection to each surface's own light",
        .cite = {"J. Somerville Roberts, Screen Space Reflections", "B. Karis 2013, Real Shading in Unreal Engine 4"},
        .parameters = {choice_parameter(Reflectance::ggx,
                                        "how much of a surface's light is its reflection. ggx: the directional albedo "
                                        "of its GGX lobe, tinted, and energy is split with what comes from below the "
                                        "surface; metallic: own + (reflected - own) * metallic ^ metallic_exponent"),
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
