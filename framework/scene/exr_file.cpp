#include "scene/exr_file.h"

#include "core/error.h"
#include "core/files.h"
#include "core/pixel_index.h"
#include "scene/exr_header.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cmath>

namespace ssrlab {
namespace {

void require_usable(const ExrFile& file, const OIIO::ImageSpec& spec, int part)
{
    if (spec.deep) throw_failure("{}: part {} is deep data, expected one value per pixel", file.shown, part);
    if (part > 0 && (spec.full_width != file.size_px.x || spec.full_height != file.size_px.y))
        throw_failure("{}: part {} is a picture of {}x{} pixels, expected {}x{} as the first part", file.shown, part,
                      spec.full_width, spec.full_height, file.size_px.x, file.size_px.y);
    const int x = spec.x - spec.full_x, y = spec.y - spec.full_y;
    if (x >= spec.full_width || y >= spec.full_height || x + spec.width <= 0 || y + spec.height <= 0)
        throw_failure("{}: part {} holds {}x{} pixels at ({}, {}), which is outside its picture of {}x{}", file.shown,
                      part, spec.width, spec.height, x, y, spec.full_width, spec.full_height);
}

void add_channels(ExrFile& file, const OIIO::ImageSpec& spec, int part, bool several)
{
    const std::string layer = several ? std::string(spec.get_string_attribute("oiio:subimagename")) : "";
    for (int i = 0; i < spec.nchannels; ++i) {
        const std::string& own  = spec.channelnames[static_cast<size_t>(i)];
        const std::string  name = layer.empty() || own.starts_with(layer) ? own : fmt::format("{}.{}", layer, own);
        file.channels.push_back({name, part, i, spec.channelformat(i) == OIIO::TypeDesc::HALF,
                                 spec.channelformat(i) == OIIO::TypeDesc::UINT32});
    }
}

/// Chromaticities of red, green, blue and white as ITU-R BT.709 has them, which is what OpenEXR assumes without any.
bool has_other_primaries(const OIIO::ImageSpec& spec)
{
    constexpr float rec709[8] = {0.64F, 0.33F, 0.3F, 0.6F, 0.15F, 0.06F, 0.3127F, 0.329F}, rounding = 0.005F;
    const auto*     found = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
    for (int i = 0; found != nullptr && i < 8; ++i)
        if (!(std::abs(found->get_float_indexed(i) - rec709[i]) < rounding)) return true;
    return false;
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
    ExrFile file{path, short_path(path), {0, 0}, {}, {}, {}};
    if (!std::filesystem::is_regular_file(path)) throw_spec_error("{}: no such file", file.shown);
    const auto input   = open_input(path, file.shown);
    const bool several = input->spec_dimensions(1).nchannels > 0;
    for (int part = 0; input->seek_subimage(part, 0); ++part) {
        const OIIO::ImageSpec& spec = input->spec();
        require_usable(file, spec, part);
        add_channels(file, spec, part, several);
        file.windows.push_back({{spec.x - spec.full_x, spec.y - spec.full_y}, {spec.width, spec.height}});
        if (part > 0) continue;
        file.size_px       = {spec.full_width, spec.full_height};
        const float aspect = spec.get_float_attribute("PixelAspectRatio", 1);
        if (aspect > 0 && std::isfinite(aspect)) file.pixel_aspect = static_cast<double>(aspect);
        file.other_primaries = has_other_primaries(spec);
        for (const auto& attribute : spec.extra_attribs)
            if (attribute.type() == OIIO::TypeString)
                file.attributes[attribute.name().string()] = attribute.get_string();
    }
    return file;
}

std::string other_primaries_text(const ExrFile& file)
{
    return file.shown +
           ": its chromaticities are not those of Rec. 709: colours are taken as if they were; convert them "
           "to linear Rec. 709 (sRGB) first";
}

std::vector<float> read_channel(const ExrFile& file, const ExrChannel& channel)
{
    const auto         input  = open_input(file.path, file.shown);
    const ExrWindow    window = file.windows[static_cast<size_t>(channel.part)];
    std::vector<float> stored(pixel_count(window.size_px));
    const auto         read = [&](OIIO::TypeDesc type, void* to) {
        if (!input->read_image(channel.part, 0, channel.index, channel.index + 1, type, to))
            throw_failure("{}: channel '{}' cannot be read: {}", file.shown, channel.name, input->geterror());
    };
    if (channel.is_uint) { // as a float OpenImageIO would make it a share of 2^32
        std::vector<uint32_t> whole(stored.size());
        read(OIIO::TypeDesc::UINT32, whole.data());
        std::ranges::copy(whole, stored.begin());
    } else {
        read(OIIO::TypeDesc::FLOAT, stored.data());
    }
    if (window.is_whole(file.size_px)) return stored;
    std::vector<float> values(pixel_count(file.size_px), 0.0F);
    for (size_t i = 0; i < values.size(); ++i) {
        const glm::ivec2 pixel = pixel_at(i, file.size_px);
        if (window.has(pixel)) values[i] = stored[pixel_index(pixel - window.from_px, window.size_px)];
    }
    return values;
}

} // namespace ssrlab
