// Cameras, views and the one depth convention of the project.
//
// View space: right-handed, metres, x right, y up, looking along -z. "distance" always means -z_vs.
// Pixel space: x right, y down, pixel (i, j) covers [i, i+1) x [j, j+1), centres at .5.
// Depth: one number per pixel, linear on screen along any straight line, larger = nearer, 0 = background:
//   perspective   depth = near_m / distance_m                     (reversed, infinite far plane)
//   orthographic  depth = (far_m - distance_m) / (far_m - near_m)
#pragma once

#include <glm/glm.hpp>

#include <string>

namespace ssrlab {

enum class Projection : unsigned { perspective = 0, orthographic = 1 };

/// Where a camera stands and how it looks, independent of the image size.
struct Camera {
    std::string name = "default";
    std::string hard_for; // one line: what this view is hard for
    glm::dvec3  position_ws{0, 0, 5};
    glm::dvec3  target_ws{0, 0, 0}; // a point on the view axis
    glm::dvec3  up_ws{0, 1, 0};
    Projection  projection = Projection::perspective;
    double      fov_y_deg  = 50; // perspective only
    double      height_m   = 2;  // orthographic only: visible height
    double      near_m     = 0.05;
    double      far_m      = 1000;  // orthographic only
    glm::dvec2  shift_px{0, 0};     // moves the image by so many pixels (off-centre, jitter)
    glm::ivec2  size_px{1280, 720}; // used when the caller names no size
};

/// A camera together with an image size: everything that maps between view space and pixels.
struct View {
    std::string name;
    glm::ivec2  size_px{0, 0};
    Projection  projection = Projection::perspective;
    glm::dmat4  world_to_view{1.0};
    glm::dvec2  focal_px{1, 1};  // perspective: pixels per unit of slope; orthographic: pixels per metre
    glm::dvec2  centre_px{0, 0}; // where the view axis meets the image
    double      near_m = 0.05;
    double      far_m  = 1000; // orthographic only
};

/// Throws SpecError naming the field when the camera is unusable (NaN, near <= 0, fov outside (0, 180), size < 1 …).
View camera_to_view(const Camera& camera, glm::ivec2 size_px);

double     distance_to_depth(const View& view, double distance_m);
double     depth_to_distance(const View& view, double depth); // depth 0 in perspective gives +inf
glm::dvec3 px_to_vs(const View& view, glm::dvec2 position_px, double depth);
/// x, y in pixels, z = depth. Perspective needs distance > 0.
glm::dvec3 vs_to_px(const View& view, glm::dvec3 position_vs);
/// Maps view space to Vulkan clip space so that the depth buffer holds `depth`.
glm::dmat4 view_to_clip(const View& view);

} // namespace ssrlab
