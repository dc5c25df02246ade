// Gloss by cones: the pyramids in which rough surfaces look up colours, in place of single pixels.
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

/// The levels above 0, at the rows of the depth pyramid.
GpuImage make_cone_image(Gpu& gpu, glm::ivec2 size_px, vk::Format format)
{
    const glm::ivec2 finest = level_size(size_px, 1);
    return make_storage_image(gpu, format, {finest.x, pyramid_root(size_px) / 2 + finest.y});
}

/// shaders/passes/cone_pyramid.comp
struct ConePush {
    glm::ivec2 source_size, size;
    int        row = 0; // where the level begins
};

void make_cone_pyramid(Gpu& gpu, FrameBuffers& buffers)
{
    if (buffers.cone) return;
    const glm::ivec2 size_px = buffers.gbuffer->view.size_px;
    buffers.cone             = std::make_shared<ConePyramid>();
    buffers.cone->cells      = make_cone_image(gpu, size_px, vk::Format::eR16G16B16A16Sfloat);
    buffers.cone->ranges     = make_cone_image(gpu, size_px, vk::Format::eR32G32Sfloat);
}

PassDecision decide(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<Gloss>(values) != Gloss::cone) return {PassDecision::off, "gloss is not cone"};
    return needed_if_anything_is_rough(statistics);
}

RecordFunction prepare(Gpu& gpu, const PassContext& context)
{
    make_cone_pyramid(gpu, *context.frame.buffers);
    const auto make = [&](const Defines& defines) {
        return std::make_shared<ComputePass>(
            make_pass(gpu, context, "passes/cone_pyramid.comp", defines, {}, sizeof(ConePush)));
    };
    const glm::ivec2 size_px = context.frame.lab->gbuffer->view.size_px;
    return [size_px, from_pixels = make({{"FROM_PIXELS", "1"}}), from_cells = make({})](const auto& commands) {
        for (int level = 1; level <= pyramid_levels(size_px); ++level) {
            const ComputePass& pass = level == 1 ? *from_pixels : *from_cells;
            const glm::ivec2   size = level_size(size_px, level);
            push(commands, pass, ConePush{level_size(size_px, level - 1), size, pyramid_root(size_px) >> level});
            dispatch(commands, pass, groups_of_8(size));
            barrier(commands);
        }
    };
}

} // namespace

Pass cone_pyramid_pass()
{
    return {
        .id             = "cone_pyramid",
        .summary        = "Builds the pyramid of colours and visibility in which hit_colour looks up cones",
        .cite           = {"Y. Uludag 2014, Hi-Z Screen-Space Cone-Traced Reflections (GPU Pro 5)"},
        .reads          = {Resource::gbuffer, Resource::light},
        .writes         = {Resource::cones},
        .parameters     = {real_parameter("cone_scale", 0.75, 0, 2,
                                          "factor on the half angle of a cone that the article derives from the roughness"),
                           integer_parameter("cone_steps", 2, 1, 16,
                                             "circles in a cone, from the hit back to the reflector")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

} // namespace ssrlab
