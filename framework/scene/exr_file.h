// EXR files, channel by channel, all parts, with the names of the file. Uses OpenImageIO.
#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace ssrlab {

struct ExrChannel {
    std::string name; // in a file of several parts PART.CHANNEL, unless the channel's own name begins so
    int         part    = 0;
    int         index   = 0;
    bool        is_half = false;
};

struct ExrFile {
    std::filesystem::path              path;
    std::string                        shown; // the path as messages show it
    glm::ivec2                         size_px{0, 0};
    std::vector<ExrChannel>            channels;
    std::map<std::string, std::string> attributes; // those that are text, of the first part
};

/// Reads the header. Throws SpecError if missing, Failure if damaged, cropped, deep, or of several sizes.
ExrFile open_exr(const std::filesystem::path& path);

/// Reads the values of a channel, row by row from the top. Throws Failure.
std::vector<float> read_channel(const ExrFile& file, const ExrChannel& channel);

} // namespace ssrlab
