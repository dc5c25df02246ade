#include "trace/depth_buffer.h"

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

size_t plane_place(glm::ivec2 size_px, glm::ivec2 pixel)
{
    const int first = planes_first(size_px.x, pyramid_rows(pyramid_root(size_px), size_px.y));
    const int place = first + strip_index(pixel.x, pixel.y, planes_rows(size_px.y));
    return static_cast<size_t>(place);
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

Bindings depth_bindings(const DepthBuffer& depth)
{
    uint64_t cells = 0;
    for (int level = 1; level <= pyramid_levels(depth.size_px); ++level)
        cells += pixel_count(level_size(depth.size_px, level));
    constexpr uint64_t word = sizeof(uint32_t), cell = 2 * word, pair = 2 * cell;
    const uint64_t     pixels_bytes = word * pixel_count(depth.size_px), cells_bytes = cell * cells;
    const Buffer&      all = depth.cells;
    return {{"depth_words", {all, depth.words, {all.id, pixels_bytes, word}}},
            {"depth_cells", {all, all.texels, {all.id, pixels_bytes, cell}}},
            {"cell_pairs", {all, depth.pairs, {all.id, pixels_bytes, pair}}},
            {"StoredCells", {all, depth.pairs, {depth.cells_id, cells_bytes, pair}}},
            {"StoredCell", {all, all.texels, {depth.cells_id, cells_bytes, cell}}}};
}

size_t depth_buffer_bytes(glm::ivec2 size_px)
{
    const int first  = planes_first(size_px.x, pyramid_rows(pyramid_root(size_px), size_px.y));
    const int rows   = planes_rows(size_px.y);
    const int texels = first + strip_index(((size_px.x - 1) >> STRIP_BITS) << STRIP_BITS, rows, rows);
    return static_cast<size_t>(texels) * sizeof(glm::uvec2);
}

DepthBuffer make_depth_buffer(Gpu& gpu, glm::ivec2 size_px)
{
    DepthBuffer depth;
    depth.size_px  = size_px;
    depth.cells    = make_texel_buffer(gpu, depth_buffer_bytes(size_px), vk::Format::eR32G32Uint);
    depth.words    = make_texel_view(gpu, depth.cells, vk::Format::eR32Sfloat);
    depth.pairs    = make_texel_view(gpu, depth.cells, vk::Format::eR32G32B32A32Uint);
    depth.cells_id = new_storage_id(gpu);
    submit(gpu, [&](const Commands& commands) {
        commands.fillBuffer(*depth.cells.buffer, 0, VK_WHOLE_SIZE, std::bit_cast<uint32_t>(background));
    });
    return depth;
}

void write_depth(Gpu& gpu, DepthBuffer& buffer, std::span<const float> depth, std::span<const uint32_t> gradients)
{
    std::vector<uint32_t> words(buffer.cells.bytes / sizeof(uint32_t), std::bit_cast<uint32_t>(background));
    for (int y = 0; y < buffer.size_px.y; ++y)
        for (int x = 0; x < buffer.size_px.x; ++x) {
            const size_t i = pixel_index({x, y}, buffer.size_px), plane = 2 * plane_place(buffer.size_px, {x, y});
            words[depth_word(buffer.size_px, {x, y})] = words[plane] = std::bit_cast<uint32_t>(depth[i]);
            words[plane + 1]                                         = gradients.empty() ? 0 : gradients[i];
        }
    upload(gpu, buffer.cells, words.data(), words.size() * sizeof(uint32_t));
}

std::vector<float> read_depth(Gpu& gpu, const DepthBuffer& buffer)
{
    const auto         words = download_as<float>(gpu, buffer.cells, 2 * pixel_count(pyramid_size(buffer.size_px)));
    std::vector<float> depth;
    depth.reserve(pixel_count(buffer.size_px));
    for (int y = 0; y < buffer.size_px.y; ++y)
        for (int x = 0; x < buffer.size_px.x; ++x) depth.push_back(words[depth_word(buffer.size_px, {x, y})]);
    return depth;
}

} // namespace ssrlab
