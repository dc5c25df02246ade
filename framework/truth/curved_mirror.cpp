#include "truth/curved_mirror.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity      = std::numeric_limits<double>::infinity();
constexpr double difference_px = 0.05; // of derivatives: far above the rounding of normals, far below a triangle
constexpr double converged_px  = 1e-3; // length of the last step
constexpr double same_px       = 0.05; // answers that are one
constexpr double largest_px    = 24;   // of a step
constexpr int    most_steps    = 40;
constexpr int    most_halvings = 6;
constexpr int    most_undrawn  = 16; // backs in front of the first drawn surface

/// At a point of the triangle's plane: Embree's weights are rounded to float, with the ray.
glm::dvec3 normal_at(const Scene& scene, SurfacePoint surface, glm::dvec3 point_ws)
{
    const glm::dvec3 a = corner_ws(scene, surface, 0), u = corner_ws(scene, surface, 1) - a,
                     v = corner_ws(scene, surface, 2) - a, n = glm::cross(u, v), p = point_ws - a;
    surface.barycentric = glm::dvec2(glm::dot(glm::cross(p, v), n), glm::dot(glm::cross(u, p), n)) / glm::dot(n, n);
    return shading_normal_ws(scene, surface);
}

/// A mirror ray at a position of the image.
struct MirrorRay {
    glm::dvec3 leaving_ws{0}; // unit
    glm::dvec3 towards_ws{0}; // the target; unit
};

/// Empty where the position does not show the mirror, or the ray points away from the target.
std::optional<MirrorRay> mirror_ray(const Sight& sight, uint32_t mirror, glm::dvec4 target_ws, glm::dvec2 at_px)
{
    const SceneHit hit = sight.first_drawn(at_px);
    if (!hit.met || hit.surface.draw != mirror) return std::nullopt;
    const SceneRay   ray      = sight.ray(at_px);
    const glm::dvec3 point_ws = ray.origin_ws + hit.t * ray.direction_ws;
    const MirrorRay  result{
        glm::reflect(glm::normalize(ray.direction_ws), normal_at(sight.bvh().scene(), hit.surface, point_ws)),
        glm::normalize(glm::dvec3(target_ws) - target_ws.w * point_ws)};
    if (!(glm::dot(result.leaving_ws, result.towards_ws) > 0)) return std::nullopt;
    return result;
}

std::optional<glm::dvec2> newton(const Sight& sight, uint32_t mirror, glm::dvec4 target_ws, glm::dvec2 at_px)
{
    const auto start = mirror_ray(sight, mirror, target_ws, at_px);
    if (!start) return std::nullopt;
    // Two directions across the one to the target, the same at every position, so that the miss is smooth.
    const glm::dvec3 side    = std::abs(start->towards_ws.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 across  = glm::normalize(glm::cross(start->towards_ws, side));
    const glm::dvec3 upward  = glm::cross(start->towards_ws, across);
    const auto       miss_at = [&](glm::dvec2 position_px) -> std::optional<glm::dvec2> {
        const auto ray = mirror_ray(sight, mirror, target_ws, position_px);
        if (!ray) return std::nullopt;
        const glm::dvec3 miss = ray->leaving_ws - ray->towards_ws;
        return glm::dvec2(glm::dot(miss, across), glm::dot(miss, upward));
    };
    const auto derivative_along = [&](glm::dvec2 axis) -> std::optional<glm::dvec2> {
        const auto after = miss_at(at_px + difference_px * axis), before = miss_at(at_px - difference_px * axis);
        if (!after || !before) return std::nullopt;
        return (*after - *before) / (2 * difference_px);
    };
    auto value = miss_at(at_px);
    for (int i = 0; value && i < most_steps; ++i) {
        const auto right = derivative_along({1, 0}), down = derivative_along({0, 1});
        if (!right || !down) return std::nullopt;
        const glm::dmat2 derivative(*right, *down);
        if (glm::determinant(derivative) == 0) return std::nullopt;
        glm::dvec2 step = -(glm::inverse(derivative) * *value);
        if (glm::length(step) < converged_px) return at_px + step;
        if (glm::length(step) > largest_px) step *= largest_px / glm::length(step);
        auto       next   = miss_at(at_px + step);
        const auto better = [&] { return next && glm::length(*next) < glm::length(*value); };
        for (int k = 0; k < most_halvings && !better(); ++k) next = miss_at(at_px + (step *= 0.5));
        if (!better()) return std::nullopt;
        at_px += step;
        value = next;
    }
    return std::nullopt;
}

} // namespace

Sight::Sight(const SceneBvh& bvh, const View& view)
    : bvh_(bvh), view_(view), view_to_world_(glm::inverse(view.world_to_view))
{
}

SceneRay Sight::ray(glm::dvec2 at_px) const
{
    const glm::dvec2 offset = (at_px - view_.centre_px) / view_.focal_px * glm::dvec2(1, -1);
    const bool       flat   = view_.projection == Projection::orthographic;
    const glm::dvec4 origin_vs(flat ? offset : glm::dvec2(0), 0, 1), direction_vs(flat ? glm::dvec2(0) : offset, -1, 0);
    // t is the distance along the view axis.
    return {glm::dvec3(view_to_world_ * origin_vs), glm::dvec3(view_to_world_ * direction_vs), view_.near_m, infinity};
}

SceneHit Sight::first_drawn(glm::dvec2 at_px) const
{
    SceneRay     ray   = this->ray(at_px);
    const Scene& scene = bvh_.scene();
    SceneHit     hit;
    for (int i = 0; i < most_undrawn; ++i) {
        bvh_.intersect(std::span(&ray, 1), std::span(&hit, 1));
        if (!hit.met || glm::dot(hit.normal_ws, ray.direction_ws) < 0 ||
            scene.materials[scene.draws[hit.surface.draw].material].double_sided)
            return hit;
        ray.t_min = hit.t * (1 + 1e-6);
    }
    return {};
}

std::optional<glm::dvec2> Sight::project(glm::dvec4 at_ws) const
{
    const glm::dvec4 at_vs = view_.world_to_view * at_ws;
    if (view_.projection == Projection::orthographic) {
        // A direction off the view axis leaves every image.
        if (at_vs.w == 0) return std::nullopt;
        return glm::dvec2(vs_to_px(view_, glm::dvec3(at_vs)));
    }
    if (!(-at_vs.z > 0)) return std::nullopt;
    return view_.centre_px + view_.focal_px * glm::dvec2(at_vs.x, -at_vs.y) / -at_vs.z;
}

std::optional<glm::dvec2> curved_reflection(const Sight& sight, uint32_t mirror, glm::dvec4 reflected_ws,
                                            std::span<const glm::dvec2> starts_px)
{
    std::optional<glm::dvec2> answer;
    for (const glm::dvec2& start_px : starts_px) {
        const auto found = newton(sight, mirror, reflected_ws, start_px);
        if (!found) continue;
        if (answer && glm::length(*found - *answer) > same_px) return std::nullopt;
        answer = found;
    }
    return answer;
}

} // namespace ssrlab
