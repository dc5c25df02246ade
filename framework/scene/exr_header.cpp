#include "scene/exr_header.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

namespace ssrlab {
namespace {

constexpr int64_t max_side_px = 16384, max_tile_px = 4096, max_preview_px = 4096;

/// Numbers of the file, least byte first; what is beyond its end is refused.
struct HeaderReader {
    std::ifstream      stream;
    const std::string& shown;
    int64_t            file_bytes = 0;

    int64_t left() { return file_bytes - static_cast<int64_t>(stream.tellg()); }

    int64_t number()
    {
        std::array<unsigned char, 4> bytes{};
        if (!stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size()))
            throw_failure("{}: cut off within its EXR header", shown);
        uint32_t value = 0;
        for (size_t i = 0; i < bytes.size(); ++i) value |= static_cast<uint32_t>(bytes[i]) << (8 * i);
        return static_cast<int32_t>(value);
    }

    std::string text()
    {
        constexpr size_t longest = 255;
        std::string      found;
        for (char c = 0; stream.get(c) && c != 0; found += c)
            if (found.size() == longest) throw_failure("{}: a name of its EXR header has no end", shown);
        if (!stream) throw_failure("{}: cut off within its EXR header", shown);
        return found;
    }
};

void check_side(const HeaderReader& reader, const std::string& name, int64_t side_px, int64_t most_px)
{
    if (side_px < 1 || side_px > most_px)
        throw_failure("{}: '{}' has {} pixels a side, expected 1 to {}", reader.shown, name, side_px, most_px);
}

void check_texts(HeaderReader& reader, const std::string& name, int64_t end)
{
    while (reader.left() > end) {
        const int64_t bytes = reader.number();
        if (bytes < 0 || bytes > reader.left() - end)
            throw_failure("{}: '{}' has a text of {} bytes, which reaches beyond it", reader.shown, name, bytes);
        reader.stream.seekg(bytes, std::ios::cur);
    }
}

/// One attribute; its name was read.
void check_attribute(HeaderReader& reader, const std::string& name)
{
    const std::string type  = reader.text();
    const int64_t     bytes = reader.number();
    if (bytes < 0 || bytes > reader.left())
        throw_failure("{}: '{}' says that it has {} bytes, but {} are left", reader.shown, name, bytes, reader.left());
    const int64_t end = reader.left() - bytes; // bytes of the file after it
    if ((name == "dataWindow" || name == "displayWindow") && bytes >= 16) {
        const int64_t left = reader.number(), top = reader.number(), right = reader.number(), bottom = reader.number();
        const int64_t width = right - left + 1, height = bottom - top + 1;
        if (std::max(width, height) > max_side_px)
            throw_spec_error("{}: {}x{} pixels, at most {} a side can be used", reader.shown, width, height,
                             max_side_px);
        check_side(reader, name, std::min(width, height), max_side_px);
    }
    if (type == "tiledesc" && bytes >= 8)
        for (int axis = 0; axis < 2; ++axis) check_side(reader, name, reader.number(), max_tile_px);
    if (type == "preview" && bytes >= 8)
        for (int axis = 0; axis < 2; ++axis) check_side(reader, name, reader.number(), max_preview_px);
    if (type == "stringvector") check_texts(reader, name, end);
    reader.stream.seekg(reader.file_bytes - end);
}

} // namespace

void check_exr_header(const std::filesystem::path& file, const std::string& shown)
{
    constexpr int64_t magic = 20000630, several_parts = 0x1000;
    std::error_code   error;
    HeaderReader      reader{std::ifstream(file, std::ios::binary), shown, 0};
    reader.file_bytes = static_cast<int64_t>(std::filesystem::file_size(file, error));
    if (!reader.stream || error) throw_failure("{}: cannot be read", shown);
    if (reader.number() != magic) throw_failure("{}: cannot be read as EXR: it does not begin as one", shown);
    const bool several = (reader.number() & several_parts) != 0;
    for (bool first = true; first || several; first = false) {
        std::string name = reader.text();
        if (name.empty()) return; // after the last part
        for (; !name.empty(); name = reader.text()) check_attribute(reader, name);
    }
}

} // namespace ssrlab
