// Indices of pixels in row-major images.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>

namespace ssrlab {

inline size_t pixel_count(glm::ivec2 size_px)
{
    return static_cast<size_t>(size_px.x) * static_cast<size_t>(size_px.y);
}

inline size_t pixel_index(glm::ivec2 pixel, glm::ivec2 size_px)
{
    return static_cast<size_t>(pixel.y) * static_cast<size_t>(size_px.x) + static_cast<size_t>(pixel.x);
}

/// Returns the pixel of an index.
inline glm::ivec2 pixel_at(size_t index, glm::ivec2 size_px)
{
    const auto width = static_cast<size_t>(size_px.x);
    return {static_cast<int>(index % width), static_cast<int>(index / width)};
}

} // namespace ssrlab
