#include "scene/load_frame.h"

#include "core/error.h"
#include "core/pixel_index.h"
#include "scene/environment.h"
#include "scene/frame_planes.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace fs = std::filesystem;
namespace {

/// Distance along the view axis per distance along the pixel's ray.
double axis_share(const View& view, glm::ivec2 pixel)
{
    if (view.projection == Projection::orthographic) return 1;
    const glm::dvec2 slope = (glm::dvec2(pixel) + 0.5 - view.centre_px) / view.focal_px;
    return 1 / glm::length(glm::dvec3(slope, 1));
}

/// Metres along the view axis; infinity: nothing is there.
double device_distance_m(const FrameConvention& convention, double depth)
{
    const double near_m = convention.view.near_m, far_m = convention.device_far_m;
    const double reversed = convention.depth == DepthKind::standard ? 1 - depth : depth;
    if (convention.view.projection == Projection::orthographic) return far_m - reversed * (far_m - near_m);
    if (std::isinf(far_m)) return near_m / reversed;
    return near_m * far_m / (near_m + reversed * (far_m - near_m));
}

bool same_value(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

float usable_depth_of(const FrameSource& source, const FramePlane& plane, size_t i)
{
    const FrameConvention& convention = source.convention;
    const double           value      = static_cast<double>(plane.values[i]);
    if (!plane.window.has(pixel_at(i, source.file.size_px))) return 0;
    if (convention.background && same_value(plane.values[i], static_cast<float>(*convention.background))) return 0;
    if (std::isnan(value)) refuse(source, plane, i, "a number");
    if (convention.depth == DepthKind::reversed || convention.depth == DepthKind::standard) {
        if (value < 0 || value > 1) refuse(source, plane, i, "device depth in 0 … 1");
        if (value == (convention.depth == DepthKind::reversed ? 0 : 1)) return 0;
        const bool own =
            convention.depth == DepthKind::reversed &&
            (convention.view.projection == Projection::orthographic || std::isinf(convention.device_far_m));
        if (own) return plane.values[i]; // the same convention: the same bits
        return static_cast<float>(distance_to_depth(convention.view, device_distance_m(convention, value)));
    }
    const double metres = value * convention.unit_m;
    if (metres >= convention.background_m) return 0;
    const double along = convention.depth == DepthKind::distance
                             ? metres
                             : metres * axis_share(convention.view, pixel_at(i, source.file.size_px));
    if (along < convention.view.near_m * (1 - 1e-6))
        refuse(source, plane, i, "a distance of at least near_m, or [depth] background = the value where nothing is");
    const double depth = distance_to_depth(convention.view, along);
    return static_cast<float>(std::clamp(depth, 0.0, 1.0));
}

void read_depth_plane(FrameSource& source)
{
    const FramePlane plane = need_plane(source, "depth");
    if (plane.is_half)
        source.frame.warnings.push_back(
            plane.shown + " is half: depth has 11 bits, and steps of up to 0.1 % of the distance; export it as float");
    auto& depth = source.frame.gbuffer.depth;
    for (size_t i = 0; i < plane.values.size(); ++i) depth.push_back(usable_depth_of(source, plane, i));
    if (std::ranges::all_of(depth, [](float d) { return d == 0; }))
        source.frame.warnings.push_back(plane.shown + ": every pixel is background: is [depth] kind right?");
}

float share_at(const FrameSource& source, const FramePlane& plane, size_t i)
{
    constexpr float rounding = 1e-3F;
    const float     value    = plane.values[i];
    if (source.frame.gbuffer.depth[i] > 0 && !(value >= -rounding && value <= 1 + rounding))
        refuse(source, plane, i, "a value in 0 … 1");
    return source.frame.gbuffer.depth[i] > 0 ? std::clamp(value, 0.0F, 1.0F) : 0;
}

void read_roughness(FrameSource& source)
{
    auto&      roughness = source.frame.gbuffer.roughness;
    const auto smooth =
        source.convention.channels.contains("roughness") ? std::nullopt : find_plane(source, "smoothness");
    const FramePlane plane = smooth ? *smooth : need_plane(source, "roughness", " or [values]");
    clear_outside(source, plane);
    for (size_t i = 0; i < plane.values.size(); ++i)
        roughness.push_back(smooth ? 1 - share_at(source, plane, i) : share_at(source, plane, i));
}

/// A surface of the specular workflow is as metallic as its reflectance is above that of a dielectric.
void read_metallic(FrameSource& source)
{
    auto&      metallic = source.frame.gbuffer.metallic;
    const auto given    = find_plane(source, "metallic");
    const auto red      = given ? std::nullopt : find_plane(source, "specular.R");
    if (!red) {
        const FramePlane plane = given ? *given : need_plane(source, "metallic", " or [values]");
        clear_outside(source, plane);
        for (size_t i = 0; i < plane.values.size(); ++i) metallic.push_back(share_at(source, plane, i));
        return;
    }
    if (!source.convention.channels.contains("specular.R"))
        source.frame.warnings.push_back(red->shown +
                                        " is taken as reflectance at normal incidence (F0), not as reflected light");
    const FramePlane green = need_plane(source, "specular.G"), blue = need_plane(source, "specular.B");
    for (const FramePlane* plane : {&*red, &green, &blue}) clear_outside(source, *plane);
    for (size_t i = 0; i < red->values.size(); ++i) {
        const float f0 = std::max({share_at(source, *red, i), share_at(source, green, i), share_at(source, blue, i)});
        metallic.push_back(std::max(0.0F, (f0 - common_dielectric_f0) / (1 - common_dielectric_f0)));
    }
}

/// Three planes as colours; `otherwise` in their place where there are none. Clamped to what pictures can hold; not finite: black.
std::vector<glm::vec3> read_colour(FrameSource& source, const std::string& name, glm::vec3 otherwise,
                                   const char* without)
{
    std::vector<glm::vec3> colours(pixel_count(source.file.size_px), otherwise);
    auto                   red = find_plane(source, name + ".R");
    if (!red) {
        if (*without != 0) source.frame.warnings.push_back(fmt::format("{}: {}", source.file.shown, without));
        return colours;
    }
    const FramePlane planes[] = {std::move(*red), need_plane(source, name + ".G"), need_plane(source, name + ".B")};
    size_t           broken = 0, clamped = 0, negative = 0;
    for (size_t i = 0; i < colours.size(); ++i) {
        const glm::vec3 colour(planes[0].values[i], planes[1].values[i], planes[2].values[i]);
        const bool      finite = std::isfinite(colour.x) && std::isfinite(colour.y) && std::isfinite(colour.z);
        broken += !finite;
        if (!finite) {
            colours[i] = glm::vec3(0);
            continue;
        }
        clamped += std::max({colour.x, colour.y, colour.z}) > largest_radiance;
        negative += std::min({colour.x, colour.y, colour.z}) < 0;
        colours[i] = glm::clamp(colour, 0.0F, largest_radiance);
    }
    if (clamped > 0)
        source.frame.warnings.push_back(
            fmt::format("{}: {} pixels are above {}: clamped", planes[0].shown, clamped, largest_radiance));
    if (negative > 0)
        source.frame.warnings.push_back(
            fmt::format("{}: {} pixels are negative: clamped to 0", planes[0].shown, negative));
    if (broken > 0)
        source.frame.warnings.push_back(
            fmt::format("{}: {} pixels are not finite; they count as black", planes[0].shown, broken));
    return colours;
}

/// Says which pixels of the file are not used, and which of the picture are not in the file.
void name_windows(FrameSource& source)
{
    const ExrFile& file = source.file;
    for (size_t part = 0; part < file.windows.size(); ++part) {
        const glm::ivec2 from = file.windows[part].from_px, size = file.windows[part].size_px;
        const glm::ivec2 to     = from + size;
        const glm::ivec2 inside = glm::min(to, file.size_px) - glm::max(from, glm::ivec2(0));
        const size_t     used   = pixel_count(inside);
        const auto       say    = [&](size_t count, const char* what) {
            if (count > 0)
                source.frame.warnings.push_back(
                             fmt::format("{}: part {} holds {}x{} pixels at ({}, {}) of a picture of {}x{}: {} {}", file.shown,
                                         part, size.x, size.y, from.x, from.y, file.size_px.x, file.size_px.y, count, what));
        };
        say(pixel_count(size) - used, "of them are overscan and left out");
        say(pixel_count(file.size_px) - used,
            "of the picture are not there and count as background, or as 0 in colours");
    }
}

/// What only ssrlab's own files have.
void read_own(FrameSource& source)
{
    GBufferImage& gbuffer = source.frame.gbuffer;
    if (const auto ids = find_plane(source, "object_id"))
        for (const float id : ids->values)
            gbuffer.object_id.push_back(id > 0 && id < 0x1p32F ? static_cast<uint32_t>(id) : 0);
    else
        for (const float depth : gbuffer.depth) gbuffer.object_id.push_back(depth > 0 ? 1 : 0);
    const auto x = find_plane(source, "gradient.x"), y = find_plane(source, "gradient.y");
    for (size_t i = 0; x && y && i < gbuffer.depth.size(); ++i)
        gbuffer.gradient.emplace_back(x->values[i], y->values[i]);
    if (const auto back = find_plane(source, "solid_back")) gbuffer.solid_back = back->values;
    const auto shares = [&](const char* name, std::vector<float>& values) {
        if (const auto plane = find_plane(source, name))
            for (size_t i = 0; i < gbuffer.depth.size(); ++i) values.push_back(share_at(source, *plane, i));
    };
    shares("dielectric_f0", gbuffer.dielectric_f0);
    shares("diffuse_share", gbuffer.diffuse_share);
}

} // namespace

Frame load_frame(const fs::path& exr)
{
    FrameSource source{open_exr(exr), {}, {}};
    name_windows(source);
    if (source.file.other_primaries) source.frame.warnings.push_back(other_primaries_text(source.file));
    source.convention         = read_convention(source.file);
    source.frame.gbuffer.view = source.convention.view;
    source.frame.reference    = source.convention.reference;
    read_depth_plane(source);
    read_normals(source);
    read_roughness(source);
    read_metallic(source);
    GBufferImage& gbuffer = source.frame.gbuffer;
    gbuffer.base_colour   = read_colour(source, "base_colour", glm::vec3(1), "no base colour: it counts as white");
    const bool split      = find_plane(source, "radiance.R").has_value();
    gbuffer.radiance =
        read_colour(source, split ? "radiance" : "lit", glm::vec3(0), "no lit colour: surfaces are black");
    gbuffer.highlight = read_colour(source, "highlight", glm::vec3(0), "");
    gbuffer.emission  = read_colour(source, "emission", glm::vec3(0), "");
    read_own(source);
    return std::move(source.frame);
}

glm::ivec2 frame_size_px(const fs::path& exr) { return open_exr(exr).size_px; }

std::vector<fs::path> frame_files(const fs::path& exr)
{
    std::vector<fs::path> files{exr};
    const fs::path        convention = convention_file(exr);
    if (!fs::exists(convention)) return files;
    files.push_back(convention);
    const FrameConvention read = read_convention(open_exr(exr));
    for (const auto& [quantity, name] : read.channels)
        if (const size_t colon = name.rfind(':'); colon != std::string::npos)
            files.push_back(exr.parent_path() / name.substr(0, colon));
    if (!read.reference.empty()) files.push_back(read.reference);
    return files;
}

} // namespace ssrlab
