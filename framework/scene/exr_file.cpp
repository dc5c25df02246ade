#include "scene/exr_file.h"

#include "core/error.h"
#include "core/files.h"
#include "scene/exr_header.h"

#include <OpenImageIO/imageio.h>

namespace ssrlab {
namespace {

void require_usable(const ExrFile& file, const OIIO::ImageSpec& spec, int part)
{
    if (spec.deep) throw_failure("{}: part {} is deep data, expected one value per pixel", file.shown, part);
    // A cropped data window would move every pixel against the camera.
    if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
        spec.height != spec.full_height)
        throw_failure("{}: part {} holds {}x{} pixels at ({}, {}) of a picture of {}x{}, expected all of them",
                      file.shown, part, spec.width, spec.height, spec.x - spec.full_x, spec.y - spec.full_y,
                      spec.full_width, spec.full_height);
    if (part > 0 && (spec.width != file.size_px.x || spec.height != file.size_px.y))
        throw_failure("{}: part {} has {}x{} pixels, expected {}x{} as the first part", file.shown, part, spec.width,
                      spec.height, file.size_px.x, file.size_px.y);
}

void add_channels(ExrFile& file, const OIIO::ImageSpec& spec, int part, bool several)
{
    const std::string layer = several ? std::string(spec.get_string_attribute("oiio:subimagename")) : "";
    for (int i = 0; i < spec.nchannels; ++i) {
        const std::string& own  = spec.channelnames[static_cast<size_t>(i)];
        const std::string  name = layer.empty() || own.starts_with(layer) ? own : layer + "." + own;
        file.channels.push_back({name, part, i, spec.channelformat(i) == OIIO::TypeDesc::HALF});
    }
}

std::unique_ptr<OIIO::ImageInput> open_input(const std::filesystem::path& path, const std::string& shown)
{
    check_exr_header(path, shown);
    // By that reader alone: ImageInput::open(path) hands what it refuses to those of all other formats.
    auto            input = OIIO::ImageInput::create("openexr");
    OIIO::ImageSpec spec;
    if (!input || !input->open(path.string(), spec))
        throw_failure("{}: cannot be read as EXR: {}", shown, input ? input->geterror() : OIIO::geterror());
    return input;
}

} // namespace

ExrFile open_exr(const std::filesystem::path& path)
{
    ExrFile file{path, short_path(path), {0, 0}, {}, {}};
    if (!std::filesystem::is_regular_file(path)) throw_spec_error("{}: no such file", file.shown);
    const auto input   = open_input(path, file.shown);
    const bool several = input->spec_dimensions(1).nchannels > 0;
    for (int part = 0; input->seek_subimage(part, 0); ++part) {
        const OIIO::ImageSpec& spec = input->spec();
        require_usable(file, spec, part);
        add_channels(file, spec, part, several);
        if (part > 0) continue;
        file.size_px = {spec.width, spec.height};
        for (const auto& attribute : spec.extra_attribs)
            if (attribute.type() == OIIO::TypeString)
                file.attributes[attribute.name().string()] = attribute.get_string();
    }
    return file;
}

std::vector<float> read_channel(const ExrFile& file, const ExrChannel& channel)
{
    const auto         input = open_input(file.path, file.shown);
    std::vector<float> values(static_cast<size_t>(file.size_px.x) * static_cast<size_t>(file.size_px.y));
    if (!input->read_image(channel.part, 0, channel.index, channel.index + 1, OIIO::TypeDesc::FLOAT, values.data()))
        throw_failure("{}: channel '{}' cannot be read: {}", file.shown, channel.name, input->geterror());
    return values;
}

} // namespace ssrlab
