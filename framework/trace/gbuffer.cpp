#include "trace/gbuffer.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "core/plane_gradient.h"
#include "shared.h"

#include <glm/gtc/packing.hpp>

#include <fmt/format.h>

#include <cmath>

namespace ssrlab {
namespace {

/// shaders/api/view.glsl, uniform View, scalar layout.
template <typename Real> struct ViewBlock {
    glm::ivec2        size_px;
    glm::vec<2, Real> focal_px, centre_px, focal_low_px, centre_low_px;
    Real              near_m, far_m;
};

template <typename Real> void write_view_as(Gpu& gpu, Buffer& target, const View& view)
{
    using Real2 = glm::vec<2, Real>;
    const Real2           focal_px(view.focal_px), centre_px(view.centre_px);
    const ViewBlock<Real> block{view.size_px,
                                focal_px,
                                centre_px,
                                Real2(view.focal_px - glm::dvec2(focal_px)),
                                Real2(view.centre_px - glm::dvec2(centre_px)),
                                static_cast<Real>(view.near_m),
                                static_cast<Real>(view.far_m)};
    upload(gpu, target, &block, sizeof(block));
}

using HalfTexel = std::array<uint16_t, 4>;

HalfTexel to_half(glm::vec4 v)
{
    return {glm::packHalf1x16(v.x), glm::packHalf1x16(v.y), glm::packHalf1x16(v.z), glm::packHalf1x16(v.w)};
}

glm::vec4 from_half(const HalfTexel& h)
{
    return {glm::unpackHalf1x16(h[0]), glm::unpackHalf1x16(h[1]), glm::unpackHalf1x16(h[2]), glm::unpackHalf1x16(h[3])};
}

TileBuffers make_tile_buffers(Gpu& gpu, glm::ivec2 size_px)
{
    const glm::uvec3 tiles     = groups_of_8(size_px);
    const auto       two_words = [&] {
        return make_texel_buffer(gpu, static_cast<uint64_t>(tiles.x) * tiles.y * sizeof(glm::uvec2),
                                       vk::Format::eR32Uint);
    };
    const glm::uvec4 none(0);
    return {two_words(), make_buffer_with<glm::uvec4>(gpu, std::span(&none, 1)), two_words(), make_buffer(gpu, 16),
            make_buffer(gpu, sizeof(GBufferCounts))};
}

} // namespace

GBufferPtr make_gbuffer(Gpu& gpu, const View& view, Filled filled)
{
    if (view.size_px.x > MAX_IMAGE_PX || view.size_px.y > MAX_IMAGE_PX)
        throw_spec_error("image size {}x{} is outside 1x1 to {}x{}", view.size_px.x, view.size_px.y, MAX_IMAGE_PX,
                         MAX_IMAGE_PX);
    using Format     = vk::Format;
    auto gbuffer     = std::make_shared<GBuffer>();
    gbuffer->view    = view;
    const auto image = [&](Format format) {
        using Usage      = vk::ImageUsageFlagBits;
        const auto usage = filled == Filled::drawn ? Usage::eColorAttachment | Usage::eStorage : Usage::eStorage;
        return make_image(gpu, {.format = format, .size_px = view.size_px, .usage = usage});
    };
    gbuffer->view_uniforms = upload_view(gpu, view, NumberFormat::float32);
    gbuffer->tiles         = make_tile_buffers(gpu, view.size_px);
    gbuffer->depth         = make_depth_buffer(gpu, view.size_px);
    gbuffer->normal        = image(Format::eR32G32B32A32Sfloat);
    gbuffer->material      = image(Format::eR16G16B16A16Sfloat);
    gbuffer->dielectric    = image(Format::eR32Sfloat);
    gbuffer->radiance      = image(Format::eR16G16B16A16Sfloat);
    gbuffer->highlight     = image(Format::eR16G16B16A16Sfloat);
    gbuffer->emission      = image(Format::eR16G16B16A16Sfloat);
    gbuffer->object        = image(Format::eR32Uint);
    gbuffer->gradient      = image(Format::eR32Uint);
    gbuffer->solid         = image(Format::eR32Sfloat);
    return gbuffer;
}

std::vector<float> usable_depth(std::span<const float> depth)
{
    std::vector<float> clean(depth.begin(), depth.end());
    for (float& d : clean)
        if (!(d > 0 && d <= 1)) d = static_cast<float>(BACKGROUND_DEPTH);
    return clean;
}

void upload_surfaces(Gpu& gpu, GBuffer& gbuffer, const GBufferImage& image)
{
    const size_t count = image.depth.size();
    if (count != pixel_count(image.view.size_px))
        throw std::logic_error("upload_surfaces: depth does not match the view's size");
    std::vector<glm::vec4> normal(count);
    std::vector<HalfTexel> material(count);
    std::vector<float>     dielectric(count);
    for (size_t i = 0; i < count; ++i) {
        normal[i]     = {image.normal_vs[i], image.roughness[i]};
        material[i]   = to_half({image.base_colour[i], image.metallic[i]});
        dielectric[i] = dielectric_f0_at(image, i);
    }
    GBufferImage planes;
    planes.view      = image.view;
    planes.depth     = image.depth;
    planes.normal_vs = image.normal_vs;
    planes.gradient  = image.gradient;
    complete_gradients(planes);
    const std::vector<float> depth = usable_depth(image.depth);
    // Background is level, as shaders/gbuffer/background.comp draws it: without a plane it would have a slab, which may end nearer than everything.
    std::vector<uint32_t> gradients;
    for (size_t i = 0; i < count; ++i) gradients.push_back(depth[i] > 0 ? pack_gradient(planes.gradient[i]) : 0);
    std::vector<float> solid = image.solid_back;
    solid.resize(count);
    upload(gpu, gbuffer.gradient, gradients.data(), count * sizeof(uint32_t));
    upload(gpu, gbuffer.solid, solid.data(), count * sizeof(float));
    write_depth(gpu, gbuffer.depth, depth, gradients);
    upload(gpu, gbuffer.normal, normal.data(), count * sizeof(glm::vec4));
    upload(gpu, gbuffer.material, material.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer.dielectric, dielectric.data(), count * sizeof(float));
    for (size_t i = 0; i < std::min(gbuffer.layers.size(), image.layers.size()); ++i)
        upload_surfaces(gpu, *gbuffer.layers[i], image.layers[i]);
}

GBufferPtr upload_gbuffer(Gpu& gpu, const GBufferImage& image)
{
    GBufferPtr gbuffer = make_gbuffer(gpu, image.view, Filled::uploaded);
    upload_surfaces(gpu, *gbuffer, image);
    const size_t           count = image.depth.size();
    std::vector<HalfTexel> radiance(count), highlight(count), emission(count);
    for (size_t i = 0; i < count; ++i) {
        radiance[i]  = to_half({image.radiance[i], 1});
        highlight[i] = to_half({image.highlight[i], 1});
        emission[i]  = to_half({emission_at(image, i), diffuse_share_at(image, i)});
    }
    upload(gpu, gbuffer->radiance, radiance.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer->highlight, highlight.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer->emission, emission.data(), count * sizeof(HalfTexel));
    upload(gpu, gbuffer->object, image.object_id.data(), count * sizeof(uint32_t));
    for (const GBufferImage& layer : image.layers) gbuffer->layers.push_back(upload_gbuffer(gpu, layer));
    return gbuffer;
}

GBufferImage read_gbuffer(Gpu& gpu, const GBuffer& gbuffer)
{
    GBufferImage image;
    image.view = gbuffer.view;
    for (const float depth : read_depth(gpu, gbuffer.depth)) image.depth.push_back(depth > 0 ? depth : 0.0F);
    for (const glm::vec4& texel : download_as<glm::vec4>(gpu, gbuffer.normal)) {
        image.normal_vs.emplace_back(texel);
        image.roughness.push_back(texel.w);
    }
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.material)) {
        image.base_colour.emplace_back(from_half(texel));
        image.metallic.push_back(from_half(texel).w);
    }
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.radiance))
        image.radiance.emplace_back(from_half(texel));
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.highlight))
        image.highlight.emplace_back(from_half(texel));
    for (const HalfTexel& texel : download_as<HalfTexel>(gpu, gbuffer.emission)) {
        image.emission.emplace_back(from_half(texel));
        image.diffuse_share.push_back(from_half(texel).w);
    }
    image.object_id = download_as<uint32_t>(gpu, gbuffer.object);
    for (const uint32_t packed : download_as<uint32_t>(gpu, gbuffer.gradient))
        image.gradient.push_back(unpack_gradient(packed));
    image.solid_back    = download_as<float>(gpu, gbuffer.solid);
    image.dielectric_f0 = download_as<float>(gpu, gbuffer.dielectric);
    if (gbuffer.motion_px) image.motion_px = download_as<glm::vec2>(gpu, *gbuffer.motion_px);
    for (const GBufferPtr& layer : gbuffer.layers) image.layers.push_back(read_gbuffer(gpu, *layer));
    return image;
}

GBufferPtr upload_depth(Gpu& gpu, const View& view, std::span<const float> depth)
{
    auto gbuffer           = std::make_shared<GBuffer>();
    gbuffer->view          = view;
    gbuffer->view_uniforms = upload_view(gpu, view, NumberFormat::float32);
    gbuffer->tiles         = make_tile_buffers(gpu, view.size_px);
    gbuffer->depth         = make_depth_buffer(gpu, view.size_px);
    gbuffer->normal        = make_storage_image(gpu, vk::Format::eR32G32B32A32Sfloat, {1, 1});
    gbuffer->material      = make_storage_image(gpu, vk::Format::eR16G16B16A16Sfloat, {1, 1});
    gbuffer->dielectric    = make_storage_image(gpu, vk::Format::eR32Sfloat, {1, 1});
    gbuffer->solid         = make_storage_image(gpu, vk::Format::eR32Sfloat, {1, 1});
    write_depth(gpu, gbuffer->depth, usable_depth(depth), {});
    return gbuffer;
}

Bindings surface_bindings(const GBuffer& gbuffer)
{
    Bindings bindings = depth_bindings(gbuffer.depth);
    bindings.insert({{"normal_image", gbuffer.normal},
                     {"material_image", gbuffer.material},
                     {"dielectric_image", gbuffer.dielectric},
                     {"solid_image", gbuffer.solid}});
    add_layers(bindings, gbuffer.layers);
    return bindings;
}

void add_layers(Bindings& bindings, std::span<const GBufferPtr> layers)
{
    for (size_t i = 0; i < layers.size(); ++i) {
        const GBuffer& layer = *layers[i];
        const auto     name  = [&](const char* what) { return fmt::format("layer_{}_{}", i + 1, what); };
        const Bindings depth = depth_bindings(layer.depth);
        bindings.insert({{name("cells"), depth.at("depth_cells")},
                         {name("depth_words"), depth.at("depth_words")},
                         {name("normal_image"), layer.normal},
                         {name("material_image"), layer.material},
                         {name("radiance_image"), layer.radiance},
                         {name("highlight_image"), layer.highlight},
                         {name("object_image"), layer.object},
                         {name("dielectric_image"), layer.dielectric},
                         {name("solid_image"), layer.solid}});
    }
}

void write_view(Gpu& gpu, Buffer& target, const View& view, NumberFormat number_format)
{
    if (number_format == NumberFormat::float64)
        write_view_as<double>(gpu, target, view);
    else
        write_view_as<float>(gpu, target, view);
}

Buffer upload_view(Gpu& gpu, const View& view, NumberFormat number_format)
{
    Buffer buffer = make_buffer(gpu, sizeof(ViewBlock<double>));
    write_view(gpu, buffer, view, number_format);
    return buffer;
}

} // namespace ssrlab
