// How each row of the table of effects is recorded.
#include "render/effect_passes.h"

#include "core/error.h"

#include <glm/gtc/packing.hpp>

namespace ssrlab {

ComputePass make_effect_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, const Defines& defines,
                             const Bindings& more, uint32_t push_constant_bytes)
{
    const FrameBuffers& buffers   = *frame.buffers;
    Constants           constants = settings_constants(frame, Precision::float32);
    add_parameters(constants, effect_parameters(), frame.settings.effects, CONSTANT_EFFECTS);
    Bindings bindings = more;
    bindings.merge(bindings_of(buffers, *frame.rays));
    bindings.insert({{"View", buffers.view},
                     {"radiance_image", buffers.gbuffer->radiance},
                     {"highlight_image", buffers.gbuffer->highlight},
                     {"reflection_image", buffers.reflection},
                     {"filtered_image", buffers.filtered},
                     {"small_colour_image", buffers.small_colour},
                     {"block_pixel_image", buffers.block_pixel},
                     {"shaded_image", buffers.shaded},
                     {"ggx_shares", {buffers.ggx_shares, buffers.ggx_share_sampler}}});
    if (const GpuScene* scene = buffers.gbuffer->scene.get())
        bindings.insert({{"Frame", buffers.gbuffer->frame_uniforms},
                         {"environment_map", {scene->environment_map, scene->environment_sampler}},
                         {"Lights", scene->lights},
                         {"ShadowMatrices", scene->shadow_matrices},
                         {"shadow_map", {scene->shadow_map, scene->shadow_sampler}}});
    return make_compute_pass(
        gpu,
        compile_shader(
            {.file          = shader,
             .defines       = defines,
             .include_texts = {{"effect/parameters", parameter_declarations(effect_parameters(), CONSTANT_EFFECTS)}}}),
        bindings, constants, push_constant_bytes);
}

ComputePass make_colour_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, Defines defines,
                             Bindings more)
{
    constexpr double mirrored = 2;
    if (frame.settings.effects.at("hit_light") == mirrored) {
        if (!frame.buffers->gbuffer->scene)
            throw_spec_error("hit_light = mirrored needs the scene's lights; this G-buffer came without a scene");
        defines.emplace("MIRRORED_LIGHT", "1");
    }
    if (frame.hidden_layer) {
        const GBuffer& layer = *frame.buffers->second_layer;
        defines.emplace("SECOND_LAYER", "1");
        more.insert({{"second_depth_words", layer.depth.words},
                     {"second_normal_image", layer.normal},
                     {"second_material_image", layer.material},
                     {"second_radiance_image", layer.radiance},
                     {"second_highlight_image", layer.highlight}});
    }
    if (frame.cone) {
        defines.emplace("CONE", "1");
        more.insert({"cone_pyramid", frame.buffers->cone->cells});
    }
    return make_effect_pass(gpu, frame, shader, defines, more);
}

void record_copy(const vk::raii::CommandBuffer& commands, const GpuImage& source, const GpuImage& target)
{
    const vk::ImageSubresourceLayers colour{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
    const vk::ImageCopy              whole{
                     .srcSubresource = colour,
                     .dstSubresource = colour,
                     .extent = {static_cast<uint32_t>(source.size_px.x), static_cast<uint32_t>(source.size_px.y), 1}};
    barrier(commands);
    commands.copyImage(*source.image, vk::ImageLayout::eGeneral, *target.image, vk::ImageLayout::eGeneral, whole);
    barrier(commands);
}

namespace {

std::shared_ptr<ComputePass> shared_effect_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader,
                                                const Defines& defines = {})
{
    return std::make_shared<ComputePass>(make_effect_pass(gpu, frame, shader, defines));
}

void clear(const vk::raii::CommandBuffer& commands, const GpuImage& image, vk::ClearColorValue value)
{
    const vk::ImageSubresourceRange all{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};
    barrier(commands);
    commands.clearColorImage(*image.image, vk::ImageLayout::eGeneral, value, all);
    barrier(commands);
}

/// No ray started anywhere.
void clear_reflection(const vk::raii::CommandBuffer& commands, const GpuImage& reflection)
{
    clear(commands, reflection, {std::array<float, 4>{0, 0, 0, -1}});
}

Recording classification(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_classification(commands, frame.trace, *frame.buffers); };
}

Recording rays(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_ray_setup(commands, frame.trace, *frame.buffers); };
}

Recording structures(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_depth_structures(commands, frame.structures);
        record_ray_structures(commands, frame.trace.technique, *frame.rays); };
}

Recording trace(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { dispatch_indirect(commands, frame.trace.technique.trace, frame.rays->launch); };
}

Recording colour_downsampling(Gpu& gpu, PreparedFrame& frame)
{
    const glm::ivec2 blocks = (frame.buffers->gbuffer->view.size_px - 1) / trace_block_px(frame.settings.effects) + 1;
    return [blocks, pass = shared_effect_pass(gpu, frame, "passes/colour_downsampling.comp")](const auto& commands) {
        dispatch(commands, *pass, groups_of_8(blocks));
    };
}

Recording hit_colour(Gpu& gpu, PreparedFrame& frame)
{
    auto pass = std::make_shared<ComputePass>(make_colour_pass(gpu, frame, "passes/hit_colour.comp"));
    return [&frame, pass](const auto& commands) {
        clear_reflection(commands, frame.buffers->reflection);
        if (trace_block_px(frame.settings.effects) > 1)
            clear(commands, frame.buffers->block_pixel, {std::array<uint32_t, 4>{NO_PIXEL, 0, 0, 0}});
        dispatch_indirect(commands, *pass, frame.rays->launch);
    };
}

Recording blur(Gpu& gpu, PreparedFrame& frame)
{
    return [&frame, x = shared_effect_pass(gpu, frame, "passes/blur.comp", {{"ALONG_X", "1"}}),
            y = shared_effect_pass(gpu, frame, "passes/blur.comp")](const auto& commands) {
        clear_reflection(commands, frame.buffers->filtered); // of tiles that are not listed
        dispatch_indirect(commands, *x, frame.buffers->tiles.launch);
        barrier(commands);
        dispatch_indirect(commands, *y, frame.buffers->tiles.launch);
    };
}

Recording environment(Gpu& gpu, PreparedFrame& frame)
{
    return [&frame, pass = shared_effect_pass(gpu, frame, "passes/environment.comp")](const auto& commands) {
        dispatch_indirect(commands, *pass, frame.buffers->tiles.launch);
    };
}

Recording upsampling(Gpu& gpu, PreparedFrame& frame)
{
    return [&frame, pass = shared_effect_pass(gpu, frame, "passes/upsampling.comp")](const auto& commands) {
        dispatch_indirect(commands, *pass, frame.buffers->tiles.launch);
    };
}

Recording kernel_filter(Gpu& gpu, PreparedFrame& frame)
{
    return [&frame, pass = shared_effect_pass(gpu, frame, "passes/filter_3x3.comp")](const auto& commands) {
        clear_reflection(commands, frame.buffers->filtered); // of tiles that are not listed
        dispatch_indirect(commands, *pass, frame.buffers->tiles.launch);
        record_copy(commands, frame.buffers->filtered, frame.buffers->reflection);
    };
}

Recording composite(Gpu& gpu, PreparedFrame& frame)
{
    // Without rays there is no pass that says so pixel by pixel.
    const bool no_rays = frame.buffers->statistics.picture.reflecting_pixels == 0;
    return [&frame, no_rays, pass = shared_effect_pass(gpu, frame, "passes/composite.comp")](const auto& commands) {
        if (no_rays) clear_reflection(commands, frame.buffers->reflection);
        dispatch(commands, *pass, groups_of_8(frame.buffers->gbuffer->view.size_px));
    };
}

} // namespace

Recording make_recording(Gpu& gpu, PreparedFrame& frame, const std::string& effect)
{
    static const std::map<std::string, Recording (*)(Gpu&, PreparedFrame&)> makers = {
        {"classification", classification},
        {"rays", rays},
        {"structures", structures},
        {"trace", trace},
        {"hidden_layer", hidden_layer},
        {"colour_downsampling", colour_downsampling},
        {"cone_pyramid", cone_pyramid},
        {"hit_colour", hit_colour},
        {"bounces", bounces},
        {"upsampling", upsampling},
        {"kernel_filter", kernel_filter},
        {"blur", blur},
        {"environment", environment},
        {"composite", composite},
    };
    return makers.at(effect)(gpu, frame);
}

Image composite_reflection(Gpu& gpu, const PreparedFrame& frame, std::span<const glm::vec4> reflection)
{
    std::vector<uint64_t> texels;
    texels.reserve(reflection.size());
    for (const glm::vec4& value : reflection) texels.push_back(glm::packHalf4x16(value));
    FrameBuffers& buffers = *frame.buffers;
    upload(gpu, buffers.reflection, texels.data(), texels.size() * sizeof(uint64_t));
    const ComputePass pass = make_effect_pass(gpu, frame, "passes/composite.comp");
    submit(gpu, [&](const auto& commands) {
        barrier(commands);
        dispatch(commands, pass, groups_of_8(buffers.gbuffer->view.size_px));
        barrier(commands);
    });
    return read_shaded(gpu, frame);
}

TraceCounts count_hits(Gpu& gpu, PreparedFrame& frame)
{
    const Buffer counts   = make_buffer(gpu, 16);
    Bindings     bindings = bindings_of(*frame.buffers, *frame.rays);
    bindings.insert({{"View", frame.buffers->view}, {"TraceStatistics", counts}});
    const ComputePass count =
        make_compute_pass(gpu, compile_shader({.file = "trace/trace_statistics.comp"}), bindings);
    submit(gpu, [&](const auto& commands) {
        commands.fillBuffer(*counts.buffer, 0, VK_WHOLE_SIZE, 0);
        record_rays(commands, frame.trace, *frame.buffers);
        record_depth_structures(commands, frame.structures);
        record_technique(commands, frame.trace.technique, *frame.rays);
        barrier(commands);
        dispatch_indirect(commands, count, frame.rays->launch);
        barrier(commands);
    });
    return download_as<TraceCounts>(gpu, counts, 1)[0];
}

} // namespace ssrlab
