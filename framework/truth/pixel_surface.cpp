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

/// The plane of a pixel, or its box where it has no usable plane.
PixelSurface plane_or_box(const GBufferImage& gbuffer, size_t index, double depth, const TraceSettings& settings)
{
    const glm::dvec2 gradient(gbuffer.gradient[index]);
    const bool       usable  = std::isfinite(gradient.x) && std::isfinite(gradient.y);
    PixelSurface     surface = usable ? plane(gbuffer.view, depth, gradient) : box(gbuffer, index, depth, settings);
    surface.sides_by_height  = true;
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

struct Model {
    std::string_view id;
    PixelSurface (*held_by)(const GBufferImage&, size_t index, double depth, const TraceSettings&);
    bool needs_gradients = false;
};
constexpr std::array models = {Model{"box", box},
                               Model{"box_two_sided", box_two_sided},
                               Model{"box_infinite", box_infinite},
                               Model{"plane", plane_or_box, true},
                               Model{"plane_solid", plane_and_solid, true},
                               Model{"plane_infinite", plane_infinite, true}};

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

std::optional<PixelSurface> pixel_surface(const GBufferImage& gbuffer, size_t index, const TraceSettings& settings)
{
    const double depth(gbuffer.depth[index]);
    if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
    PixelSurface surface = model_of(settings).held_by(gbuffer, index, depth, settings);
    surface.centre_px    = glm::dvec2(pixel_at(index, gbuffer.view.size_px)) + 0.5;
    return surface;
}

Meeting meet(const PixelSurface& surface, const RayPart& ray, double facing)
{
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
