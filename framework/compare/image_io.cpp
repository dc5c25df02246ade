#include "compare/image_io.h"

#include "compare/image_filter.h"
#include "core/error.h"
#include "core/parallel_rows.h"

#include <OpenImageIO/imageio.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace ssrlab {
namespace {

namespace fs = std::filesystem;

/// Removes the unfinished file unless it was renamed.
struct TemporaryFile {
    fs::path path;
    ~TemporaryFile()
    {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

/// Beside the final name, so that rename is atomic, and with its extension, which chooses the format.
fs::path temporary_path(const fs::path& path)
{
    return path.parent_path() / fmt::format(".{}.{}.tmp{}", path.stem().string(), getpid(), path.extension().string());
}

OIIO::ImageSpec make_spec(const Image& image, bool png)
{
    OIIO::ImageSpec spec(image.size_px.x, image.size_px.y, png ? 3 : int(image.channels.size()),
                         png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    if (png) {
        spec.attribute("png:compressionLevel",
                       4); // of 9: a tenth larger than with the default of 6, in two thirds of the time
    } else {
        spec.channelnames = image.channels;
        spec.attribute("compression", "zip");
    }
    spec.attribute("oiio:ColorSpace", png ? "sRGB" : "Linear");
    // OpenImageIO would put the present time here; the same picture must give the same file.
    spec.attribute("DateTime", "2000:01:01 00:00:00");
    for (const auto& [name, value] : image.metadata) spec.attribute(name, value);
    return spec;
}

void sync_to_disk(const fs::path& path)
{
    const int  file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    const bool ok   = file >= 0 && fsync(file) == 0;
    if (file >= 0) close(file);
    if (!ok) throw_failure("{}: cannot be flushed to disk", path.string());
}

void require_consistent(const fs::path& path, const Image& image)
{
    const size_t expected =
        size_t(std::max(image.size_px.x, 0)) * size_t(std::max(image.size_px.y, 0)) * image.channels.size();
    if (expected == 0 || image.values.size() != expected) {
        throw_failure("{}: an image of {}x{} with {} channels cannot have {} values", path.string(), image.size_px.x,
                      image.size_px.y, image.channels.size(), image.values.size());
    }
}

} // namespace

std::vector<uint8_t> to_srgb8(const Image& image)
{
    const size_t         channels = image.channels.size();
    const size_t         pixels   = image.values.size() / channels;
    std::vector<uint8_t> bytes(pixels * 3);
    parallel_pixels(image.size_px.x, image.size_px.y, [&](size_t i) {
        for (size_t c = 0; c < 3; ++c) {
            const float value = image.values[i * channels + std::min(c, channels - 1)];
            bytes[i * 3 + c]  = uint8_t(std::lround(255 * linear_to_srgb(value)));
        }
    });
    return bytes;
}

void write_image(const fs::path& path, const Image& image)
{
    require_consistent(path, image);
    const std::string extension = path.extension().string();
    if (extension != ".png" && extension != ".exr") {
        throw_spec_error("{}: images are written as .exr or .png, not '{}'", path.string(), extension);
    }
    const bool          png = extension == ".png";
    const TemporaryFile temporary{temporary_path(path)};
    const auto          output = OIIO::ImageOutput::create(temporary.path.string());
    if (!output) throw_failure("{}: {}", path.string(), OIIO::geterror());
    if (!output->open(temporary.path.string(), make_spec(image, png))) {
        throw_failure("{}: {}", path.string(), output->geterror());
    }
    const bool written = png ? output->write_image(OIIO::TypeDesc::UINT8, to_srgb8(image).data())
                             : output->write_image(OIIO::TypeDesc::FLOAT, image.values.data());
    // On a full disk write_image fails and close still succeeds: both count.
    const std::string write_error = written ? "" : output->geterror();
    if (!output->close() || !written) {
        throw_failure("{}: {}", path.string(), written ? output->geterror() : write_error);
    }
    sync_to_disk(temporary.path);
    std::error_code error;
    fs::rename(temporary.path, path, error);
    if (error) throw_failure("{}: {}", path.string(), error.message());
}

Image read_image(const fs::path& path)
{
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw_failure("{}: {}", path.string(), OIIO::geterror());
    const OIIO::ImageSpec& spec        = input->spec();
    constexpr int          max_side_px = 1 << 16;
    if (spec.depth > 1 || spec.width < 1 || spec.height < 1 || spec.width > max_side_px || spec.height > max_side_px) {
        throw_failure("{}: an image of {}x{}x{} is not readable here", path.string(), spec.width, spec.height,
                      spec.depth);
    }
    Image image;
    image.size_px  = {spec.width, spec.height};
    image.channels = spec.channelnames;
    image.values.resize(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
    for (const auto& attribute : spec.extra_attribs) {
        if (attribute.type() == OIIO::TypeString) image.metadata[attribute.name().string()] = attribute.get_string();
    }
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data())) {
        throw_failure("{}: {}", path.string(), input->geterror());
    }
    return image;
}

} // namespace ssrlab
