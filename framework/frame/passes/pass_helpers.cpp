#include "frame/passes/pass_helpers.h"

#include "frame/layers.h"

namespace ssrlab {

Parameter boolean_parameter(const char* name, bool fallback, const char* doc)
{
    return {name, ParameterType::boolean, fallback ? 1.0 : 0.0, 0, 1, {}, doc};
}

Parameter integer_parameter(const char* name, double fallback, double min, double max, const char* doc)
{
    return {name, ParameterType::integer, fallback, min, max, {}, doc};
}

Parameter real_parameter(const char* name, double fallback, double min, double max, const char* doc)
{
    return {name, ParameterType::real, fallback, min, max, {}, doc};
}

Parameter choice_parameter(ChoiceNames names, double fallback, const char* doc)
{
    constexpr std::string_view separator = ", ";
    std::vector<std::string>   choices;
    for (std::string_view rest = names.choices; !rest.empty();) {
        const size_t end = std::min(rest.find(separator), rest.size());
        choices.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + separator.size(), rest.size()));
    }
    const double last = static_cast<double>(choices.size()) - 1;
    return {std::string(names.parameter), ParameterType::choice, fallback, 0, last, std::move(choices), doc};
}

PassDecision needed_if_anything_reflects(const FrameFacts& /*facts*/, const FrameStatistics& statistics,
                                         const ParameterValues& /*values*/)
{
    const uint32_t reflecting = statistics.gbuffer.reflecting_pixels;
    if (reflecting == 0) return {PassDecision::not_needed, "no pixel reflects"};
    return {PassDecision::needed,
            fmt::format("{} pixels reflect ({})", reflecting, percent(reflecting, statistics.pixels))};
}

PassDecision needed_if_anything_is_rough(const FrameStatistics& statistics)
{
    const uint32_t all = statistics.gbuffer.reflecting_pixels, rough = all - statistics.gbuffer.roughness_pixels[0];
    if (all == 0) return {PassDecision::not_needed, "no pixel reflects"};
    if (rough == 0) return {PassDecision::not_needed, "every reflecting pixel is smooth"};
    return {PassDecision::needed, fmt::format("{} of the reflecting pixels are rough", percent(rough, all))};
}

PassDecision needed_at_lower_resolution(const FrameFacts& facts, const FrameStatistics& statistics,
                                        const ParameterValues& values)
{
    const int block_px = trace_block_px(values);
    if (block_px == 1) {
        const bool shading = choice<PassSet>(values) == PassSet::shading;
        return {shading ? PassDecision::off : PassDecision::not_needed, "every reflecting pixel has its own rays"};
    }
    if (statistics.gbuffer.reflecting_pixels == 0) return needed_if_anything_reflects(facts, statistics, values);
    return {PassDecision::needed, fmt::format("one pixel in {} has rays", block_px * block_px)};
}

bool one_ray_per_pixel(const ParameterValues& values)
{
    return values.at("rays_per_pixel") == 1 && trace_block_px(values) == 1;
}

ComputePass make_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, const Defines& defines,
                      const Bindings& more, uint32_t push_constant_bytes)
{
    return make_composed_pass(gpu, frame, {.file = shader, .defines = defines}, more, {}, push_constant_bytes);
}

ComputePass make_composed_pass(Gpu& gpu, const PreparedFrame& frame, ShaderSource source, const Bindings& more,
                               std::span<const Parameter> own, uint32_t push_constant_bytes)
{
    const FrameBuffers& buffers   = *frame.buffers;
    Constants           constants = settings_constants(frame, Precision::float32);
    add_parameters(constants, pass_parameters(), frame.settings.passes, CONSTANT_PASSES);
    add_parameters(constants, own, frame.settings.passes, CONSTANT_REPROJECTION);
    Bindings bindings = more;
    if (!bindings.contains("Rays")) source.defines.merge(ray_list_defines(gpu, *frame.rays));
    bindings.merge(bindings_of(buffers, *frame.rays));
    bindings.insert({{"View", buffers.view},
                     {"radiance_image", buffers.gbuffer->radiance},
                     {"highlight_image", buffers.gbuffer->highlight},
                     {"reflection_image", buffers.reflection},
                     {"filtered_image", buffers.filtered},
                     {"small_colour_image", buffers.small_colour},
                     {"block_pixel_image", buffers.block_pixel},
                     {"shaded_image", buffers.shaded},
                     {"Ambient", buffers.ambient},
                     {"dfg_table", {buffers.dfg_table, buffers.dfg_sampler}}});
    if (const GpuScene* scene = buffers.gbuffer->scene.get())
        bindings.insert({{"Frame", buffers.gbuffer->frame_uniforms},
                         {"environment_map", {scene->environment_map, scene->environment_sampler}},
                         {"Lights", scene->lights},
                         {"ShadowMatrices", scene->shadow_matrices},
                         {"shadow_map", {scene->shadow_map, scene->shadow_sampler}}});
    source.include_texts.emplace("pass/parameters", parameter_declarations(pass_parameters(), CONSTANT_PASSES));
    return make_compute_pass(gpu, compile_shader(gpu, source), bindings, constants, push_constant_bytes);
}

std::shared_ptr<ComputePass> make_shared_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader,
                                              const Defines& defines)
{
    return std::make_shared<ComputePass>(make_pass(gpu, frame, shader, defines));
}

ComputePass make_colour_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, Defines defines,
                             Bindings more)
{
    if (choice<HitShading>(frame.settings.passes) == HitShading::mirrored) {
        defines.emplace("MIRRORED_LIGHT", "1");
    }
    defines.emplace("LAYERS", std::to_string(frame.hidden_layer ? 2 : frame.settings.trace.layers));
    if (frame.hidden_layer) add_layers(more, std::span(&frame.buffers->second_layer, 1));
    if (draws_lobe_rays(frame.settings.passes)) {
        defines.emplace("LOBE_RAYS", "1");
        more.merge(lobe_ray_bindings(gpu, frame));
        add_environment(gpu, frame, defines, more);
    }
    if (frame.cone) {
        defines.emplace("CONE", "1");
        more.insert({"cone_pyramid", frame.buffers->cone->cells});
    }
    return make_pass(gpu, frame, shader, defines, more);
}

void add_environment(Gpu& gpu, const PreparedFrame& frame, Defines& defines, Bindings& bindings)
{
    GpuScene* scene = frame.buffers->gbuffer->scene.get();
    if (scene == nullptr || frame.settings.passes.at("environment_fallback") == 0) return;
    const GBufferCounts& counts = frame.statistics.gbuffer;
    const bool           smooth = counts.roughness_pixels[0] == counts.reflecting_pixels; // looks up the map alone
    const GpuImage&      levels = smooth ? scene->environment_map : blurred_environment(gpu, *scene);
    defines.emplace("ENVIRONMENT", "1");
    bindings.insert({"environment_levels", {levels, scene->environment_sampler}});
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

void record_clear(const vk::raii::CommandBuffer& commands, const GpuImage& image, vk::ClearColorValue value)
{
    const vk::ImageSubresourceRange all{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};
    barrier(commands);
    commands.clearColorImage(*image.image, vk::ImageLayout::eGeneral, value, all);
    barrier(commands);
}

void record_clear_reflection(const vk::raii::CommandBuffer& commands, const GpuImage& reflection)
{
    record_clear(commands, reflection, {std::array<float, 4>{0, 0, 0, -1}});
}

} // namespace ssrlab
