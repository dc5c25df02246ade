// EXR files, channel by channel, all parts, with the names of the file. Uses OpenImageIO.
#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ssrlab {

struct ExrChannel {
    std::string name; // PART.CHANNEL in a file of several parts, unless the channel's own name begins with PART.
    int         part    = 0;
    int         index   = 0;
    bool        is_half = false;
    bool        is_uint = false;
};

/// The pixels that a part holds, from the picture's upper left corner. They may extend beyond the picture (overscan),
/// or cover only some of it.
struct ExrWindow {
    glm::ivec2 from_px{0, 0}, size_px{0, 0};

    bool has(glm::ivec2 pixel) const
    {
        const glm::ivec2 at = pixel - from_px;
        return at.x >= 0 && at.y >= 0 && at.x < size_px.x && at.y < size_px.y;
    }
    bool is_whole(glm::ivec2 picture_px) const { return from_px == glm::ivec2(0) && size_px == picture_px; }
};

struct ExrFile {
    std::filesystem::path              path;
    std::string                        shown;         // the path as messages show it
    glm::ivec2                         size_px{0, 0}; // of the picture: the display window
    std::vector<ExrWindow>             windows;       // by part
    std::vector<ExrChannel>            channels;
    std::map<std::string, std::string> attributes;           // those that are text, of the first part
    double                             pixel_aspect = 1;     // a pixel's width by its height
    bool other_primaries                            = false; // its colours are said to be others than those of Rec. 709
};

/// Reads the header. Throws SpecError if missing, Failure if damaged, deep, of several sizes, or without a pixel inside
/// its picture.
ExrFile open_exr(const std::filesystem::path& path);

/// Returns the warning about a file of other primaries.
std::string other_primaries_text(const ExrFile& file);

/// Reads the values of a channel for the whole picture, row by row from the top; 0 where the file has none. Throws
/// Failure.
std::vector<float> read_channel(const ExrFile& file, const ExrChannel& channel);

} // namespace ssrlab
