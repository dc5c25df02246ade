#include "render/depth_pyramid.h"

#include "core/pixel_index.h"

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

/// Level 0 in words.
glm::ivec2 words_of(const DepthPyramid& pyramid) { return pixel_pairs(pyramid.size_px) * glm::ivec2(2, 1); }

} // namespace

glm::ivec2 level_size(glm::ivec2 size_px, int level) { return ((size_px - 1) >> level) + 1; }

PyramidAtlas pyramid_atlas(glm::ivec2 size_px)
{
    PyramidAtlas atlas;
    atlas.levels  = bits_of(std::max(size_px.x, size_px.y));
    atlas.stacked = size_px.y > size_px.x;
    atlas.size    = atlas.stacked ? glm::ivec2(1 << bits_of(pixel_pairs(size_px).x), 1 << atlas.levels)
                                  : glm::ivec2(1 << atlas.levels, level_size(size_px, 1).y);
    return atlas;
}

glm::ivec2 PyramidAtlas::first_cell(int level) const
{
    const int side = stacked ? size.y : size.x, first = side - (side >> (level - 1));
    return stacked ? glm::ivec2(0, first) : glm::ivec2(first, 0);
}

glm::ivec2 pixel_pairs(glm::ivec2 size_px)
{
    return 2 * glm::ivec2(level_size(size_px, 2).x, level_size(size_px, 1).y);
}

DepthPyramid make_depth_pyramid(Gpu& gpu, glm::ivec2 size_px)
{
    const size_t texels = pixel_count(pixel_pairs(size_px)) + pixel_count(pyramid_atlas(size_px).size);
    DepthPyramid pyramid;
    pyramid.size_px = size_px;
    pyramid.cells   = make_texel_buffer(gpu, texels * sizeof(glm::uvec2), vk::Format::eR32G32Uint);
    pyramid.words   = make_texel_view(gpu, pyramid.cells, vk::Format::eR32Sfloat);
    pyramid.pairs   = make_texel_view(gpu, pyramid.cells, vk::Format::eR32G32B32A32Uint);
    return pyramid;
}

void write_depth(Gpu& gpu, DepthPyramid& pyramid, std::span<const float> depth)
{
    const glm::ivec2   words = words_of(pyramid);
    std::vector<float> rows(pixel_count(words));
    for (int y = 0; y < pyramid.size_px.y; ++y)
        std::ranges::copy(depth.subspan(pixel_index({0, y}, pyramid.size_px), static_cast<size_t>(pyramid.size_px.x)),
                          rows.begin() + static_cast<ptrdiff_t>(pixel_index({0, y}, words)));
    upload(gpu, pyramid.cells, rows.data(), rows.size() * sizeof(float));
}

std::vector<float> read_depth(Gpu& gpu, const DepthPyramid& pyramid)
{
    const glm::ivec2   words = words_of(pyramid);
    const auto         rows  = download_as<float>(gpu, pyramid.cells, pixel_count(words));
    std::vector<float> depth;
    depth.reserve(pixel_count(pyramid.size_px));
    for (int y = 0; y < pyramid.size_px.y; ++y) {
        const auto row = rows.begin() + static_cast<ptrdiff_t>(pixel_index({0, y}, words));
        depth.insert(depth.end(), row, row + pyramid.size_px.x);
    }
    return depth;
}

} // namespace ssrlab
