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

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    // Without rays, hit_colour does not run, which fills the reflection.
    RecordFunction  no_reflection;
    const GpuImage& reflection = image_of(context, Resource::reflection);
    if (context.frame.plan.statistics.gbuffer.reflecting_pixels == 0)
        no_reflection = make_reflection_fill(gpu, reflection);
    return [no_reflection, groups = groups_of_8(reflection.size_px),
            pass = make_shared_pass(gpu, context, "passes/composite.comp")](const auto& commands) {
        if (no_reflection) no_reflection(commands);
        dispatch(commands, *pass, groups);
    };
}

} // namespace

Pass composite_pass()
{
    return {
        .id      = "composite",
        .summary = "Adds the reflection to each surface's own light",
        .cite   = {"J. Somerville Roberts, Screen Space Reflections", "B. Karis 2013, Real Shading in Unreal Engine 4"},
        .reads  = {Resource::gbuffer, Resource::light, Resource::reflection},
        .writes = {Resource::reflection /* nothing, where no ray starts */, Resource::shaded},
        .parameters         = {choice_parameter(Reflectance::ggx,
                                                "how much of a surface's light is its reflection. ggx: the directional albedo "
                                                        "of its GGX lobe, tinted, and energy is split with what comes from below the "
                                                        "surface; metallic: own + (reflected - own) * metallic ^ metallic_exponent"),
                               real_parameter("metallic_exponent", 3, 0, 64,
                                              "exponent of reflectance = metallic; 0: the factor is 1")},
        .decide             = decide,
        .prepare            = prepare,
        .read_of_reflectors = {"depth_words", "normal_image", "material_image", "dielectric_image", "emission_image"}};
}

Image composite_reflection(Gpu& gpu, const ReadyFrame& frame, std::span<const glm::vec4> reflection)
{
    std::vector<uint64_t> texels;
    texels.reserve(reflection.size());
    for (const glm::vec4& value : reflection) texels.push_back(glm::packHalf4x16(value));
    GpuImage& target = frame.inputs.buffers->reflection;
    upload(gpu, target, texels.data(), texels.size() * sizeof(uint64_t));
    const Pass        composite = composite_pass();
    const ComputePass pass      = make_pass(gpu, {frame.inputs, composite, composite.id}, "passes/composite.comp");
    submit(gpu, [&](const auto& commands) {
        barrier(commands);
        dispatch(commands, pass, groups_of_8(target.size_px));
        barrier(commands);
    });
    return read_shaded(gpu, frame);
}

} // namespace ssrlab
