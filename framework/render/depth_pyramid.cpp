#include "render/depth_pyramid.h"

#include "core/pixel_index.h"
#include "shared.h"

#include <algorithm>

namespace ssrlab {
namespace {

/// 2^bits covers the number.
int bits_of(int number)
{
    int bits = 0;
    while ((1 << bits) < number) ++bits;
    return bits;
}

size_t depth_word(glm::ivec2 size_px, glm::ivec2 pixel)
{
    return 2 * cell_index(size_px, pixel, 0) + static_cast<size_t>(pixel.x % 2);
}

} // namespace

size_t cell_index(glm::ivec2 size_px, glm::ivec2 cell, int level)
{
    const int x = level == 0 ? cell.x / 2 : cell.x;
    return static_cast<size_t>(strip_index(x, level_row(size_px.y, level) + cell.y, pyramid_rows(size_px.y)));
}

glm::ivec2 level_size(glm::ivec2 size_px, int level) { return ((size_px - 1) >> level) + 1; }

PyramidAtlas pyramid_atlas(glm::ivec2 size_px)
{
    const int levels = bits_of(std::max(size_px.x, size_px.y));
    return {{level_size(size_px, STRIP_BITS + 1).x << STRIP_BITS, pyramid_rows(size_px.y)}, levels};
}

DepthPyramid make_depth_pyramid(Gpu& gpu, glm::ivec2 size_px)
{
    const size_t texels = pixel_count(pyramid_atlas(size_px).size);
    DepthPyramid pyramid;
    pyramid.size_px = size_px;
    pyramid.cells   = make_texel_buffer(gpu, texels * sizeof(glm::uvec2), vk::Format::eR32G32Uint);
    pyramid.words   = make_texel_view(gpu, pyramid.cells, vk::Format::eR32Sfloat);
    pyramid.pairs   = make_texel_view(gpu, pyramid.cells, vk::Format::eR32G32B32A32Uint);
    return pyramid;
}

void write_depth(Gpu& gpu, DepthPyramid& pyramid, std::span<const float> depth)
{
    std::vector<float> words(2 * pixel_count(pyramid_atlas(pyramid.size_px).size));
    for (int y = 0; y < pyramid.size_px.y; ++y)
        for (int x = 0; x < pyramid.size_px.x; ++x)
            words[depth_word(pyramid.size_px, {x, y})] = depth[pixel_index({x, y}, pyramid.size_px)];
    upload(gpu, pyramid.cells, words.data(), words.size() * sizeof(float));
}

std::vector<float> read_depth(Gpu& gpu, const DepthPyramid& pyramid)
{
    const auto words = download_as<float>(gpu, pyramid.cells, 2 * pixel_count(pyramid_atlas(pyramid.size_px).size));
    std::vector<float> depth;
    depth.reserve(pixel_count(pyramid.size_px));
    for (int y = 0; y < pyramid.size_px.y; ++y)
        for (int x = 0; x < pyramid.size_px.x; ++x) depth.push_back(words[depth_word(pyramid.size_px, {x, y})]);
    return depth;
}

} // namespace ssrlab
