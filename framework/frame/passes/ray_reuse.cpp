// Gloss by rays drawn from the lobe of each pixel, each used by its neighbours, too.
#include "core/error.h"
#include "frame/passes/pass_helpers.h"

namespace ssrlab {
namespace {

PassDecision decide(const FrameFacts& /*facts*/, const FrameStatistics& statistics, const ParameterValues& values)
{
    if (choice<Gloss>(values) != Gloss::stochastic) return {PassDecision::off, "gloss is not stochastic"};
    return needed_if_anything_is_rough(statistics);
}

RecordFunction prepare(Gpu& gpu, PreparedFrame& frame)
{
    auto reuse = std::make_shared<ComputePass>(
        make_pass(gpu, frame, "passes/ray_reuse.comp", {}, lobe_ray_bindings(gpu, frame)));
    auto dense = make_shared_pass(gpu, frame, "passes/reuse_filter.comp", {{"DENSE", "1"}});
    auto wide  = make_shared_pass(gpu, frame, "passes/reuse_filter.comp");
    return [&frame, reuse, dense, wide](const auto& commands) {
        record_clear_reflection(commands, frame.buffers->filtered); // of tiles that are not listed
        dispatch_indirect(commands, *reuse, frame.buffers->tiles.launch);
        barrier(commands);
        dispatch_indirect(commands, *dense, frame.buffers->tiles.launch);
        barrier(commands);
        record_copy(commands, frame.buffers->reflection, frame.buffers->filtered);
        barrier(commands);
        dispatch_indirect(commands, *wide, frame.buffers->tiles.launch);
    };
}

} // namespace

Pass ray_reuse_pass()
{
    return {
        .id      = "ray_reuse",
        .summary = "Makes each rough pixel's reflection of its own and its neighbours' rays, weighted by its BRDF, and "
                   "filters them",
        .cite    = {"T. Stachowiak 2015, Stochastic Screen-Space Reflections (SIGGRAPH)"},
        .parameters     = {integer_parameter("reuse_neighbours", 32, 1, 256,
                                             "pixels whose rays a rough pixel uses, itself among them"),
                           real_parameter("reuse_radius", 0.15, 0, 1,
                                          "radius of these pixels' disk at roughness 1, as a share of the image's height"),
                           real_parameter(
                               "reuse_depth_tolerance", 0.001, 1e-6, 1e6,
                               "distance from the pixel's plane, as a share of the view distance, at which another "
                                   "pixel's rays weigh 1/e")},
        .decide         = decide,
        .prepare        = prepare,
        .beyond_shading = true};
}

Bindings lobe_ray_bindings(Gpu& gpu, const PreparedFrame& frame)
{
    FrameBuffers&    buffers = *frame.buffers;
    const int        rays    = static_cast<int>(frame.settings.passes.at("rays_per_pixel"));
    const glm::ivec2 size_px = buffers.gbuffer->view.size_px * glm::ivec2(1, rays);
    if (size_px.y > MAX_IMAGE_PX)
        throw_spec_error("rays_per_pixel = {} with gloss = stochastic: at most {} at this image's height", rays,
                         MAX_IMAGE_PX / buffers.gbuffer->view.size_px.y);
    std::shared_ptr<LobeRayImages>& images = buffers.lobe_rays[rays];
    if (!images) {
        const auto image = [&](vk::Format format) {
            return make_image(gpu, {.format = format, .size_px = size_px, .usage = vk::ImageUsageFlagBits::eStorage});
        };
        images = std::make_shared<LobeRayImages>(LobeRayImages{
            rays > 1 ? image(vk::Format::eR16G16B16A16Sfloat) : GpuImage{}, image(vk::Format::eR32G32B32A32Sfloat)});
    }
    return {{"ray_light_image", rays > 1 ? images->light : buffers.reflection}, {"ray_end_image", images->end}};
}

} // namespace ssrlab
