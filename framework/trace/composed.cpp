#include "trace/composed.h"

#include "core/plane_gradient.h"
#include "shared.h"
#include "trace/shader_sources.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

namespace ssrlab {
namespace {

constexpr size_t view_words = 12; // shaders/api/view.glsl

std::string dispatch_rule(const Lab& lab, const StructurePass& pass)
{
    switch (pass.per) {
    case SizeRule::tile: return fmt::format("8 x 8 tiles of {0} x {0} px a workgroup", pass.tile_px);
    case SizeRule::ray_group: return "";
    case SizeRule::level: break;
    default: return "8 x 8 px a workgroup";
    }
    const auto*       name = std::get_if<std::string>(&pass.last_level);
    const int         last = name != nullptr ? static_cast<int>(lab.values.at(*name)) : std::get<int>(pass.last_level);
    const std::string end  = last >= 31 ? "ceil(log2(height))" : fmt::format("min({}, ceil(log2(height)))", last);
    const std::string many =
        fmt::format("levels {} to {}, {} a dispatch", pass.first_level, end, pass.levels_per_dispatch);
    return fmt::format("{}: level and last_level in Push; {} x {} cells of ceil(size / 2^level) a workgroup", many,
                       8 * pass.cells_per_invocation.x, 8 * pass.cells_per_invocation.y);
}

std::string size_rule(const StructureBuffer& buffer)
{
    const std::string each = fmt::format("{} {}", buffer.count, buffer.type);
    switch (buffer.per) {
    case SizeRule::tile: return fmt::format("{0} for each tile of {1} x {1} px", each, buffer.tile_px);
    case SizeRule::cell: return each + " for each of ceil(width / 2) x 2^ceil(log2(height)) cells";
    case SizeRule::ray_group: return fmt::format("{} for each {} rays", each, RAYS_PER_GROUP);
    default: return each + " for each pixel";
    }
}

ComposedPass compose_pass(const Gpu& gpu, const Lab& lab, const Structure& structure, const StructurePass& pass,
                          const RayBuffers& rays)
{
    const StructureDispatch dispatch = dispatches_of(lab, pass);
    return {structure.id,
            build_source(gpu, lab, structure, pass, rays, false),
            build_constants(lab, NumberFormat::float32),
            dispatch.per_ray ? rays_per_workgroup(gpu) : 0,
            dispatch.levels,
            dispatch.groups,
            dispatch_rule(lab, pass)};
}

template <typename T> std::vector<uint32_t> words_of(std::span<const T> values)
{
    std::vector<uint32_t> words(values.size_bytes() / sizeof(uint32_t));
    if (!values.empty()) std::memcpy(words.data(), values.data(), values.size_bytes());
    return words;
}

} // namespace

ComposedLab compose_lab(Gpu& gpu, const Lab& lab, size_t rays)
{
    const RayBuffers buffers = make_ray_buffers(gpu, rays, NumberFormat::float32);
    structure_bindings(gpu, lab.technique, *lab.gbuffer, buffers); // makes the structures' buffers
    ComposedLab composed;
    // First what depends on depth alone, as it is recorded.
    for (const bool per_ray : {false, true})
        for (const Structure& structure : lab.technique.structures)
            for (const StructurePass& pass : passes_on(gpu, structure))
                if ((pass.per == SizeRule::ray_group) == per_ray)
                    composed.passes.push_back(compose_pass(gpu, lab, structure, pass, buffers));
    composed.passes.push_back(
        {"", trace_source(gpu, lab, buffers, {}), trace_constants(gpu, lab, buffers), RAYS_PER_GROUP, {}, {}, ""});
    for (const Structure& structure : lab.technique.structures)
        for (const StructureBuffer& buffer : structure.buffers)
            if (buffer.per != SizeRule::depth_cell)
                composed.buffers.push_back({structure.id, buffer.name,
                                            structure_buffer_bytes(buffer, lab.gbuffer->view.size_px, buffers),
                                            size_rule(buffer)});
    composed.depth_bytes = lab.gbuffer->depth.cells.bytes;
    return composed;
}

ShaderSource compose_shader(const Lab& lab, const std::filesystem::path& file)
{
    ShaderSource source{.file = file};
    add_surface(source, lab.surface, lab.settings.layers);
    return source;
}

Constants compose_constants(const Lab& lab)
{
    return settings_constants(lab.gbuffer->view, lab.settings, NumberFormat::float32);
}

FrameWords read_frame_words(Gpu& gpu, const Lab& lab)
{
    const GBufferImage image = read_gbuffer(gpu, *lab.gbuffer);
    FrameWords         words;
    words.view = download_as<uint32_t>(gpu, lab.gbuffer->view_uniforms, view_words);
    for (const glm::vec2& gradient : image.gradient) words.gradients.push_back(pack_gradient(gradient));
    for (size_t i = 0; i < image.depth.size(); ++i) {
        const glm::vec4 texel(image.normal_vs[i], image.roughness[i]);
        for (int c = 0; c < 4; ++c) words.normals.push_back(std::bit_cast<uint32_t>(texel[c]));
    }
    words.solids = words_of(std::span(image.solid_back));
    return words;
}

std::vector<uint32_t> pack_rays(std::span<const RayInput> rays)
{
    std::vector<PackedRay<float>> packed;
    for (const RayInput& ray : rays)
        packed.push_back({ray.origin_px_depth, static_cast<float>(ray.length_m), ray.delta_px_depth,
                          pack_pixel(ray.pixel, static_cast<int>(ray.end_status))});
    return words_of(std::span<const PackedRay<float>>(packed));
}

std::vector<uint32_t> pack_outcomes(std::span<const RayOutcome> outcomes)
{
    std::vector<PackedHit<float>> packed;
    for (const RayOutcome& outcome : outcomes)
        packed.push_back(
            {pack_pixel(outcome.hit_pixel, status_to_number(static_cast<int>(outcome.status), outcome.hit_layer)),
             static_cast<float>(outcome.t)});
    return words_of(std::span<const PackedHit<float>>(packed));
}

} // namespace ssrlab
