// Normals of a frame file: their space, and what is done about those that are missing or too short.
#include "core/error.h"
#include "core/pixel_index.h"
#include "scene/frame_channels.h"
#include "scene/frame_planes.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

glm::dmat3 normals_to_view(const FrameSource& source, const std::string& channel)
{
    const FrameConvention& convention = source.convention;
    const std::string      said       = normal_space_of(channel);
    const std::string      space      = convention.normal_space.empty() ? said : convention.normal_space;
    if (space.empty())
        throw_spec_error(
            "{}: channel '{}': nothing says whether it is in view or world space: write {} with [normals] space",
            source.file.shown, channel, convention.place);
    if (space == "view") return glm::dmat3(1);
    if (!convention.has_axes)
        throw_spec_error("{}: normals in world space need the camera's 'right', 'up' and 'forward' in [camera]",
                         convention.place);
    return glm::dmat3(convention.view.world_to_view);
}

glm::dvec3 point_at(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    const size_t i = pixel_index(pixel, gbuffer.view.size_px);
    return px_to_vs(gbuffer.view, glm::dvec2(pixel) + 0.5, static_cast<double>(gbuffer.depth[i]));
}

/// Conventions that do not fit show here: normals of another length, or of surfaces that look away.
void judge_normals(FrameSource& source, const FramePlane& plane)
{
    const GBufferImage& gbuffer = source.frame.gbuffer;
    double              length  = 0;
    size_t              covered = 0, count = 0, away = 0;
    for (size_t i = 0; i < gbuffer.depth.size(); ++i) {
        const glm::dvec3 normal = gbuffer.normal_vs[i];
        covered += gbuffer.depth[i] > 0;
        if (gbuffer.depth[i] == 0 || normal == glm::dvec3(0)) continue;
        const glm::dvec3 point = point_at(gbuffer, pixel_at(i, gbuffer.view.size_px));
        const glm::dvec3 sight = gbuffer.view.projection == Projection::perspective ? point : glm::dvec3(0, 0, -1);
        ++count;
        length += glm::length(normal);
        away += glm::dot(normal, sight) > 0;
    }
    if (covered == 0) return;
    if (count == 0) throw_spec_error("{}: every normal is zero, expected directions of length 1", plane.shown);
    length /= static_cast<double>(count);
    if (length < 0.9 || length > 1.1)
        throw_spec_error("{}: expected normals of length 1, got {:.2f} on average: is [normals] unsigned right?",
                         plane.shown, length);
    if (4 * away > count)
        source.frame.warnings.push_back(
            fmt::format("{}: {:.0f} % of the normals look away from the camera: are [normals] space and flip right?",
                        plane.shown, 100.0 * static_cast<double>(away) / static_cast<double>(count)));
}

/// To the surface of the pixel after this one along an axis, going by the neighbour that is more alike. Zero without a neighbour.
glm::dvec3 step_along(const GBufferImage& gbuffer, glm::ivec2 pixel, glm::ivec2 axis)
{
    const float own  = gbuffer.depth[pixel_index(pixel, gbuffer.view.size_px)];
    float       best = std::numeric_limits<float>::infinity();
    glm::dvec3  step(0);
    for (const int side : {-1, 1}) {
        const glm::ivec2 other = pixel + side * axis;
        if (glm::any(glm::lessThan(other, glm::ivec2(0))) ||
            glm::any(glm::greaterThanEqual(other, gbuffer.view.size_px)))
            continue;
        const float depth = gbuffer.depth[pixel_index(other, gbuffer.view.size_px)];
        if (depth <= 0 || std::abs(depth - own) >= best) continue;
        best = std::abs(depth - own);
        step = double(side) * (point_at(gbuffer, other) - point_at(gbuffer, pixel));
    }
    return step;
}

/// The normal of the depth around a pixel; towards the camera where that has none.
glm::vec3 normal_of_depth(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    const bool       flat   = gbuffer.view.projection == Projection::orthographic;
    const glm::dvec3 to_eye = flat ? glm::dvec3(0, 0, 1) : -glm::normalize(point_at(gbuffer, pixel));
    const glm::dvec3 normal = glm::cross(step_along(gbuffer, pixel, {0, 1}), step_along(gbuffer, pixel, {1, 0}));
    if (!(glm::length(normal) > 0)) return to_eye;
    return glm::normalize(glm::dot(normal, to_eye) < 0 ? -normal : normal);
}

/// Filtered normals are short, and pixels may have none. Those of length 1 keep their bits.
void complete_normals(FrameSource& source, const FramePlane& plane)
{
    constexpr float rounding = 1e-3F, longest = 1.1F; // of half floats; of 8 bits and filters
    GBufferImage&   gbuffer = source.frame.gbuffer;
    size_t          missing = 0, too_long = 0;
    for (size_t i = 0; i < gbuffer.depth.size(); ++i) {
        glm::vec3&  normal = gbuffer.normal_vs[i];
        const float length = glm::length(normal);
        if (gbuffer.depth[i] == 0) continue;
        too_long += length > longest;
        if (length > 0 && std::abs(length - 1) > rounding) normal /= length;
        if (length > 0) continue;
        normal = normal_of_depth(gbuffer, pixel_at(i, gbuffer.view.size_px));
        ++missing;
    }
    if (missing > 0)
        source.frame.warnings.push_back(fmt::format(
            "{}: {} pixels have a normal of zero: that of the depth around them is used", plane.shown, missing));
    if (too_long > 0)
        source.frame.warnings.push_back(
            fmt::format("{}: {} pixels have normals longer than {}: scaled to 1, if they are normals", plane.shown,
                        too_long, longest));
}

} // namespace

void read_normals(FrameSource& source)
{
    const FrameConvention& convention = source.convention;
    GBufferImage&          gbuffer    = source.frame.gbuffer;
    const FramePlane       planes[]   = {need_plane(source, "normal.x"), need_plane(source, "normal.y"),
                                         need_plane(source, "normal.z")};
    for (const FramePlane& plane : planes) clear_outside(source, plane);
    const glm::dmat3 to_view = normals_to_view(source, planes[0].name);
    const bool       same =
        to_view == glm::dmat3(1) && !convention.unsigned_normals && convention.normal_sign == glm::dvec3(1);
    for (size_t i = 0; i < gbuffer.depth.size(); ++i) {
        for (const FramePlane& plane : planes)
            if (gbuffer.depth[i] > 0 && !std::isfinite(plane.values[i])) refuse(source, plane, i, "a finite number");
        const glm::vec3 stored(planes[0].values[i], planes[1].values[i], planes[2].values[i]);
        glm::dvec3      normal = stored;
        if (convention.unsigned_normals && stored != glm::vec3(0))
            normal = 2.0 * normal - 1.0; // (0, 0, 0): never drawn
        normal = to_view * (convention.normal_sign * normal);
        gbuffer.normal_vs.push_back(gbuffer.depth[i] == 0 ? glm::vec3(0) : same ? stored : glm::vec3(normal));
    }
    judge_normals(source, planes[0]);
    complete_normals(source, planes[0]);
}

} // namespace ssrlab
