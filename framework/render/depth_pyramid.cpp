#include "render/depth_pyramid.h"

#include "core/pixel_index.h"
#include "shared.h"

#include <bit>

namespace ssrlab {
namespace {

constexpr auto background = static_cast<float>(BACKGROUND_DEPTH);

size_t depth_word(glm::ivec2 size_px, glm::ivec2 pixel)
{
    return 2 * cell_index(size_px, pixel, 0) + static_cast<size_t>(pixel.x % 2);
}

} // namespace

int pyramid_levels(glm::ivec2 size_px) { return std::bit_width(static_cast<unsigned>(size_px.y - 1)); }

int pyramid_root(glm::ivec2 size_px) { return 1 << pyramid_levels(size_px); }

glm::ivec2 pyramid_size(glm::ivec2 size_px)
{
    return {level_size(size_px, STRIP_BITS + 1).x << STRIP_BITS, pyramid_rows(pyramid_root(size_px), size_px.y)};
}

size_t cell_index(glm::ivec2 size_px, glm::ivec2 pixel, int level)
{
    const int root = pyramid_root(size_px);
    return static_cast<size_t>(pixel_to_cell_index(pixel.x, pixel.y, level, root, pyramid_rows(root, size_px.y)));
}

glm::ivec2 level_size(glm::ivec2 size_px, int level) { return ((size_px - 1) >> level) + 1; }

DepthPyramid make_depth_pyramid(Gpu& gpu, glm::ivec2 size_px)
{
    const size_t texels = pixel_count(pyramid_size(size_px));
    DepthPyramid pyramid;
    pyramid.size_px      = size_px;
    pyramid.cells        = make_texel_buffer(gpu, texels * sizeof(glm::uvec2), vk::Format::eR32G32Uint);
    pyramid.words        = make_texel_view(gpu, pyramid.cells, vk::Format::eR32Sfloat);
    pyramid.pairs        = make_texel_view(gpu, pyramid.cells, vk::Format::eR32G32B32A32Uint);
    pyramid.patch_planes = make_texel_buffer(gpu, pixel_count(level_size(size_px, PATCH_BITS)) * 4 * sizeof(float),
                                             vk::Format::eR32G32B32A32Sfloat);
    submit(gpu, [&](const vk::raii::CommandBuffer& commands) {
        commands.fillBuffer(*pyramid.cells.buffer, 0, VK_WHOLE_SIZE, std::bit_cast<uint32_t>(background));
    });
    return pyramid;
}

void write_depth(Gpu& gpu, DepthPyramid& pyramid, std::span<const float> depth)
{
    std::vector<float> words(2 * pixel_count(pyramid_size(pyramid.size_px)), background);
    for (int y = 0; y < pyramid.size_px.y; ++y)
        for (int x = 0; x < pyramid.size_px.x; ++x)
            words[depth_word(pyramid.size_px, {x, y})] = depth[pixel_index({x, y}, pyramid.size_px)];
    upload(gpu, pyramid.cells, words.data(), words.size() * sizeof(float));
}

std::vector<float> read_depth(Gpu& gpu, const DepthPyramid& pyramid)
{
    const auto         words = download_as<float>(gpu, pyramid.cells, 2 * pixel_count(pyramid_size(pyramid.size_px)));
    std::vector<float> depth;
    depth.reserve(pixel_count(pyramid.size_px));
    for (int y = 0; y < pyramid.size_px.y; ++y)
        for (int x = 0; x < pyramid.size_px.x; ++x) depth.push_back(words[depth_word(pyramid.size_px, {x, y})]);
    return depth;
}

} // namespace ssrlab
