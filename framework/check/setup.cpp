#include "check/setup.h"

#include "core/pixel_index.h"

#include <cmath>
#include <limits>

namespace ssrlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

GBufferImage empty_picture(const View& view)
{
    const auto   count = pixel_count(view.size_px);
    GBufferImage image;
    image.view = view;
    image.depth.assign(count, 0.0F);
    image.normal_vs.assign(count, glm::vec3(0, 0, 1));
    image.roughness.assign(count, 0.0F);
    image.metallic.assign(count, 1.0F);
    image.dielectric_f0.assign(count, 0.0F); // what is no metal does not reflect
    image.base_colour.assign(count, glm::vec3(1));
    image.radiance.assign(count, glm::vec3(0));
    image.highlight.assign(count, glm::vec3(0));
    image.object_id.assign(count, 1);
    return image;
}

template <typename T> void mirror_pixels(std::vector<T>& values, glm::ivec2 size_px, int axis)
{
    const std::vector<T> source = values;
    for (int y = 0; y < size_px.y; ++y)
        for (int x = 0; x < size_px.x; ++x) {
            const int from_x = axis == 0 ? size_px.x - 1 - x : x, from_y = axis == 1 ? size_px.y - 1 - y : y;
            values[pixel_index({x, y}, size_px)] = source[pixel_index({from_x, from_y}, size_px)];
        }
}

} // namespace

View bench_view(glm::ivec2 size_px, double near_m, double fov_y_deg)
{
    Camera camera;
    camera.name        = "bench";
    camera.position_ws = {0, 0, 0};
    camera.target_ws   = {0, 0, -1};
    camera.fov_y_deg   = fov_y_deg;
    camera.near_m      = near_m;
    View view          = camera_to_view(camera, size_px);
    // tan(45 degrees) is not 1 in floating point; the closed forms want it to be.
    if (fov_y_deg == 90) view.focal_px = glm::dvec2(0.5 * size_px.y);
    return view;
}

View orthographic_view(glm::ivec2 size_px, double height_m, double near_m, double far_m)
{
    Camera camera;
    camera.name        = "orthographic";
    camera.position_ws = {0, 0, 0};
    camera.target_ws   = {0, 0, -1};
    camera.projection  = Projection::orthographic;
    camera.height_m    = height_m;
    camera.near_m      = near_m;
    camera.far_m       = far_m;
    return camera_to_view(camera, size_px);
}

Shape plane(glm::dvec3 point, glm::dvec3 normal)
{
    return [=](glm::dvec3 origin, glm::dvec3 direction) -> std::optional<ShapePoint> {
        const double s = glm::dot(point - origin, normal) / glm::dot(direction, normal);
        if (!(s > 0) || s == infinity) return std::nullopt;
        return ShapePoint{s, normal};
    };
}

Shape sphere(glm::dvec3 centre, double radius)
{
    return [=](glm::dvec3 origin, glm::dvec3 direction) -> std::optional<ShapePoint> {
        const glm::dvec3 to_centre = centre - origin;
        const double     a = glm::dot(direction, direction), b = glm::dot(direction, to_centre);
        const double     root = b * b - a * (glm::dot(to_centre, to_centre) - radius * radius);
        const double     s    = (b - std::sqrt(root)) / a;
        if (!(s > 0)) return std::nullopt;
        return ShapePoint{s, glm::normalize(origin + s * direction - centre)};
    };
}

Shape box(glm::dvec3 low, glm::dvec3 high)
{
    return [=](glm::dvec3 origin, glm::dvec3 direction) -> std::optional<ShapePoint> {
        double s_in = 0, s_out = infinity;
        int    side = -1;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (low[axis] - origin[axis]) / direction[axis],
                         b = (high[axis] - origin[axis]) / direction[axis];
            if (direction[axis] == 0 && (origin[axis] < low[axis] || origin[axis] > high[axis])) return std::nullopt;
            if (direction[axis] == 0) continue;
            if (std::min(a, b) > s_in) side = axis;
            s_in  = std::max(s_in, std::min(a, b));
            s_out = std::min(s_out, std::max(a, b));
        }
        if (side < 0 || s_in >= s_out) return std::nullopt;
        glm::dvec3 normal(0);
        normal[side] = direction[side] > 0 ? -1 : 1;
        return ShapePoint{s_in, normal};
    };
}

GBufferImage picture_of(const View& view, const std::vector<Shape>& shapes)
{
    GBufferImage image = empty_picture(view);
    for (int y = 0; y < view.size_px.y; ++y)
        for (int x = 0; x < view.size_px.x; ++x) {
            const auto       i        = pixel_index({x, y}, view.size_px);
            const bool       from_eye = view.projection == Projection::perspective;
            const glm::dvec3 point    = px_to_vs(view, glm::dvec2(x, y) + 0.5, distance_to_depth(view, 1.0));
            const glm::dvec3 origin   = from_eye ? glm::dvec3(0) : glm::dvec3(point.x, point.y, 0);
            const glm::dvec3 along    = from_eye ? point : glm::dvec3(0, 0, -1); // s = distance
            double           nearest  = infinity;
            for (const Shape& shape : shapes) {
                const auto found = shape(origin, along);
                if (!found || found->s >= nearest || found->s < view.near_m) continue;
                nearest            = found->s;
                image.depth[i]     = static_cast<float>(distance_to_depth(view, nearest));
                image.normal_vs[i] = glm::vec3(found->normal_vs);
            }
        }
    return image;
}

GBufferImage picture_of(const View& view, const DistanceOfPixel& distance_m)
{
    GBufferImage image = empty_picture(view);
    for (int y = 0; y < view.size_px.y; ++y)
        for (int x = 0; x < view.size_px.x; ++x) {
            const double distance = distance_m({x, y});
            if (distance > 0 && distance < infinity)
                image.depth[pixel_index({x, y}, view.size_px)] = static_cast<float>(distance_to_depth(view, distance));
        }
    return image;
}

void reflect_to(GBufferImage& image, glm::ivec2 pixel, glm::dvec3 direction_vs)
{
    const size_t     i = pixel_index(pixel, image.view.size_px);
    const glm::dvec3 seen =
        glm::normalize(px_to_vs(image.view, glm::dvec2(pixel) + 0.5, static_cast<double>(image.depth[i])));
    image.normal_vs[i] = glm::vec3(glm::normalize(glm::normalize(direction_vs) - seen));
}

RayInput ray_between(const View& view, glm::dvec3 from_px_distance, glm::dvec3 to_px_distance)
{
    const glm::dvec3 from(from_px_distance.x, from_px_distance.y, distance_to_depth(view, from_px_distance.z));
    const glm::dvec3 to(to_px_distance.x, to_px_distance.y, distance_to_depth(view, to_px_distance.z));
    const double length = glm::distance(px_to_vs(view, glm::dvec2(from), from.z), px_to_vs(view, glm::dvec2(to), to.z));
    return rounded_to_float(
        {from, to - from, length, TraceStatus::left_screen, glm::ivec2(glm::floor(glm::dvec2(from)))});
}

RayInput level_ray(const View& view, glm::dvec2 from_px, glm::dvec2 delta_px, double distance_m)
{
    return ray_between(view, {from_px, distance_m}, {from_px + delta_px, distance_m});
}

RayInput rounded_to_float(const RayInput& ray)
{
    RayInput rounded        = ray;
    rounded.origin_px_depth = glm::dvec3(glm::vec3(ray.origin_px_depth));
    rounded.delta_px_depth  = glm::dvec3(glm::vec3(ray.delta_px_depth));
    rounded.length_m        = static_cast<double>(static_cast<float>(ray.length_m));
    return rounded;
}

Setup mirrored(const Setup& setup, int axis)
{
    Setup        result  = setup;
    View&        view    = result.gbuffer.view;
    const double size    = view.size_px[axis];
    view.centre_px[axis] = size - view.centre_px[axis];
    mirror_pixels(result.gbuffer.depth, view.size_px, axis);
    mirror_pixels(result.gbuffer.normal_vs, view.size_px, axis);
    mirror_pixels(result.gbuffer.metallic, view.size_px, axis);
    if (!setup.gbuffer.gradient.empty()) mirror_pixels(result.gbuffer.gradient, view.size_px, axis);
    if (!setup.gbuffer.solid_back.empty()) mirror_pixels(result.gbuffer.solid_back, view.size_px, axis);
    for (glm::vec3& normal : result.gbuffer.normal_vs) normal[axis] = -normal[axis];
    for (glm::vec2& gradient : result.gbuffer.gradient) gradient[axis] = -gradient[axis];
    for (GBufferImage& layer : result.gbuffer.layers)
        layer = mirrored(Setup{"", std::move(layer), {}, {}}, axis).gbuffer;
    for (RayInput& ray : result.rays) {
        ray.origin_px_depth[axis] = size - ray.origin_px_depth[axis];
        ray.delta_px_depth[axis]  = -ray.delta_px_depth[axis];
        ray.pixel[axis]           = view.size_px[axis] - 1 - ray.pixel[axis];
    }
    return result;
}

RayOutcome mirrored(RayOutcome outcome, glm::ivec2 size_px, int axis)
{
    if (has_place(outcome.status)) outcome.hit_pixel[axis] = size_px[axis] - 1 - outcome.hit_pixel[axis];
    return outcome;
}

bool mirrors_exactly(const RayInput& ray, glm::ivec2 size_px, int axis)
{
    const auto origin    = static_cast<float>(ray.origin_px_depth[axis]);
    const auto size      = static_cast<float>(size_px[axis]);
    const bool no_border = std::floor(origin) != origin && origin > 0 && origin < size;
    return no_border && static_cast<double>(size - origin) == static_cast<double>(size) - static_cast<double>(origin);
}

} // namespace ssrlab
