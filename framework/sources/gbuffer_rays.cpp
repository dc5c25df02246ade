#include "sources/gbuffer_rays.h"

#include "core/pixel_index.h"
#include "trace/lab_passes.h"
#include "world/grid_walk.h"

#include <vulkan/vulkan_format_traits.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

glm::dvec3 to_view(const View& view, glm::dvec3 direction_ws) { return glm::dmat3(view.world_to_view) * direction_ws; }

glm::dvec3 point_vs(const View& view, const OpenRay& ray, double t_m)
{
    return glm::dvec3(view.world_to_view * glm::dvec4(ray.origin_ws + t_m * ray.direction_ws, 1));
}

/// x, y in pixels and depth at a distance along the ray, which may be infinite.
glm::dvec3 screen_point(const View& view, const OpenRay& ray, double t_m)
{
    if (t_m < infinity) return vs_to_px(view, point_vs(view, ray, t_m));
    const glm::dvec3 direction = to_view(view, ray.direction_ws);
    return {view.centre_px.x + view.focal_px.x * direction.x / -direction.z,
            view.centre_px.y - view.focal_px.y * direction.y / -direction.z, 0};
}

/// height + t * rate >= 0 from here on, or up to here.
void clip(SeenPart& part, double height, double rate)
{
    if (rate > 0) part.t_in_m = std::max(part.t_in_m, -height / rate);
    if (rate == 0 && height < 0) part.t_out_m = -infinity;
    if (rate >= 0 || -height / rate >= part.t_out_m) return;
    part.t_out_m = -height / rate;
    part.leaves  = true;
}

} // namespace

WorldRay to_world_ray(const OpenRay& ray, double t_min_m)
{
    const double t_max_m = std::min(ray.reach_m, double(std::numeric_limits<float>::max()) / 4);
    return {glm::vec3(ray.origin_ws), static_cast<float>(t_min_m), glm::vec3(ray.direction_ws),
            static_cast<float>(t_max_m), static_cast<float>(ray.roughness)};
}

std::optional<SeenPart> seen_part(const View& view, const OpenRay& ray)
{
    const glm::dvec3 p = point_vs(view, ray, 0), d = to_view(view, ray.direction_ws);
    SeenPart         part{ray.clear_m, ray.reach_m, false};
    const bool       perspective = view.projection == Projection::perspective;
    // By how much the nearer border lies inside, times the distance where that is what a pixel stands for.
    const double p_w = perspective ? -p.z : 1, d_w = perspective ? -d.z : 0;
    if (!perspective) clip(part, view.far_m + p.z, d.z);
    part.leaves = false; // the far plane ends a ray as its reach does
    clip(part, -p.z - view.near_m, -d.z);
    clip(part, view.focal_px.x * p.x + view.centre_px.x * p_w, view.focal_px.x * d.x + view.centre_px.x * d_w);
    clip(part, -view.focal_px.y * p.y + view.centre_px.y * p_w, -view.focal_px.y * d.y + view.centre_px.y * d_w);
    clip(part, (view.size_px.x - view.centre_px.x) * p_w - view.focal_px.x * p.x,
         (view.size_px.x - view.centre_px.x) * d_w - view.focal_px.x * d.x);
    clip(part, (view.size_px.y - view.centre_px.y) * p_w + view.focal_px.y * p.y,
         (view.size_px.y - view.centre_px.y) * d_w + view.focal_px.y * d.y);
    if (!(part.t_out_m > part.t_in_m)) return std::nullopt;
    return part;
}

RayInput to_input(const View& view, const OpenRay& ray, const SeenPart& part)
{
    const glm::dvec2 size = view.size_px;
    glm::dvec3       from = screen_point(view, ray, part.t_in_m), to = screen_point(view, ray, part.t_out_m);
    for (glm::dvec3* end : {&from, &to})
        for (int axis : {0, 1}) (*end)[axis] = std::clamp((*end)[axis], 0.0, size[axis]);
    return {from, to - from, part.t_out_m - part.t_in_m,
            part.leaves ? TraceStatus::left_screen : TraceStatus::past_max_distance, glm::ivec2(0)};
}

namespace {

/// The distance along the ray of a point on it, given on screen.
double metres_at(const View& view, const OpenRay& ray, glm::dvec3 at_px_depth)
{
    const glm::dvec3 at_vs = px_to_vs(view, glm::dvec2(at_px_depth), at_px_depth.z);
    return glm::dot(at_vs - point_vs(view, ray, 0), to_view(view, ray.direction_ws));
}

/// The distance in metres along the ray at which it is 2 pixels before a point on screen, or at its beginning.
double metres_before(const View& view, const OpenRay& ray, const SeenPart& part, glm::dvec3 at_px_depth)
{
    constexpr double back_px   = 2;
    const glm::dvec3 from      = screen_point(view, ray, part.t_in_m);
    const double     length_px = glm::length(glm::dvec2(at_px_depth - from));
    if (!(length_px > back_px)) return part.t_in_m;
    return std::max(part.t_in_m, metres_at(view, ray, glm::mix(at_px_depth, from, back_px / length_px)));
}

/// Whether the four pixels around a place of `pixel` show the same surface.
bool neighbours_agree(const GBufferImage& image, glm::ivec2 pixel, glm::dvec2 at_px)
{
    const View&      view     = image.view;
    const glm::ivec2 size     = view.size_px;
    const size_t     i        = pixel_index(pixel, size);
    const glm::vec2  gradient = image.gradient.empty() ? glm::vec2(0) : image.gradient[i];
    const double     depth    = double(image.depth[i]);
    if (!(depth > 0) || !std::isfinite(gradient.x) || !std::isfinite(gradient.y)) return false;
    // As far as a pixel is wide there. And a curved surface bends away from its plane by much less than the plane falls.
    const double     distance_m = depth_to_distance(view, depth);
    const double     wide_m     = (view.projection == Projection::perspective ? distance_m : 1) / view.focal_px.x;
    const double     covered    = depth - distance_to_depth(view, distance_m + wide_m);
    constexpr double curvature  = 0.5;
    const glm::ivec2 first      = glm::floor(at_px - 0.5);
    for (int y : {first.y, first.y + 1})
        for (int x : {first.x, first.x + 1}) {
            if (x < 0 || y < 0 || x >= size.x || y >= size.y) continue;
            const double fall = double(gradient.x) * (x - pixel.x) + double(gradient.y) * (y - pixel.y);
            const double own  = double(image.depth[pixel_index(glm::ivec2(x, y), size)]);
            if (std::abs(own - depth - fall) > covered + curvature * std::abs(fall)) return false;
        }
    return true;
}

} // namespace

double before_clear_end_m(const View& view, const OpenRay& ray)
{
    OpenRay whole                      = ray;
    whole.clear_m                      = 0;
    const std::optional<SeenPart> part = seen_part(view, whole);
    if (!part || ray.clear_m <= part->t_in_m || ray.clear_m >= part->t_out_m) return ray.clear_m;
    return metres_before(view, whole, *part, screen_point(view, ray, ray.clear_m));
}

void set_point(RayAnswer& answer, const GBufferImage& met, glm::ivec2 pixel, glm::dvec3 at_px_depth, bool in_sight)
{
    const size_t     i     = pixel_index(pixel, met.view.size_px);
    const glm::dvec3 at_vs = px_to_vs(met.view, glm::dvec2(at_px_depth), at_px_depth.z);
    answer.kind            = AnswerKind::point;
    answer.certain         = in_sight && neighbours_agree(met, pixel, glm::dvec2(at_px_depth));
    answer.point_ws        = glm::dvec3(glm::inverse(met.view.world_to_view) * glm::dvec4(at_vs, 1));
    answer.light           = met.radiance[i] + met.highlight[i];
}

void set_nothing(RayAnswer& answer, const SourceContext& context, const OpenRay& ray, bool certain)
{
    answer.kind    = AnswerKind::nothing;
    answer.certain = certain;
    answer.light   = sky_radiance(context.stage.scene, ray.direction_ws);
}

double cross_empty_cells(std::span<RayAnswer> answers, SourceContext& context, std::span<const OpenRay> rays)
{
    std::vector<WorldRay> listed;
    std::vector<size_t>   places;
    for (size_t k = 0; k < rays.size(); ++k) {
        if (answers[k].kind != AnswerKind::open || answers[k].clear_m == 0) continue;
        listed.push_back(to_world_ray(rays[k], answers[k].clear_m));
        places.push_back(k);
    }
    if (listed.empty()) return 0;
    const DeviceGrid& grid     = grid_of(context.stage);
    const GridWalk    walk     = walk_grid(context.stage.gpu, grid, listed);
    constexpr double  rounding = 1e-3; // of a cell: what is followed from here has rounded origins
    const glm::dvec3  cell_m   = grid.grid.cell_m;
    const double      back_m   = rounding * std::min({cell_m.x, cell_m.y, cell_m.z});
    for (size_t i = 0; i < places.size(); ++i) {
        RayAnswer& answer = answers[places[i]];
        if (std::isfinite(walk.met_m[i]))
            answer.clear_m = std::max(answer.clear_m, double(walk.met_m[i]) - back_m);
        else
            set_nothing(answer, context, rays[places[i]], true);
    }
    return walk.ms;
}

bool stays_in_sight(const SourceContext& context, const TraceSettings& settings)
{
    const Surface surface = find_surface(context.stage.catalogue.surfaces, std::string(settings.surface));
    const auto    has     = [&](const char* name) {
        return std::ranges::find(surface.defines, name) != surface.defines.end();
    };
    return settings.behind == Behind::stop && settings.layers == 1 && (has("SOLID_ENDLESS") || has("SURFACE_ENDLESS"));
}

bool begins_in_sight(const SourceContext& context, RayStart start, const OpenRay& ray)
{
    if (start != RayStart::from_frame) return start != RayStart::anywhere;
    // What the frame met, or passed behind, may fall between the pixels of another picture from there.
    const std::vector<TraceStatus>& frame = context.traced.status;
    return frame.empty() || !has_place(frame[ray.pixel]);
}

TraceSettings in_sight_settings(const TraceSettings& settings)
{
    TraceSettings in_sight = settings;
    in_sight.surface       = "plane_infinite";
    in_sight.behind        = Behind::stop;
    in_sight.layers        = 1;
    return in_sight;
}

double megabytes_of(const GBuffer& gbuffer)
{
    // The depth attachment that draws it is not among its images.
    double bytes = double(gbuffer.depth.cells.bytes) +
                   double(vk::blockSize(vk::Format::eD32Sfloat)) * double(pixel_count(gbuffer.view.size_px));
    for (const GpuImage* image :
         {&gbuffer.normal, &gbuffer.material, &gbuffer.dielectric, &gbuffer.radiance, &gbuffer.highlight,
          &gbuffer.emission, &gbuffer.object, &gbuffer.gradient, &gbuffer.solid})
        bytes += double(vk::blockSize(image->format)) * double(pixel_count(image->size_px));
    return bytes / 1e6;
}

RayAnswer to_answer(const SourceContext& context, const GBufferImage& image, const OpenRay& ray, const SeenPart& part,
                    const RayOutcome& outcome, glm::dvec3 at_px_depth, bool in_sight)
{
    RayAnswer answer{.kind = AnswerKind::open, .clear_m = ray.clear_m};
    if (outcome.status == TraceStatus::hit) {
        const GBufferImage& met = outcome.hit_layer == 0 ? image : image.layers[outcome.hit_layer - 1U];
        set_point(answer, met, outcome.hit_pixel, at_px_depth, in_sight);
    }
    if (outcome.status == TraceStatus::past_max_distance) set_nothing(answer, context, ray, in_sight);
    if (!in_sight) return answer;
    if (has_place(outcome.status)) answer.clear_m = metres_before(image.view, ray, part, at_px_depth);
    if (outcome.status == TraceStatus::left_screen && part.leaves) {
        const RayInput seen = to_input(image.view, ray, part);
        answer.clear_m      = metres_before(image.view, ray, part, seen.origin_px_depth + seen.delta_px_depth);
    }
    return answer;
}

namespace {

/// The plane that a pixel shows, in depth; empty where it shows none.
struct PixelPlane {
    glm::dvec3 centre_px_depth{0};
    glm::dvec2 slope{0};

    double above(glm::dvec3 at) const
    {
        return at.z - centre_px_depth.z - glm::dot(slope, glm::dvec2(at - centre_px_depth));
    }
    /// Less is the surface itself: depth and slope are rounded.
    double rounding() const { return (centre_px_depth.z + std::abs(slope.x) + std::abs(slope.y)) / 512; }
};

std::optional<PixelPlane> plane_of(const GBufferImage& image, glm::ivec2 pixel)
{
    const size_t     i     = pixel_index(pixel, image.view.size_px);
    const double     depth = double(image.depth[i]);
    const glm::dvec2 slope(image.gradient.empty() ? glm::vec2(0) : image.gradient[i]);
    if (!(depth > 0) || !std::isfinite(slope.x) || !std::isfinite(slope.y)) return std::nullopt;
    return PixelPlane{{glm::dvec2(pixel) + 0.5, depth}, slope};
}

/// Where the line of a ray crosses the borders of a pixel toward which it runs, along x and along y: its t.
glm::dvec2 border_t(const RayInput& ray, glm::ivec2 pixel)
{
    glm::dvec2 t(infinity);
    for (int axis : {0, 1}) {
        const double delta = ray.delta_px_depth[axis];
        if (delta != 0) t[axis] = (pixel[axis] + (delta > 0 ? 1 : 0) - ray.origin_px_depth[axis]) / delta;
    }
    return t;
}

/// Techniques leave the start pixel out, because a ray leaves its own surface there. In the picture of a camera
/// elsewhere, or where a ray is handed on in mid-air, it may meet what that pixel shows. leaves: it begins at its origin.
void meet_start_pixel(const GBufferImage& image, const RayInput& ray, bool leaves, RayOutcome& outcome)
{
    const glm::ivec2 pixel = glm::min(glm::ivec2(ray.origin_px_depth), image.view.size_px - 1);
    const auto       plane = plane_of(image, pixel);
    if (!plane) return;
    const glm::dvec2 next  = border_t(ray, pixel);
    const double     t_out = std::min({1.0, next.x, next.y});
    const double     from  = plane->above(ray.origin_px_depth),
                 to        = plane->above(ray.origin_px_depth + t_out * ray.delta_px_depth);
    if (from <= (leaves ? plane->rounding() : -plane->rounding()) || to > 0 || to >= from) return;
    outcome   = {.status = TraceStatus::hit, .hit_pixel = pixel};
    outcome.t = from > 0 ? t_out * from / (from - to) : 0;
}

/// Has a ray that leaves a surface met this very surface? A plane that holds its origin is not met again.
bool meets_own_surface(const GBufferImage& image, const RayInput& ray, const RayOutcome& outcome)
{
    constexpr double near_px = 2;
    if (!has_place(outcome.status) || outcome.hit_layer > 0 ||
        outcome.t * glm::length(glm::dvec2(ray.delta_px_depth)) > near_px)
        return false;
    const auto plane = plane_of(image, outcome.hit_pixel);
    return plane && std::abs(plane->above(ray.origin_px_depth)) <= plane->rounding();
}

/// Does nothing that the picture shows lie before the place where a ray begins?
bool is_shown(const GBufferImage& image, const RayInput& ray)
{
    const auto plane = plane_of(image, glm::min(glm::ivec2(ray.origin_px_depth), image.view.size_px - 1));
    return !plane || plane->above(ray.origin_px_depth) >= 0;
}

} // namespace

bool may_meet_behind(const GBufferImage& layer, const Occupancy& grid, const OpenRay& ray, double to_m)
{
    const View&                   view = layer.view;
    const std::optional<SeenPart> part = seen_part(view, ray);
    if (!part) return false;
    const RayInput seen  = to_input(view, ray, *part);
    glm::dvec3     at    = seen.origin_px_depth;
    glm::ivec2     pixel = glm::min(glm::ivec2(at), view.size_px - 1);
    while (glm::all(glm::greaterThanEqual(pixel, glm::ivec2(0))) && glm::all(glm::lessThan(pixel, view.size_px))) {
        const double in_m = metres_at(view, ray, at);
        if (in_m >= to_m) return false;
        const glm::dvec2 next  = border_t(seen, pixel);
        const double     t_out = std::min({1.0, next.x, next.y});
        const glm::dvec3 out   = seen.origin_px_depth + t_out * seen.delta_px_depth;
        const auto       plane = plane_of(layer, pixel);
        if (plane && plane->above(at) < 0 &&
            may_meet(grid, ray.origin_ws, ray.direction_ws, in_m, std::min(to_m, metres_at(view, ray, out))))
            return true;
        if (t_out == 1) return false;
        for (int axis : {0, 1}) pixel[axis] += next[axis] > t_out ? 0 : seen.delta_px_depth[axis] > 0 ? 1 : -1;
        at = out;
    }
    return false;
}

GBufferTrace trace_in_gbuffer(SourceContext& context, const GBufferPtr& gbuffer, const GBufferImage& image,
                              const TraceSettings& settings, RayStart start, std::span<const OpenRay> rays)
{
    std::vector<RayInput> inputs;
    std::vector<SeenPart> parts;
    std::vector<size_t>   asked;
    GBufferTrace          trace;
    for (size_t k = 0; k < rays.size(); ++k) {
        trace.answers.push_back({.kind = AnswerKind::open, .clear_m = rays[k].clear_m});
        const std::optional<SeenPart> part = seen_part(gbuffer->view, rays[k]);
        if (!part) continue;
        const RayInput input = to_input(gbuffer->view, rays[k], *part);
        if (start == RayStart::if_shown && !is_shown(image, input)) continue;
        inputs.push_back(input);
        parts.push_back(*part);
        asked.push_back(k);
    }
    trace.status.resize(rays.size());
    trace.left_at_m.resize(rays.size());
    if (inputs.empty()) return trace;
    const LabPtr            lab = make_lab(context.stage.gpu, context.stage.catalogue, gbuffer, context.lab->technique,
                                           context.lab->values, settings);
    const TracerPtr         tracer   = make_timed_tracer(context.stage.gpu, lab, inputs.size());
    std::vector<RayOutcome> outcomes = trace_rays(context.stage.gpu, *tracer, inputs);
    trace.ms                         = time_trace(context.stage.gpu, *tracer);
    if (context.watch) context.watch({gbuffer, image, settings, inputs, outcomes});
    const bool stays = stays_in_sight(context, settings);
    for (size_t k = 0; k < inputs.size(); ++k) {
        const size_t ray      = asked[k];
        const double slack_m  = 1e-6 * (rays[ray].eye_m + parts[k].t_in_m);
        const bool   leaves   = parts[k].t_in_m <= slack_m;
        const bool   in_sight = stays && begins_in_sight(context, start, rays[ray]) &&
                              parts[k].t_in_m <= rays[ray].clear_m + slack_m; // from its beginning on
        meet_start_pixel(image, inputs[k], leaves, outcomes[k]);
        if (leaves && meets_own_surface(image, inputs[k], outcomes[k])) continue;
        const glm::dvec3 at  = inputs[k].origin_px_depth + outcomes[k].t * inputs[k].delta_px_depth;
        trace.answers[ray]   = to_answer(context, image, rays[ray], parts[k], outcomes[k], at, in_sight);
        trace.status[ray]    = outcomes[k].status;
        trace.left_at_m[ray] = parts[k].t_out_m;
    }
    return trace;
}

void ask_elsewhere(const SourceContext& context, std::span<const OpenRay> rays, std::vector<RayAnswer>& answers,
                   const TraceElsewhere& trace)
{
    TraceSettings in_passing = context.trace;
    in_passing.surface       = "plane";
    in_passing.behind        = Behind::stop; // what comes out from behind a surface has met something there
    in_passing.layers        = 1;
    const auto ask           = [&](const TraceSettings& settings, RayStart start) {
        std::vector<OpenRay> open;
        std::vector<size_t>  places;
        for (size_t k = 0; k < rays.size(); ++k) {
            if (answers[k].kind == AnswerKind::point) continue;
            open.push_back(rays[k]);
            places.push_back(k);
        }
        const std::vector<RayAnswer> found = trace(settings, start, open);
        for (size_t k = 0; k < open.size(); ++k)
            if (found[k].kind == AnswerKind::point) answers[places[k]] = merged(answers[places[k]], found[k]);
    };
    ask(in_sight_settings(context.trace), RayStart::in_sight);
    ask(in_passing, RayStart::anywhere);
}

} // namespace ssrlab
