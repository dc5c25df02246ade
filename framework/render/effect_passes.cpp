// How each row of the table of effects is recorded.
#include "render/effect_passes.h"

namespace ssrlab {

ComputePass make_effect_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader, const Bindings& more,
                             const std::map<std::string, std::string>& defines)
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
                     {"shaded_image", buffers.shaded}});
    return make_compute_pass(
        gpu,
        compile_shader(
            {.file          = shader,
             .defines       = defines,
             .include_texts = {{"effect/parameters", parameter_declarations(effect_parameters(), CONSTANT_EFFECTS)}}}),
        bindings, constants);
}

std::shared_ptr<DerivedRays> derived_rays(Gpu& gpu, const PreparedFrame& frame, int which)
{
    const size_t                  capacity = frame.rays->capacity;
    std::shared_ptr<DerivedRays>& derived  = frame.buffers->derived_rays[{capacity, which}];
    if (!derived) {
        const uint64_t bytes = std::max<uint64_t>(capacity, 1) * 4;
        derived = std::make_shared<DerivedRays>(DerivedRays{make_ray_buffers(gpu, capacity, Precision::float32),
                                                            make_buffer(gpu, bytes), make_buffer(gpu, bytes)});
    }
    return derived;
}

Bindings derived_bindings(const DerivedRays& derived)
{
    return {{"DerivedCount", derived.rays.count},       {"DerivedOrigins", derived.rays.origins},
            {"DerivedDeltas", derived.rays.deltas},     {"DerivedLengths", derived.rays.lengths},
            {"DerivedPixels", derived.rays.pixels},     {"DerivedHitPixels", derived.rays.hit_pixels},
            {"DerivedHitTs", derived.rays.hit_ts},      {"DerivedSources", derived.sources},
            {"DerivedThroughputs", derived.throughputs}};
}

namespace {

std::shared_ptr<ComputePass> shared_effect_pass(Gpu& gpu, const PreparedFrame& frame, const std::string& shader)
{
    return std::make_shared<ComputePass>(make_effect_pass(gpu, frame, shader));
}

/// No ray started anywhere.
void clear_reflection(const vk::raii::CommandBuffer& commands, const GpuImage& reflection)
{
    const vk::ClearColorValue       nothing{std::array<float, 4>{0, 0, 0, -1}};
    const vk::ImageSubresourceRange all{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};
    barrier(commands);
    commands.clearColorImage(*reflection.image, vk::ImageLayout::eGeneral, nothing, all);
    barrier(commands);
}

Recording classification(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_classification(commands, frame.trace, *frame.buffers); };
}

Recording rays(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_ray_setup(commands, frame.trace, *frame.buffers, *frame.rays); };
}

Recording depth_pyramid(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { record_pyramid(commands, frame.pyramid); };
}

Recording trace(Gpu& /*gpu*/, PreparedFrame& frame)
{
    return [&](const auto& commands) { dispatch_indirect(commands, frame.trace.trace, frame.rays->launch); };
}

Recording hit_colour(Gpu& gpu, PreparedFrame& frame)
{
    Bindings                           second;
    std::map<std::string, std::string> defines;
    if (frame.hidden_layer) {
        const GBuffer& layer = *frame.buffers->second_layer;
        defines              = {{"SECOND_LAYER", "1"}};
        second               = {{"second_depth_image", layer.depth},
                                {"second_radiance_image", layer.radiance},
                                {"second_highlight_image", layer.highlight}};
    }
    auto pass = std::make_shared<ComputePass>(make_effect_pass(gpu, frame, "effects/hit_colour.comp", second, defines));
    return [&frame, pass](const auto& commands) {
        clear_reflection(commands, frame.buffers->reflection);
        dispatch_indirect(commands, *pass, frame.rays->launch);
    };
}

Recording composite(Gpu& gpu, PreparedFrame& frame)
{
    // Without rays there is no pass that says so pixel by pixel.
    const bool no_rays = frame.buffers->statistics.picture.reflecting_pixels == 0;
    return [&frame, no_rays, pass = shared_effect_pass(gpu, frame, "effects/composite.comp")](const auto& commands) {
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
        {"depth_pyramid", depth_pyramid},
        {"trace", trace},
        {"hidden_layer", hidden_layer},
        {"hit_colour", hit_colour},
        {"bounces", bounces},
        {"composite", composite},
    };
    return makers.at(effect)(gpu, frame);
}

TraceCounts count_hits(Gpu& gpu, PreparedFrame& frame)
{
    const Buffer counts   = make_buffer(gpu, 16);
    Bindings     bindings = bindings_of(*frame.buffers, *frame.rays);
    bindings.insert({{"View", frame.buffers->view}, {"TraceStatistics", counts}});
    const ComputePass count =
        make_compute_pass(gpu, compile_shader({.file = "effects/trace_statistics.comp"}), bindings);
    submit(gpu, [&](const auto& commands) {
        commands.fillBuffer(*counts.buffer, 0, VK_WHOLE_SIZE, 0);
        record_rays(commands, frame.trace, *frame.buffers, *frame.rays);
        record_pyramid(commands, frame.pyramid);
        dispatch_indirect(commands, frame.trace.trace, frame.rays->launch);
        barrier(commands);
        dispatch_indirect(commands, count, frame.rays->launch);
        barrier(commands);
    });
    return download_as<TraceCounts>(gpu, counts, 1)[0];
}

} // namespace ssrlab
