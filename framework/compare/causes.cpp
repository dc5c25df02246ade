#include "compare/causes.h"

#include "compare/validate_result.h"
#include "core/parallel_rows.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr double plane_share  = 1.0 / 256; // of the distance: how far off its plane a point counts as on it
constexpr double jump_share   = 1.0 / 32;  // of the distance: a bend becomes a silhouette
constexpr double passed_share = 1.0 / 64;  // of the way: how much farther than the true point counts as behind it

/// The G-buffer of the layer in which a ray ended.
const GBufferImage& met_image(const GBufferImage& gbuffer, const TraceImage& tested, size_t i)
{
    const size_t layer = tested.hit_layer[i];
    return layer == 0 ? gbuffer : gbuffer.layers[layer - 1];
}

glm::dvec2 gradient_at(const GBufferImage& image, size_t pixel)
{
    if (image.gradient.empty()) return {0, 0};
    const glm::dvec2 gradient(image.gradient[pixel]);
    return std::isfinite(gradient.x) && std::isfinite(gradient.y) ? gradient : glm::dvec2(0);
}

/// How far, as a share of its distance, a point lies behind a pixel's plane; negative: before it.
double behind_plane(const GBufferImage& image, glm::ivec2 pixel, glm::dvec2 position_px, double distance_m)
{
    const size_t p = pixel_index(pixel, image.view.size_px);
    const double depth =
        double(image.depth[p]) + glm::dot(gradient_at(image, p), position_px - (glm::dvec2(pixel) + 0.5));
    return depth > 0 ? distance_m / depth_to_distance(image.view, depth) - 1 : -1;
}

template <typename Test> bool any_around(const GBufferImage& image, glm::ivec2 pixel, const Test& test)
{
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y)
        for (int x = pixel.x - 1; x <= pixel.x + 1; ++x) {
            const glm::ivec2 other(x, y);
            if (other == pixel || x < 0 || y < 0 || x >= image.view.size_px.x || y >= image.view.size_px.y) continue;
            if (test(other)) return true;
        }
    return false;
}

/// Is a neighbour's sample farther off this pixel's plane than such a share of its distance?
bool leaves_plane(const GBufferImage& image, glm::ivec2 pixel, double share)
{
    return any_around(image, pixel, [&](glm::ivec2 other) {
        const double depth = double(image.depth[pixel_index(other, image.view.size_px)]);
        if (!(depth > 0)) return true;
        const double distance_m = depth_to_distance(image.view, depth);
        return std::abs(behind_plane(image, pixel, glm::dvec2(other) + 0.5, distance_m)) > share;
    });
}

/// Of the surface in a pixel, toward the camera: that of its plane, or the shading normal without one.
glm::dvec3 plane_normal_vs(const GBufferImage& image, glm::ivec2 pixel, glm::dvec3 sight)
{
    const View&      view = image.view;
    const size_t     p    = pixel_index(pixel, view.size_px);
    const glm::dvec2 g    = gradient_at(image, p), slope(g.x * view.focal_px.x, -g.y * view.focal_px.y);
    glm::dvec3       normal(image.normal_vs[p]);
    if (!image.gradient.empty() && std::isfinite(image.gradient[p].x) && std::isfinite(image.gradient[p].y))
        normal = view.projection == Projection::orthographic
                     ? glm::dvec3(-slope * (view.far_m - view.near_m), 1)
                     : glm::dvec3(slope, slope.x * sight.x + slope.y * sight.y - double(image.depth[p]));
    return glm::normalize(glm::dot(normal, sight) > 0 ? -normal : normal);
}

class Causes {
public:
    Causes(const TraceImage& tested, const SceneTruth& truth, const GBufferImage& gbuffer)
        : tested_(tested), truth_(truth), gbuffer_(gbuffer)
    {
    }

    WrongCause of(size_t i) const
    {
        if (!is_wrong(i)) return WrongCause::right;
        if (meets_own_surface(i)) return WrongCause::own_surface;
        if (!ends_before_truth(i))
            return truth_.cls[i] == TruthClass::visible ? at_true_point(i) : WrongCause::not_shown;
        const GBufferImage& met   = met_image(gbuffer_, tested_, i);
        const glm::ivec2    pixel = tested_.hit_pixel[i];
        if (leaves_plane(met, pixel, jump_share)) return WrongCause::silhouette;
        if (leaves_plane(met, pixel, plane_share)) return WrongCause::edge;
        return tested_.status[i] == TraceStatus::stopped ? WrongCause::stopped : WrongCause::other;
    }

private:
    bool hits(size_t i) const { return tested_.status[i] == TraceStatus::hit; }

    bool is_wrong(size_t i) const
    {
        const TruthClass cls = truth_.cls[i];
        if (cls == TruthClass::not_traced) return false;
        const bool findable =
            cls == TruthClass::visible || (cls == TruthClass::hidden && hits(i) && tested_.hit_layer[i] > 0);
        const bool near = hits(i) && findable &&
                          screen_distance_px(glm::dvec2(tested_.hit_px_depth[i]), truth_.point_px[i]) <= within_one_px;
        return !near && (hits(i) || cls == TruthClass::visible);
    }

    glm::ivec2 pixel_of(size_t i) const { return pixel_at(i, gbuffer_.view.size_px); }

    glm::dvec3 start_vs(size_t i) const
    {
        return px_to_vs(gbuffer_.view, glm::dvec2(pixel_of(i)) + 0.5, double(gbuffer_.depth[i]));
    }

    bool meets_own_surface(size_t i) const
    {
        const bool       perspective = gbuffer_.view.projection == Projection::perspective;
        const glm::dvec3 start = start_vs(i), sight = perspective ? start / -start.z : glm::dvec3(0, 0, -1);
        const glm::dvec3 shading(glm::normalize(glm::dvec3(gbuffer_.normal_vs[i])));
        const glm::dvec3 mirrored = sight - 2 * glm::dot(shading, sight) * shading;
        const glm::dvec3 normal   = plane_normal_vs(gbuffer_, pixel_of(i), sight);
        if (glm::dot(normal, mirrored) <= 0) return true;
        if (!has_place(tested_.status[i])) return false;
        const size_t     met = pixel_index(tested_.hit_pixel[i], gbuffer_.view.size_px);
        const glm::dvec3 way =
            px_to_vs(gbuffer_.view, glm::dvec2(tested_.hit_px_depth[i]), tested_.hit_px_depth[i].z) - start;
        return met_image(gbuffer_, tested_, i).object_id[met] == gbuffer_.object_id[i] &&
               glm::dot(normal, way) <= self_hit_sine * glm::length(way);
    }

    /// Did the ray end, by a hit or by being stopped, before its true point?
    bool ends_before_truth(size_t i) const
    {
        if (!has_place(tested_.status[i])) return false;
        const glm::dvec3 end = tested_.hit_px_depth[i];
        const double     way = glm::length(px_to_vs(gbuffer_.view, glm::dvec2(end), end.z) - start_vs(i));
        return way <= truth_.distance_m[i] * (1 + passed_share);
    }

    /// The ray passed a true point that the frame shows.
    WrongCause at_true_point(size_t i) const
    {
        const glm::ivec2 last  = gbuffer_.view.size_px - 1;
        const glm::ivec2 pixel = glm::clamp(glm::ivec2(glm::floor(truth_.point_px[i])), glm::ivec2(0), last);
        const auto       holds = [&](glm::ivec2 other) {
            return std::abs(behind_plane(gbuffer_, other, truth_.point_px[i], -truth_.point_vs[i].z)) <= plane_share;
        };
        if (!holds(pixel)) return any_around(gbuffer_, pixel, holds) ? WrongCause::silhouette : WrongCause::thin;
        if (leaves_plane(gbuffer_, pixel, jump_share)) return WrongCause::silhouette;
        return leaves_plane(gbuffer_, pixel, plane_share) ? WrongCause::edge : WrongCause::other;
    }

    const TraceImage&   tested_;
    const SceneTruth&   truth_;
    const GBufferImage& gbuffer_;
};

} // namespace

std::vector<WrongCause> wrong_causes(const TraceImage& tested, const SceneTruth& truth, const GBufferImage& gbuffer)
{
    require_same_size(tested.size_px, truth.size_px);
    require_same_size(tested.size_px, gbuffer.view.size_px);
    require_possible(tested);
    const Causes            causes(tested, truth, gbuffer);
    std::vector<WrongCause> found(truth.cls.size());
    parallel_pixels(tested.size_px.x, tested.size_px.y, [&](size_t i) { found[i] = causes.of(i); });
    return found;
}

MeasureValues count_causes(const TraceImage& tested, const SceneTruth& truth, const GBufferImage& gbuffer)
{
    std::array<size_t, wrong_cause_names.size()> of_cause{};
    for (const WrongCause cause : wrong_causes(tested, truth, gbuffer)) ++of_cause[size_t(cause)];
    const size_t  rays  = truth.cls.size() - size_t(std::ranges::count(truth.cls, TruthClass::not_traced));
    const size_t  wrong = truth.cls.size() - of_cause[size_t(WrongCause::right)];
    MeasureValues values{{"wrong_rays", share(wrong, rays)}};
    for (const Measure& measure : measures()) {
        if (!measure.name.starts_with("wrong_") || measure.name == "wrong_rays") continue;
        const auto name      = std::ranges::find(wrong_cause_names, measure.name.substr(6));
        values[measure.name] = share(of_cause[size_t(name - wrong_cause_names.begin())], rays);
    }
    return values;
}

} // namespace ssrlab
