#include "scene/image_file.h"

#include "core/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstring>

namespace ssrlab {
namespace {

constexpr int max_side_px = 16384;

/// OpenImageIO's name.
const char* format_of(std::span<const unsigned char> bytes, const std::string& name)
{
    const auto starts_with = [&](std::string_view magic) {
        return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
    };
    if (starts_with("\x89PNG")) return "png";
    if (starts_with("\xFF\xD8\xFF")) return "jpeg";
    if (starts_with("BM")) return "bmp";
    if (name.ends_with(".tga") || name.ends_with(".TGA")) return "targa";
    throw_failure("{}: neither PNG, JPEG, BMP nor TGA", name);
}

/// Before OpenImageIO 2.4, which leaks memory where a chunk ends beyond the file.
void refuse_cut_png(std::span<const unsigned char> bytes, const std::string& name)
{
    constexpr size_t signature = 8, around_data = 12; // length, kind and checksum
    for (size_t at = signature; at + around_data <= bytes.size();) {
        const auto   byte   = [&](size_t i) { return static_cast<size_t>(bytes[at + i]); };
        const size_t length = byte(0) << 24U | byte(1) << 16U | byte(2) << 8U | byte(3);
        if (length > bytes.size() - at - around_data) break;
        if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return;
        at += around_data + length;
    }
    throw_failure("{}: cut off: a PNG of {} bytes that ends within a chunk, or without IEND", name, bytes.size());
}

/// Spreads grey, grey-alpha or RGB to RGBA.
std::vector<uint8_t> to_rgba(const std::vector<uint8_t>& pixels, size_t channels)
{
    const size_t         count = pixels.size() / channels;
    std::vector<uint8_t> rgba(count * 4, 255);
    for (size_t i = 0; i < count; ++i) {
        const uint8_t* from = &pixels[i * channels];
        uint8_t*       to   = &rgba[i * 4];
        for (size_t c = 0; c < 3; ++c) to[c] = from[channels >= 3 ? c : 0];
        if (channels == 2 || channels >= 4) to[3] = from[channels == 2 ? 1 : 3];
    }
    return rgba;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

} // namespace

Texture decode_image(std::span<const unsigned char> bytes, const std::string& name)
{
    OIIO::Filesystem::IOMemReader memory(const_cast<unsigned char*>(bytes.data()), bytes.size());
    OIIO::ImageSpec               config;
    config["oiio:UnassociatedAlpha"] = 1; // materials want the colour as it is stored
    // As an attribute: given as an argument, version 2.4 looks for a file of that name all the same.
    OIIO::Filesystem::IOProxy* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    // By that reader alone: ImageInput::open() hands what it refuses to those of all other formats.
    const std::string format = format_of(bytes, name);
    if (format == "png") refuse_cut_png(bytes, name);
    const auto      input = OIIO::ImageInput::create(format);
    OIIO::ImageSpec spec;
    if (!input || !input->open("image", spec, config))
        throw_failure("{}: cannot be decoded: {}", name, first_line(input ? input->geterror() : OIIO::geterror()));
    if (spec.width < 1 || spec.height < 1) throw_failure("{}: {}x{} pixels", name, spec.width, spec.height);
    if (spec.width > max_side_px || spec.height > max_side_px)
        throw_spec_error("{}: {}x{} pixels, at most {} a side can be used", name, spec.width, spec.height, max_side_px);
    const auto           channels = static_cast<size_t>(spec.nchannels);
    std::vector<uint8_t> pixels(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) * channels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data()))
        throw_failure("{}: cannot be decoded: {}", name, first_line(input->geterror()));
    Texture texture;
    texture.size_px = {spec.width, spec.height};
    texture.rgba    = channels == 4 ? std::move(pixels) : to_rgba(pixels, channels);
    return texture;
}

float mean_alpha(const Texture& texture)
{
    if (texture.rgba.empty()) return 1;
    uint64_t     sum    = 0;
    const size_t pixels = texture.rgba.size() / 4;
    for (size_t i = 3; i < texture.rgba.size(); i += 4) sum += texture.rgba[i];
    return static_cast<float>(static_cast<double>(sum) / (255.0 * static_cast<double>(pixels)));
}

} // namespace ssrlab
