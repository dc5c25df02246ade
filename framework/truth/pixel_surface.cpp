#include "truth/pixel_surface.h"

#include "core/error.h"
#include "core/pixel_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Depth of what lies `thickness` behind a pixel (before it, if negative); +inf where that is at the eye or nearer.
double shifted(const View& view, double depth, double thickness, bool relative)
{
    const double distance_m  = depth_to_distance(view, depth);
    const double thickness_m = relative ? thickness * distance_m : thickness;
    if (distance_m + thickness_m <= 0) return infinity;
    if (view.projection == Projection::orthographic) return depth - thickness_m / (view.far_m - view.near_m);
    // Written as depth / (1 + ...) because that is exactly `depth` when the thickness is 0.
    const double divisor = 1.0 + (relative ? thickness : thickness * depth / view.near_m);
    return divisor > 0 ? depth / divisor : infinity;
}

PixelSurface box(const GBufferImage& gbuffer, size_t /*index*/, double depth, const TraceSettings& settings)
{
    return {.front = depth, .back = slab_back(gbuffer.view, depth, settings)};
}

PixelSurface box_two_sided(const GBufferImage& gbuffer, size_t /*index*/, double depth, const TraceSettings& settings)
{
    return {.front = slab_front(gbuffer.view, depth, settings), .back = slab_back(gbuffer.view, depth, settings)};
}

PixelSurface box_infinite(const GBufferImage& /*gbuffer*/, size_t /*index*/, double depth,
                          const TraceSettings& /*settings*/)
{
    return {.front = depth, .back = -infinity};
}

PixelSurface plane(const View& view, double depth, glm::dvec2 gradient)
{
    return {
        .front = depth, .back = depth - plane_tolerance(view, depth), .gradient = gradient, .sides_by_height = true};
}

std::optional<glm::dvec2> usable_gradient(const GBufferImage& gbuffer, size_t index)
{
    const glm::dvec2 gradient(gbuffer.gradient[index]);
    return std::isfinite(gradient.x) && std::isfinite(gradient.y) ? std::optional(gradient) : std::nullopt;
}

/// The plane of a pixel, or its box where it has no usable plane.
PixelSurface plane_or_box(const GBufferImage& gbuffer, size_t index, double depth, const TraceSettings& settings)
{
    const auto   gradient   = usable_gradient(gbuffer, index);
    PixelSurface surface    = gradient ? plane(gbuffer.view, depth, *gradient) : box(gbuffer, index, depth, settings);
    surface.sides_by_height = true;
    return surface;
}

PixelSurface plane_and_solid(const GBufferImage& gbuffer, size_t index, double depth, const TraceSettings& settings)
{
    PixelSurface surface = plane_or_box(gbuffer, index, depth, settings);
    if (!gbuffer.solid_back.empty() && gbuffer.solid_back[index] > 0) surface.solid_back = gbuffer.solid_back[index];
    return surface;
}

PixelSurface plane_infinite(const GBufferImage& gbuffer, size_t index, double depth, const TraceSettings& settings)
{
    PixelSurface surface = plane_or_box(gbuffer, index, depth, settings);
    surface.solid_back   = -infinity;
    return surface;
}

/// The next layer, where the solid behind this one ends there.
std::optional<Face> far_side(const GBufferImage& gbuffer, int layer, size_t index, const TraceSettings& settings)
{
    if (layer < 0 || layer + 1 >= layer_count(gbuffer, settings)) return std::nullopt;
    const GBufferImage& held   = layer_of(gbuffer, layer);
    const GBufferImage& behind = layer_of(gbuffer, layer + 1);
    const float         depth  = behind.depth[index];
    if (held.solid_back.empty() || !(depth > 0) || depth != held.solid_back[index]) return std::nullopt;
    return Face{double(depth), usable_gradient(behind, index).value_or(glm::dvec2(0))};
}

PixelSurface plane_of_sides(const GBufferImage& gbuffer, int layer, size_t index, double depth,
                            const TraceSettings& settings)
{
    return {.front        = depth,
            .back         = depth,
            .gradient     = usable_gradient(layer_of(gbuffer, layer), index).value_or(glm::dvec2(0)),
            .from_outside = true,
            .is_far_side  = far_side(gbuffer, layer - 1, index, settings).has_value(),
            .far_side     = far_side(gbuffer, layer, index, settings)};
}

struct Model {
    std::string_view id;
    PixelSurface (*held_by)(const GBufferImage&, int layer, size_t index, double depth, const TraceSettings&);
    bool needs_gradients = false;
};

/// A model whose layers do not know of each other.
template <PixelSurface (*held_by)(const GBufferImage&, size_t index, double depth, const TraceSettings&)>
PixelSurface layer_alone(const GBufferImage& gbuffer, int layer, size_t index, double depth,
                         const TraceSettings& settings)
{
    return held_by(layer_of(gbuffer, layer), index, depth, settings);
}

constexpr std::array models = {Model{"box", layer_alone<box>},
                               Model{"box_two_sided", layer_alone<box_two_sided>},
                               Model{"box_infinite", layer_alone<box_infinite>},
                               Model{"plane", layer_alone<plane_or_box>, true},
                               Model{"plane_solid", layer_alone<plane_and_solid>, true},
                               Model{"plane_infinite", layer_alone<plane_infinite>, true},
                               Model{"plane_sides", plane_of_sides, true}};

const Model& model_of(const TraceSettings& settings)
{
    const auto found = std::ranges::find(models, settings.surface, &Model::id);
    if (found == models.end())
        throw_spec_error("surface = \"{}\": a model from outside the tree has no screen truth, which this needs",
                         settings.surface);
    return *found;
}

/// Where a height that is `in` at t_in and changes evenly reaches 0, within the part.
double root(const RayPart& ray, double in, double out)
{
    if (in == out) return ray.t_in;
    return std::clamp(ray.t_in + (ray.t_out - ray.t_in) * (in / (in - out)), ray.t_in, ray.t_out);
}

} // namespace

bool has_screen_truth(std::string_view surface) { return std::ranges::count(models, surface, &Model::id) > 0; }

double slab_back(const View& view, double depth, const TraceSettings& settings)
{
    return shifted(view, depth, settings.thickness_m, settings.thickness_relative);
}

double slab_front(const View& view, double depth, const TraceSettings& settings)
{
    return shifted(view, depth, -settings.thickness_m, settings.thickness_relative);
}

double plane_tolerance(const View& view, double depth)
{
    const double range =
        view.projection == Projection::orthographic ? view.far_m / (view.far_m - view.near_m) - depth : depth;
    return range / 1024;
}

void require_surface(const GBufferImage& gbuffer, const TraceSettings& settings)
{
    const size_t pixels = gbuffer.depth.size(), solids = gbuffer.solid_back.size();
    if (model_of(settings).needs_gradients && gbuffer.gradient.size() != pixels)
        throw_failure("G-buffer of view '{}': planes need {} gradients, found {}", gbuffer.view.name, pixels,
                      gbuffer.gradient.size());
    if (solids != 0 && solids != pixels)
        throw_failure("G-buffer of view '{}': expected {} far sides of solids or none, found {}", gbuffer.view.name,
                      pixels, solids);
    for (int layer = 1; layer < layer_count(gbuffer, settings); ++layer) {
        const GBufferImage& behind = layer_of(gbuffer, layer);
        if (behind.depth.size() != pixels || behind.normal_vs.size() != pixels)
            throw_failure("G-buffer of view '{}': layer {} needs {} depths and normals, found {} and {}",
                          gbuffer.view.name, layer, pixels, behind.depth.size(), behind.normal_vs.size());
        TraceSettings alone = settings;
        alone.layers        = 1;
        require_surface(behind, alone);
    }
}

int layer_count(const GBufferImage& gbuffer, const TraceSettings& settings)
{
    return std::min(settings.layers, static_cast<int>(gbuffer.layers.size()) + 1);
}

const GBufferImage& layer_of(const GBufferImage& gbuffer, int layer)
{
    return layer == 0 ? gbuffer : gbuffer.layers[static_cast<size_t>(layer) - 1];
}

std::optional<PixelSurface> pixel_surface(const GBufferImage& gbuffer, int layer, size_t index,
                                          const TraceSettings& settings)
{
    const double depth(layer_of(gbuffer, layer).depth[index]);
    if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
    PixelSurface surface = model_of(settings).held_by(gbuffer, layer, index, depth, settings);
    surface.centre_px    = glm::dvec2(pixel_at(index, gbuffer.view.size_px)) + 0.5;
    return surface;
}

namespace {

/// The ray's height over a front, and over the far side of the solid behind it.
struct Height {
    double front = 0, far_side = -infinity;
};

Height height_at(const PixelSurface& surface, glm::dvec3 at)
{
    const glm::dvec2 px(at);
    return {at.z - surface.front_at(px), surface.far_side ? at.z - surface.far_side_at(px) : -infinity};
}

Meeting meet_from_outside(const PixelSurface& surface, const RayPart& ray)
{
    const Height in = height_at(surface, ray.at(ray.t_in)), out = height_at(surface, ray.at(ray.t_out));
    const double t      = root(ray, in.front, out.front);
    const bool   solid  = surface.far_side.has_value();
    const bool   before = !solid || out.far_side * in.front >= in.far_side * out.front; // where it meets the front
    if (in.front > 0) return {out.front <= 0 && !surface.is_far_side && before, false, t};
    if (out.front > 0) return {!solid, true, t};
    return {solid && in.far_side >= 0 && out.far_side >= 0, true, ray.t_in};
}

} // namespace

double outside_in(const PixelSurface& surface, const RayPart& ray)
{
    const Height in = height_at(surface, ray.at(ray.t_in)), out = height_at(surface, ray.at(ray.t_out));
    const double down = surface.is_far_side ? -infinity : std::min(in.front, -out.front),
                 up   = std::min(-in.front, out.front);
    if (!surface.far_side) return std::max(down, up);
    const Height met    = height_at(surface, ray.at(root(ray, in.front, out.front)));
    const double inside = std::min({-in.front, -out.front, in.far_side, out.far_side});
    return std::max(std::min(down, met.far_side), inside);
}

Meeting meet(const PixelSurface& surface, const RayPart& ray, double facing)
{
    if (surface.from_outside) return meet_from_outside(surface, ray);
    const glm::dvec3 in = ray.at(ray.t_in), out = ray.at(ray.t_out);
    const double     over_front_in = in.z - surface.front_at(glm::dvec2(in)),
                 over_front_out    = out.z - surface.front_at(glm::dvec2(out));
    const double over_back_in      = in.z - surface.back_at(glm::dvec2(in)),
                 over_back_out     = out.z - surface.back_at(glm::dvec2(out));
    const bool above = over_front_in > 0 && over_front_out > 0, below = over_back_in < 0 && over_back_out < 0;
    const bool touches_solid = std::max(in.z, out.z) >= surface.solid_back;
    if (above || (below && !touches_solid)) return {};

    // What a box's normal says holds for its slab; a ray below that is met by the solid alone.
    const bool from_behind = surface.sides_by_height ? over_back_in < 0 : below || !(facing < 0);
    if (over_front_in > 0) return {true, from_behind, root(ray, over_front_in, over_front_out)};
    if (over_back_in >= 0 || in.z >= surface.solid_back) return {true, from_behind, ray.t_in};
    double t = ray.t_out;
    if (over_back_out >= 0) t = std::min(t, root(ray, over_back_in, over_back_out));
    if (touches_solid) t = std::min(t, root(ray, in.z - surface.solid_back, out.z - surface.solid_back));
    return {true, from_behind, t};
}

} // namespace ssrlab
