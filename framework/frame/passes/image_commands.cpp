// Copies and fills of whole images.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {

void record_copy(const Commands& commands, const GpuImage& source, const GpuImage& target)
{
    if (note(commands, {.uses = {{storage_of(source), true, false}, {storage_of(target), false, true}}})) return;
    const vk::ImageSubresourceLayers colour{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
    const vk::ImageCopy              whole{
                     .srcSubresource = colour,
                     .dstSubresource = colour,
                     .extent = {static_cast<uint32_t>(source.size_px.x), static_cast<uint32_t>(source.size_px.y), 1}};
    barrier(commands);
    commands.copyImage(*source.image, vk::ImageLayout::eGeneral, *target.image, vk::ImageLayout::eGeneral, whole);
    barrier(commands);
}

RecordFunction make_fill(Gpu& gpu, const GpuImage& image, glm::uvec4 bits)
{
    const bool    halves = image.format == vk::Format::eR16G16B16A16Sfloat;
    const Defines words{{"FORMAT", "r32ui"}, {"IMAGE", "uimage2D"}, {"VALUE", "uvec4"}};
    const Defines floats{
        {"FORMAT", halves ? "rgba16f" : "rgba32f"}, {"IMAGE", "image2D"}, {"VALUE", "uintBitsToFloat"}};
    const ShaderSource source{.file    = "passes/fill.comp",
                              .defines = image.format == vk::Format::eR32Uint ? words : floats};
    auto               pass = std::make_shared<ComputePass>(
        make_compute_pass(gpu, compile_shader(gpu, source), {{"filled_image", image}}, {}, sizeof(bits)));
    return [pass, bits, groups = groups_of_8(image.size_px)](const auto& commands) {
        push(commands, *pass, bits);
        dispatch(commands, *pass, groups);
        barrier(commands);
    };
}

RecordFunction make_reflection_fill(Gpu& gpu, const GpuImage& reflection)
{
    return make_fill(gpu, reflection, glm::floatBitsToUint(glm::vec4(0, 0, 0, -1)));
}

} // namespace ssrlab
