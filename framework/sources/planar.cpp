// Planar reflections: the frame drawn from the camera's mirror image in a plane that reflects, without what lies before
// that plane. A ray from the plane is a line of sight of that camera, so nothing is in its way.
#include "core/pixel_index.h"
#include "core/stopwatch.h"
#include "frame/both_sides.h"
#include "frame/passes/pass_helpers.h"
#include "sources/gbuffer_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace ssrlab {
namespace {

/// Points p with dot(normal, p) = offset_m.
struct Plane {
    glm::dvec3 normal_ws{0}; // unit
    double     offset_m = 0;
};

/// Returns the normal of the triangle that a pixel shows, not the one that shades it: in view space, of unit length,
/// toward the eye. Zero where the pixel's plane is unknown.
glm::dvec3 flat_normal_vs(const GBufferImage& image, size_t pixel)
{
    constexpr double step_px = 0.125; // short, so that depth stays positive
    const glm::dvec2 gradient(image.gradient[pixel]), at_px(glm::dvec2(pixel_at(pixel, image.view.size_px)) + 0.5);
    const double     depth = double(image.depth[pixel]);
    if (!std::isfinite(gradient.x + gradient.y)) return glm::dvec3(0);
    const auto beside = [&](glm::dvec2 by_px) {
        return px_to_vs(image.view, at_px + by_px, depth + glm::dot(gradient, by_px));
    };
    const glm::dvec3 at_vs  = beside({0, 0});
    const glm::dvec3 normal = glm::cross(beside({0, step_px}) - at_vs, beside({step_px, 0}) - at_vs);
    const double     length = glm::length(normal);
    return length > 0 ? normal / length : glm::dvec3(0);
}

/// Fits a plane to points by least squares. Distances count along the longest axis of `normal`.
Plane fitted_plane(std::span<const glm::dvec3> points_ws, glm::dvec3 normal)
{
    const glm::dvec3 size = glm::abs(normal);
    const int        up   = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int        u = (up + 1) % 3, v = (up + 2) % 3;
    glm::dvec3       middle(0);
    for (const glm::dvec3& point : points_ws) middle += point / double(points_ws.size());
    double uu = 0, uv = 0, vv = 0, uw = 0, vw = 0;
    for (const glm::dvec3& point : points_ws) {
        const glm::dvec3 d = point - middle;
        uu += d[u] * d[u], uv += d[u] * d[v], vv += d[v] * d[v], uw += d[u] * d[up], vw += d[v] * d[up];
    }
    const double determinant = uu * vv - uv * uv;
    if (determinant > 1e-6 * uu * vv) { // else they lie on a line
        normal[up] = 1;
        normal[u]  = (uv * vw - vv * uw) / determinant;
        normal[v]  = (uv * uw - uu * vw) / determinant;
        normal     = glm::normalize(normal);
    }
    return {normal, glm::dot(normal, middle)};
}

/// Fits a plane to most of the points; the others may lie in a parallel plane close by. Each round leaves out the half
/// that lies farther off.
Plane plane_of_most(std::vector<glm::dvec3> points_ws, glm::dvec3 normal)
{
    constexpr int    rounds = 4;
    constexpr size_t least  = 64; // points from which a plane is known well
    Plane            plane  = fitted_plane(points_ws, normal);
    for (int round = 0; round < rounds && points_ws.size() > 2 * least; ++round) {
        const auto middle = points_ws.begin() + static_cast<ptrdiff_t>(points_ws.size() / 2);
        std::ranges::nth_element(points_ws, middle, {}, [&](const glm::dvec3& point) {
            return std::abs(glm::dot(plane.normal_ws, point) - plane.offset_m);
        });
        points_ws.erase(middle, points_ws.end());
        plane = fitted_plane(points_ws, plane.normal_ws);
    }
    return plane;
}

/// The plane in which most of the rays begin; nullopt if fewer than 2 % begin in any.
std::optional<Plane> largest_plane(const GBufferImage& image, std::span<const OpenRay> rays)
{
    const glm::dmat4 view_to_world = glm::inverse(image.view.world_to_view);
    const auto       eye_ws        = glm::dvec3(view_to_world[3]);
    // Planes by normal and distance from the eye, in steps that are wider than rounding and narrower than things.
    struct Part {
        std::vector<glm::dvec3> points_ws;
        glm::dvec3              normal_ws{0};
    };
    constexpr double                   normal_step = 0.02, distance_step = 0.01;
    std::map<std::array<int, 4>, Part> parts;
    for (const OpenRay& ray : rays) {
        const glm::dvec3 normal = glm::dmat3(view_to_world) * flat_normal_vs(image, ray.pixel);
        if (normal == glm::dvec3(0)) continue;
        const double away_m = glm::dot(normal, ray.origin_ws - eye_ws);
        const auto   step   = [](double value, double width) { return static_cast<int>(std::lround(value / width)); };
        Part& part = parts[{step(normal.x, normal_step), step(normal.y, normal_step), step(normal.z, normal_step),
                            step(std::log(std::max(std::abs(away_m), 1e-9)), distance_step)}];
        part.points_ws.push_back(ray.origin_ws);
        part.normal_ws += normal;
    }
    const auto count_of = [](const auto& part) { return part.second.points_ws.size(); };
    const auto largest  = std::ranges::max_element(parts, {}, count_of);
    if (largest == parts.end() || count_of(*largest) * 50 < rays.size()) return std::nullopt;
    return plane_of_most(std::move(largest->second.points_ws), largest->second.normal_ws);
}

bool begins_in(const Plane& plane, const OpenRay& ray)
{
    constexpr double rounding = 1e-4; // of depth and of the plane's mean, as a share of the distance
    return std::abs(glm::dot(plane.normal_ws, ray.origin_ws) - plane.offset_m) <= rounding * ray.eye_m;
}

/// The camera's mirror image. A mirrored picture has its left and right exchanged; this one is turned back, so that
/// triangles keep their winding.
View mirrored(const View& view, const Plane& plane, double scale)
{
    const glm::dvec3 n = plane.normal_ws;
    glm::dmat4       reflection(glm::dmat3(1) - 2.0 * glm::outerProduct(n, n));
    reflection[3]           = glm::dvec4(2 * plane.offset_m * n, 1);
    View own                = view;
    own.world_to_view       = glm::dmat4(glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1)) * view.world_to_view * reflection;
    own.centre_px.x         = view.size_px.x - view.centre_px.x;
    own.size_px             = glm::max(glm::ivec2(glm::round(glm::dvec2(view.size_px) * scale)), glm::ivec2(1));
    const glm::dvec2 shrunk = glm::dvec2(own.size_px) / glm::dvec2(view.size_px);
    own.focal_px *= shrunk;
    own.centre_px *= shrunk;
    return own;
}

/// Depth of the plane in a camera on its other side; 0 where it is not in view.
std::vector<float> depth_of(const Plane& plane, const View& own)
{
    const glm::dvec3   normal = glm::dmat3(own.world_to_view) * plane.normal_ws;
    const glm::dvec3   point  = plane.offset_m * plane.normal_ws;
    const double       height = glm::dot(normal, glm::dvec3(own.world_to_view * glm::dvec4(point, 1)));
    std::vector<float> depth(pixel_count(own.size_px));
    for (size_t i = 0; i < depth.size(); ++i) {
        const glm::dvec3 sight      = px_to_vs(own, glm::dvec2(pixel_at(i, own.size_px)) + 0.5, 0.5);
        const double     distance_m = own.projection == Projection::perspective
                                          ? height / glm::dot(normal, sight / -sight.z)
                                          : (normal.x * sight.x + normal.y * sight.y - height) / normal.z;
        if (distance_m > 0 && std::isfinite(distance_m))
            depth[i] = static_cast<float>(distance_to_depth(own, distance_m));
    }
    return depth;
}

/// What a line of sight that begins in the plane shows: no pixel but its own can be in its way. nullopt for a ray that
/// crosses pixels, as from a bump of the mirror.
std::optional<RayAnswer> looked_up(const SourceContext& context, const GBufferImage& image, const OpenRay& ray)
{
    constexpr double              in_place_px = 0.5;
    const std::optional<SeenPart> part        = seen_part(image.view, ray);
    if (!part) return std::nullopt;
    const RayInput input = to_input(image.view, ray, *part);
    if (glm::length(glm::dvec2(input.delta_px_depth)) > in_place_px) return std::nullopt;
    const glm::ivec2 pixel =
        glm::clamp(glm::ivec2(glm::floor(glm::dvec2(input.origin_px_depth))), glm::ivec2(0), image.view.size_px - 1);
    const size_t i     = pixel_index(pixel, image.view.size_px);
    const double depth = double(image.depth[i]);
    RayAnswer    answer{.kind = AnswerKind::open};
    if (depth > 0 && depth_to_distance(image.view, depth) <=
                         depth_to_distance(image.view, input.origin_px_depth.z) + input.length_m) {
        const glm::vec2  gradient = image.gradient[i];
        const glm::dvec2 at_px(input.origin_px_depth), from_centre_px = at_px - (glm::dvec2(pixel) + 0.5);
        const double     sloped =
            std::isfinite(gradient.x + gradient.y) ? glm::dot(glm::dvec2(gradient), from_centre_px) : 0;
        set_point(answer, image, pixel, {at_px, depth + sloped}, true);
        // The sample itself, whatever its neighbours show.
        constexpr double at_centre_px = 0.1;
        answer.certain |= glm::length(from_centre_px) < at_centre_px;
    } else if (!part->leaves) {
        set_nothing(answer, context, ray, true);
    }
    return answer;
}

/// Answers those of `rays` that begin in the plane.
void ask_plane(SourceContext& context, const Plane& plane, std::span<const OpenRay> rays,
               std::shared_ptr<const DrawPipeline>& pipeline, SourceTurn& turn)
{
    Gpu&                     gpu = context.stage.gpu;
    const Stopwatch          preparing;
    const View               view   = mirrored(context.image.view, plane, context.parameters.at("scale"));
    const std::vector<float> before = depth_of(plane, view);
    turn.merge_ms += 1000 * preparing.seconds();
    const DrawnSides drawn = draw_sides_behind(gpu, context.stage.uploaded, view, before, pipeline);
    turn.draw_ms += drawn.ms;
    turn.megabytes += megabytes_of(*drawn.gbuffer) + double(before.size() * sizeof(float)) / 1e6;
    const GBufferImage   image = read_gbuffer(gpu, *drawn.gbuffer);
    const Stopwatch      looking_up;
    std::vector<OpenRay> crossing;
    std::vector<size_t>  places;
    for (size_t k = 0; k < rays.size(); ++k) {
        if (turn.answers[k].certain || !begins_in(plane, rays[k])) continue;
        OpenRay own = rays[k];
        own.clear_m = 0; // it is in sight from its beginning on
        if (const auto answer = looked_up(context, image, own)) {
            turn.answers[k] = merged(turn.answers[k], *answer);
            continue;
        }
        crossing.push_back(own);
        places.push_back(k);
    }
    turn.merge_ms += 1000 * looking_up.seconds();
    const GBufferTrace trace =
        trace_in_gbuffer(context, drawn.gbuffer, image, in_sight_settings(context.trace), RayStart::in_sight, crossing);
    turn.trace_ms += trace.ms;
    for (size_t k = 0; k < crossing.size(); ++k)
        turn.answers[places[k]] = merged(turn.answers[places[k]], trace.answers[k]);
}

SourceTurn answer(SourceContext& context, std::span<const OpenRay> rays)
{
    SourceTurn turn;
    for (const OpenRay& ray : rays) turn.answers.push_back({.kind = AnswerKind::open, .clear_m = ray.clear_m});
    std::vector<OpenRay>                left(rays.begin(), rays.end());
    std::shared_ptr<const DrawPipeline> pipeline;
    for (int asked = 0; asked < static_cast<int>(context.parameters.at("count")); ++asked) {
        const Stopwatch            finding;
        const std::optional<Plane> plane = largest_plane(context.image, left);
        turn.merge_ms += 1000 * finding.seconds();
        if (!plane) break;
        ask_plane(context, *plane, rays, pipeline, turn);
        std::erase_if(left, [&](const OpenRay& ray) { return begins_in(*plane, ray); });
    }
    return turn;
}

} // namespace

Source planar_source()
{
    return {.id = "planar",
            .summary =
                "The frame from the camera's mirror image in the largest flat mirror, for the rays of that mirror",
            .parameters = {integer_parameter("count", 1, 1, 8, "mirrors, the one with most rays first"),
                           real_parameter("scale", 1, 0.125, 2,
                                          "width and height of the mirrored frame, as a share of the picture's")},
            .answer     = answer};
}

} // namespace ssrlab
