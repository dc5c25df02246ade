// What a hard case gives to a tracer: an analytic frame, settings and rays.
#pragma once

#include "core/gbuffer_image.h"
#include "core/trace_image.h"
#include "trace/lab.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ssrlab {

/// One frame with its rays. Without rays, every reflecting pixel sends its mirror ray, as the shader sets it up.
struct Setup {
    std::string           label; // tells the setups of one case apart
    GBufferImage          gbuffer;
    TraceSettings         settings;
    std::vector<RayInput> rays;
};

/// The camera of the closed forms: perspective, 90 degrees high, looking along -z from 0, so that x_px = W/2 + H/2 *
/// X/Z, y_px = H/2 - H/2 * Y/Z and depth = near_m / Z.
View bench_view(glm::ivec2 size_px = {64, 64}, double near_m = 0.1, double fov_y_deg = 90);
View orthographic_view(glm::ivec2 size_px, double height_m, double near_m, double far_m);

/// A surface: where a ray from `origin` along `direction` (view space) first meets it, and its normal there.
struct ShapePoint {
    double     s = 0; // origin + s * direction
    glm::dvec3 normal_vs{0, 0, 1};
};
using Shape = std::function<std::optional<ShapePoint>(glm::dvec3 origin, glm::dvec3 direction)>;
Shape plane(glm::dvec3 point, glm::dvec3 normal);
Shape sphere(glm::dvec3 centre, double radius);
Shape box(glm::dvec3 low, glm::dvec3 high);

/// Draws the shapes; everything is a perfect mirror.
GBufferImage picture_of(const View& view, const std::vector<Shape>& shapes);

/// Distance of each pixel in metres; 0 or infinity is background. Normals face the camera.
using DistanceOfPixel = std::function<double(glm::ivec2)>;
GBufferImage picture_of(const View& view, const DistanceOfPixel& distance_m);

/// Turns the normal of a pixel so that its mirror ray goes in this direction.
void reflect_to(GBufferImage& image, glm::ivec2 pixel, glm::dvec3 direction_vs);

/// Makes a ray between two points on screen; z is the distance in metres.
RayInput ray_between(const View& view, glm::dvec3 from_px_distance, glm::dvec3 to_px_distance);
/// Makes a ray of constant depth.
RayInput level_ray(const View& view, glm::dvec2 from_px, glm::dvec2 delta_px, double distance_m);

/// Rounds the ray to float, as the technique gets it: the answer must be that of these numbers.
RayInput rounded_to_float(const RayInput& ray);

/// Mirrors a setup; axis 0 exchanges left and right, axis 1 top and bottom.
Setup      mirrored(const Setup& setup, int axis);
RayOutcome mirrored(RayOutcome outcome, glm::ivec2 size_px, int axis);
/// Returns false if mirroring changes the ray: its origin rounds differently, or lies on a border.
bool mirrors_exactly(const RayInput& ray, glm::ivec2 size_px, int axis);

} // namespace ssrlab
