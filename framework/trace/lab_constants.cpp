// What the lab's shaders are composed with: settings, parameters and surface models as constants and macros.
#include "core/files.h"
#include "trace/lab_passes.h"

#include "shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

/// shaders/api/slab.glsl says what the three numbers are.
struct Slab {
    double slope = 0, scale = 1, shift = 0;
};

/// Thickness 0 or more: of the back. Less: of a front that lies before the depth.
Slab slab_of(const View& view, const TraceSettings& trace, double thickness)
{
    if (std::isinf(thickness)) return {0, thickness > 0 ? 0 : 1e30, 0};
    if (view.projection == Projection::perspective) {
        if (!trace.thickness_relative) return {thickness / view.near_m, 1, 0};
        return {0, thickness > -1 ? 1 / (1 + thickness) : 1e30, 0};
    }
    const double range = view.far_m - view.near_m;
    return trace.thickness_relative ? Slab{0, 1 + thickness, thickness * view.far_m / range}
                                    : Slab{0, 1, thickness / range};
}

template <typename Real> void add_slab(Constants& constants, uint32_t first, const Slab& slab)
{
    constants.add(first, static_cast<Real>(slab.slope));
    constants.add(first + 1, static_cast<Real>(slab.scale));
    constants.add(first + 2, static_cast<Real>(slab.shift));
}
static_assert(CONSTANT_SLAB_SCALE == CONSTANT_SLAB_SLOPE + 1 && CONSTANT_SLAB_SHIFT == CONSTANT_SLAB_SLOPE + 2);
static_assert(CONSTANT_FRONT_SCALE == CONSTANT_FRONT_SLOPE + 1 && CONSTANT_FRONT_SHIFT == CONSTANT_FRONT_SLOPE + 2);

template <typename Real> void add_slabs(Constants& constants, const View& view, const TraceSettings& trace)
{
    add_slab<Real>(constants, CONSTANT_SLAB_SLOPE, slab_of(view, trace, trace.thickness_m));
    add_slab<Real>(constants, CONSTANT_FRONT_SLOPE, slab_of(view, trace, -trace.thickness_m));
}

} // namespace

void add_reflecting(Constants& constants, const TraceSettings& settings)
{
    constants.add(CONSTANT_DIELECTRIC_MIN_F0, static_cast<float>(settings.dielectric_min_f0));
    constants.add(CONSTANT_DIELECTRIC_MAX_ROUGHNESS, static_cast<float>(settings.dielectric_max_roughness));
}

namespace {

template <typename Real> void add_settings(Constants& constants, const View& view, const TraceSettings& settings)
{
    constants.add(CONSTANT_MAX_DISTANCE_M, static_cast<Real>(settings.max_distance_m));
    constants.add(CONSTANT_RAY_OFFSET_M, static_cast<Real>(settings.ray_offset_m));
    constants.add(CONSTANT_BEHIND, static_cast<int32_t>(settings.behind));
    constants.add(CONSTANT_ORTHOGRAPHIC, static_cast<int32_t>(view.projection == Projection::orthographic));
    add_reflecting(constants, settings);
}

} // namespace

Defines number_format_defines(const Gpu& gpu, NumberFormat number_format)
{
    if (number_format == NumberFormat::float64) return {{"REAL_IS_DOUBLE", "1"}};
    if (gpu.info.cheap_doubles) return {{"DF64_IS_DOUBLE", "1"}};
    return {};
}

Defines ray_list_defines(const Gpu& gpu, const RayBuffers& rays)
{
    if (rays.rays_of_pixels == 0) return {};
    Defines defines = number_format_defines(gpu, rays.number_format);
    defines.emplace("RAYS_OF_PIXELS", std::to_string(rays.rays_of_pixels));
    defines.emplace("RAYS_FROM_LOBE", rays.from_lobe ? "1" : "0");
    return defines;
}

namespace {

/// What surface.toml would have to say so that shaders may read this of the G-buffer, too.
std::string needs_line(const Surface& surface, const std::string& more)
{
    const std::string already = surface.needs_gradient ? "\"gradient\", " : surface.needs_solid ? "\"solid\", " : "";
    return fmt::format("needs = [{}\"{}\"] in {}", already, more, short_path(surface.folder / "surface.toml"));
}

} // namespace

void add_surface(ShaderSource& source, const Surface& surface, int layers)
{
    for (const char* part : {"meeting.glsl", "meeting_exact.glsl", "held.glsl", "order.glsl"})
        if (std::filesystem::exists(surface.shaders / part))
            source.include_files.emplace(fmt::format("surface/{}", part), surface.shaders / part);
    if (!source.include_files.contains("surface/order.glsl")) // held.glsl has it
        source.include_texts.emplace("surface/order.glsl", "");
    source.include_folders.push_back(surface.shaders);
    const auto add_need = [&](bool needed, const char* need, const char* macro, const char* file) {
        if (needed)
            source.defines.emplace(macro, "1");
        else
            source.offered.emplace(needs_line(surface, need), shader_folder() / "surfaces" / "plane" / file);
    };
    add_need(surface.needs_gradient, "gradient", "PIXEL_PLANES", "stored.pixel_planes.glsl");
    add_need(surface.needs_solid, "solid", "SURFACE_SOLID", "solid.surface_solid.glsl");
    for (const std::string& macro : surface.defines) source.defines.emplace(macro, "1");
    source.defines.emplace("LAYERS", std::to_string(layers));
    if (layers > 1) source.defines.emplace("LAYERED", "1");
}

Defines store_defines(const Gpu& gpu, const Buffer& texels)
{
    const bool storable =
        gpu.info.int64 && !gpu.info.plain_buffers && texels.bytes <= gpu.impl->limits.maxStorageBufferRange;
    return storable ? Defines{{"STORES_64_BITS", "1"}} : Defines{};
}

Constants settings_constants(const View& view, const TraceSettings& settings, NumberFormat number_format, bool exact)
{
    Constants constants;
    if (number_format == NumberFormat::float64)
        add_settings<double>(constants, view, settings);
    else
        add_settings<float>(constants, view, settings);
    if (number_format == NumberFormat::float64 || exact)
        add_slabs<double>(constants, view, settings);
    else
        add_slabs<float>(constants, view, settings);
    return constants;
}

namespace {

/// "depth_pyramid.kind" -> "depth_pyramid_kind"
std::string glsl_name(const Parameter& parameter)
{
    std::string name = parameter.name;
    std::ranges::replace(name, '.', '_');
    return name;
}

} // namespace

std::string parameter_declarations(std::span<const Parameter> parameters, uint32_t id)
{
    std::string text;
    for (const Parameter& parameter : parameters) {
        const char* declaration = parameter.type == ParameterType::real      ? "float {} = 0.0"
                                  : parameter.type == ParameterType::boolean ? "bool {} = false"
                                                                             : "int {} = 0";
        text += fmt::format("layout(constant_id = {}) const {};\n", id++,
                            fmt::format(fmt::runtime(declaration), glsl_name(parameter)));
        for (size_t i = 0; i < parameter.choices.size(); ++i)
            text +=
                fmt::format("{} {}_{} = {}", i == 0 ? "const int" : ",", glsl_name(parameter), parameter.choices[i], i);
        if (!parameter.choices.empty()) text += ";\n";
    }
    return text;
}

void add_parameters(Constants& constants, std::span<const Parameter> parameters, const ParameterValues& values,
                    uint32_t id)
{
    for (const Parameter& parameter : parameters) {
        const double value = values.at(parameter.name);
        if (parameter.type == ParameterType::real)
            constants.add(id++, static_cast<float>(value));
        else
            constants.add(id++, static_cast<int32_t>(value));
    }
}

} // namespace ssrlab
