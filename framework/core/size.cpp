#include "core/size.h"

#include <charconv>

namespace ssrlab {

std::optional<glm::ivec2> parse_size(std::string_view text)
{
    glm::ivec2  size_px{0, 0};
    const char* end   = text.data() + text.size();
    const auto  width = std::from_chars(text.data(), end, size_px.x);
    if (width.ec != std::errc() || width.ptr == end || *width.ptr != 'x') return std::nullopt;
    const auto height = std::from_chars(width.ptr + 1, end, size_px.y);
    if (height.ec != std::errc() || height.ptr != end) return std::nullopt;
    return size_px;
}

} // namespace ssrlab
