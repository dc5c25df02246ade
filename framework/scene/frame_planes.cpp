#include "scene/frame_planes.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "scene/frame_channels.h"

#include <algorithm>

namespace ssrlab {
namespace {

FramePlane read_plane(const ExrFile& file, const ExrChannel& channel)
{
    return {fmt::format("{}: channel '{}'", file.shown, channel.name), channel.name, read_channel(file, channel),
            channel.is_half, file.windows[static_cast<size_t>(channel.part)]};
}

std::string channel_names(const ExrFile& file)
{
    std::string names;
    for (const ExrChannel& channel : file.channels) names += (names.empty() ? "" : ", ") + channel.name;
    return names;
}

/// "CHANNEL" or "FILE:CHANNEL", as the convention's file says.
FramePlane read_named(const FrameSource& source, const std::string& quantity, const std::string& text)
{
    const size_t  colon = text.rfind(':');
    const ExrFile other =
        colon == std::string::npos ? source.file : open_exr(source.file.path.parent_path() / text.substr(0, colon));
    const std::string name  = colon == std::string::npos ? text : text.substr(colon + 1);
    const auto        found = std::ranges::find(other.channels, name, &ExrChannel::name);
    if (found == other.channels.end())
        throw_spec_error("{}: [channels] {}: {} has no channel '{}'; it has {}", source.convention.place, quantity,
                         other.shown, name, channel_names(other));
    if (other.size_px != source.file.size_px)
        throw_spec_error("{}: {}x{} pixels, expected {}x{} as {} has", other.shown, other.size_px.x, other.size_px.y,
                         source.file.size_px.x, source.file.size_px.y, source.file.shown);
    return read_plane(other, *found);
}

} // namespace

std::optional<FramePlane> find_plane(const FrameSource& source, const std::string& quantity)
{
    const auto& given = source.convention.channels;
    if (const auto named = given.find(quantity); named != given.end())
        return read_named(source, quantity, named->second);
    if (const auto value = source.convention.values.find(quantity); value != source.convention.values.end())
        return FramePlane{source.convention.place, quantity,
                          std::vector<float>(pixel_count(source.file.size_px), static_cast<float>(value->second)),
                          false, ExrWindow{{0, 0}, source.file.size_px}};
    const auto found = find_quantity(source.file.channels, quantity);
    if (found.empty()) return std::nullopt;
    if (found.size() > 1)
        throw_spec_error("{}: channels '{}' and '{}' could both be {}: name one in {}, [channels]", source.file.shown,
                         found[0].name, found[1].name, quantity, source.convention.place);
    return read_plane(source.file, found[0]);
}

FramePlane need_plane(const FrameSource& source, const std::string& quantity, const char* elsewhere)
{
    if (auto plane = find_plane(source, quantity)) return std::move(*plane);
    throw_spec_error("{}: no channel is recognised as {}: name it in {}, [channels]{}; the file has {}",
                     source.file.shown, quantity, source.convention.place, elsewhere, channel_names(source.file));
}

void clear_outside(FrameSource& source, const FramePlane& plane)
{
    if (plane.window.is_whole(source.file.size_px)) return;
    GBufferImage& gbuffer = source.frame.gbuffer;
    for (size_t i = 0; i < gbuffer.depth.size(); ++i) {
        if (plane.window.has(pixel_at(i, source.file.size_px))) continue;
        gbuffer.depth[i] = 0;
        if (!gbuffer.normal_vs.empty()) gbuffer.normal_vs[i] = glm::vec3(0);
        if (!gbuffer.roughness.empty()) gbuffer.roughness[i] = 0;
    }
}

[[noreturn]] void refuse(const FrameSource& source, const FramePlane& plane, size_t i, const char* expected)
{
    const glm::ivec2 pixel = pixel_at(i, source.file.size_px);
    throw_spec_error("{}: expected {}, got {} at pixel {},{}", plane.shown, expected, plane.values[i], pixel.x,
                     pixel.y);
}

} // namespace ssrlab
