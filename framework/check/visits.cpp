// The pixels that a ray visits, and the hit contract's answer from them.
#include "check/judge.h"

#include "core/pixel_index.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Direction in view space, not normalised; as shaders/api/trace_api.glsl, direction_vs.
glm::dvec3 direction_vs(const View& view, const RayInput& ray)
{
    const auto       slope = [&](glm::dvec2 px) { return (px - view.centre_px) / view.focal_px * glm::dvec2(1, -1); };
    const glm::dvec2 from  = slope(glm::dvec2(ray.origin_px_depth)),
                     to    = slope(glm::dvec2(ray.origin_px_depth + ray.delta_px_depth));
    if (view.projection == Projection::orthographic)
        return {to - from, ray.delta_px_depth.z * (view.far_m - view.near_m)};
    const double from_depth = ray.origin_px_depth.z, to_depth = from_depth + ray.delta_px_depth.z;
    return {to * from_depth - from * to_depth, to_depth - from_depth};
}

/// 0 where one of them has no direction.
double cosine(glm::dvec3 a, glm::dvec3 b)
{
    const double lengths = glm::length(a) * glm::length(b);
    return lengths > 0 ? glm::dot(a, b) / lengths : 0;
}

} // namespace

bool on_image(const GBufferImage& gbuffer, glm::ivec2 pixel)
{
    return glm::all(glm::greaterThanEqual(pixel, glm::ivec2(0))) &&
           glm::all(glm::lessThan(pixel, gbuffer.view.size_px));
}

glm::ivec2 start_pixel(const GBufferImage& gbuffer, const RayInput& ray)
{
    return glm::clamp(glm::ivec2(glm::floor(glm::dvec2(ray.origin_px_depth))), glm::ivec2(0), gbuffer.view.size_px - 1);
}

double depth_inside_px(const RayInput& ray, const Visit& visit)
{
    const auto inside = [&](double t) {
        const glm::dvec2 p =
            glm::dvec2(ray.origin_px_depth) + t * glm::dvec2(ray.delta_px_depth) - glm::dvec2(visit.pixel);
        return std::min({p.x, 1 - p.x, p.y, 1 - p.y});
    };
    // Concave in t: ternary search.
    double from = visit.t_in, to = visit.t_out;
    for (int i = 0; i < 60; ++i) {
        const double a = from + (to - from) / 3, b = to - (to - from) / 3;
        (inside(a) < inside(b) ? from : to) = inside(a) < inside(b) ? a : b;
    }
    return inside(0.5 * (from + to));
}

Visit Judge::visit(const RayInput& ray, glm::ivec2 pixel, int layer, double t_in, double t_out, bool sampled) const
{
    const GBufferImage& image = layer_of(setup_.gbuffer, layer);
    const size_t        index = pixel_index(pixel, image.view.size_px);
    const RayPart       part{ray.origin_px_depth, ray.delta_px_depth, t_in, t_out};
    const auto          in = part.at(t_in), out = part.at(t_out);
    Visit               visit{pixel, t_in, t_out, in.z, out.z, {}};
    visit.contact    = -infinity;
    visit.layer      = layer;
    const auto found = pixel_surface(setup_.gbuffer, layer, index, setup_.settings);
    if (!found || image.depth[index] > 1) return visit;
    const PixelSurface& surface = visit.surface = *found;

    const glm::dvec2 from(in), to(out);
    visit.over_back_in      = in.z - surface.back_at(from);
    visit.over_back_out     = out.z - surface.back_at(to);
    const double over_front = std::min(in.z - surface.front_at(from), out.z - surface.front_at(to));
    const double in_solid   = std::max(in.z, out.z) - surface.solid_back;
    const double slab       = slab_back(image.view, static_cast<double>(image.depth[index]), setup_.settings);
    if (sampled) visit.sampled_more = std::max(surface.back - slab, 0.0);
    const double over_back = std::max(visit.over_back_in, visit.over_back_out) + visit.sampled_more;
    visit.contact =
        surface.from_outside ? outside_in(surface, part) : std::min(-over_front, std::max(over_back, in_solid));
    if (setup_.settings.behind != Behind::hit)
        visit.facing = cosine(glm::dvec3(image.normal_vs[index]), direction_vs(image.view, ray));
    return visit;
}

std::vector<Visit> Judge::walk(const RayInput& ray) const
{
    std::vector<Visit> visits;
    glm::ivec2         pixel = start_pixel(setup_.gbuffer, ray), step(0);
    glm::dvec2         inverse(0);
    for (int axis : {0, 1}) {
        const double delta = ray.delta_px_depth[axis];
        if (delta == 0 || !std::isfinite(1.0 / delta)) continue;
        step[axis]    = delta > 0 ? 1 : -1;
        inverse[axis] = 1.0 / delta;
    }
    const auto border_t = [&](int axis) {
        if (step[axis] == 0) return infinity;
        return (pixel[axis] + (step[axis] > 0 ? 1 : 0) - ray.origin_px_depth[axis]) * inverse[axis];
    };
    glm::dvec2 t(border_t(0), border_t(1));
    while (std::min(t.x, t.y) < 1) {
        const double t_in = std::min(t.x, t.y);
        for (int axis : {0, 1}) pixel[axis] += t[axis] <= t_in ? step[axis] : 0;
        if (!on_image(setup_.gbuffer, pixel)) break;
        t = {border_t(0), border_t(1)};
        for (int layer = 0; layer < layer_count(setup_.gbuffer, setup_.settings); ++layer)
            visits.push_back(visit(ray, pixel, layer, t_in, std::min({t.x, t.y, 1.0})));
    }
    return visits;
}

RayOutcome Judge::exact_answer(const RayInput& ray) const
{
    RayOutcome answer;
    answer.status = ray.end_status;
    for (const Visit& v : walk(ray)) {
        const bool ended = has_place(answer.status);
        if (ended && v.pixel != answer.hit_pixel) break;
        answer.steps += v.layer == 0;
        if (!(v.contact >= 0)) continue;
        const Meeting meeting = meet(v.surface, {ray.origin_px_depth, ray.delta_px_depth, v.t_in, v.t_out}, v.facing);
        if (!meeting.meets) continue;
        const bool behind = meeting.from_behind && setup_.settings.behind != Behind::hit;
        if (behind && setup_.settings.behind == Behind::pass) {
            if (!ended) answer.status = TraceStatus::facing_away;
            continue;
        }
        if (ended && meeting.t >= answer.t) continue; // a layer in front of it is met no later
        answer.status    = behind ? TraceStatus::stopped : TraceStatus::hit;
        answer.hit_pixel = v.pixel;
        answer.t         = meeting.t;
        answer.hit_layer = static_cast<uint8_t>(v.layer);
    }
    return answer;
}

} // namespace ssrlab
