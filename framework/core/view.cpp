#include "core/view.h"

#include "core/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace ssrlab {
namespace {

void require(bool condition, const Camera& camera, const char* field, const char* expected)
{
    if (!condition) throw_spec_error("view '{}': {} must be {}", camera.name, field, expected);
}

bool finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(const Camera& camera, glm::ivec2 size_px)
{
    require(size_px.x >= 1 && size_px.y >= 1, camera, "size_px", "at least 1x1");
    require(finite(camera.position_ws) && finite(camera.target_ws) && finite(camera.up_ws), camera,
            "position, target and up", "finite");
    const glm::dvec3 axis = camera.target_ws - camera.position_ws;
    require(glm::length(axis) > 0, camera, "target", "different from position");
    require(glm::length(glm::cross(glm::normalize(axis), camera.up_ws)) > 1e-9 * glm::length(camera.up_ws), camera,
            "up", "non-zero and not along the view axis");
    require(std::isfinite(camera.near_m) && camera.near_m > 0, camera, "near_m", "finite and > 0");
    require(std::isfinite(camera.shift_px.x) && std::isfinite(camera.shift_px.y), camera, "shift_px", "finite");
    if (camera.projection == Projection::perspective) {
        require(camera.fov_y_deg > 0 && camera.fov_y_deg < 180, camera, "fov_y_deg", "inside (0, 180)");
    } else {
        require(std::isfinite(camera.height_m) && camera.height_m > 0, camera, "height_m", "finite and > 0");
        require(std::isfinite(camera.far_m) && camera.far_m > camera.near_m, camera, "far_m", "finite and > near_m");
    }
}

} // namespace

View camera_to_view(const Camera& camera, glm::ivec2 size_px)
{
    check(camera, size_px);
    View view;
    view.name          = camera.name;
    view.size_px       = size_px;
    view.projection    = camera.projection;
    view.world_to_view = glm::lookAtRH(camera.position_ws, camera.target_ws, camera.up_ws);
    view.near_m        = camera.near_m;
    view.far_m         = camera.far_m;
    const double focal = camera.projection == Projection::perspective
                             ? 0.5 * size_px.y / std::tan(0.5 * camera.fov_y_deg * std::numbers::pi / 180)
                             : size_px.y / camera.height_m;
    view.focal_px      = {focal, focal};
    view.centre_px     = 0.5 * glm::dvec2(size_px) + camera.shift_px;
    return view;
}

double distance_to_depth(const View& view, double distance_m)
{
    return view.projection == Projection::perspective ? view.near_m / distance_m
                                                      : (view.far_m - distance_m) / (view.far_m - view.near_m);
}

double depth_to_distance(const View& view, double depth)
{
    return view.projection == Projection::perspective ? view.near_m / depth
                                                      : view.far_m - depth * (view.far_m - view.near_m);
}

glm::dvec3 px_to_vs(const View& view, glm::dvec2 position_px, double depth)
{
    const double     distance_m = depth_to_distance(view, depth);
    const double     scale      = view.projection == Projection::perspective ? distance_m : 1.0;
    const glm::dvec2 offset     = (position_px - view.centre_px) / view.focal_px;
    return {offset.x * scale, -offset.y * scale, -distance_m};
}

glm::dvec3 vs_to_px(const View& view, glm::dvec3 position_vs)
{
    const double distance_m = -position_vs.z;
    const double scale      = view.projection == Projection::perspective ? 1.0 / distance_m : 1.0;
    return {view.centre_px.x + view.focal_px.x * position_vs.x * scale,
            view.centre_px.y - view.focal_px.y * position_vs.y * scale, distance_to_depth(view, distance_m)};
}

glm::dmat4 view_to_clip(const View& view)
{
    const glm::dvec2 size = view.size_px;
    // NDC x = 2 px / W - 1, y likewise (Vulkan's y points down, as pixel space does).
    const glm::dvec2 scale  = 2.0 * view.focal_px / size;
    const glm::dvec2 offset = 2.0 * view.centre_px / size - 1.0;
    glm::dmat4       m(0.0);
    m[0][0] = scale.x;
    m[1][1] = -scale.y;
    if (view.projection == Projection::perspective) {
        m[2][0] = -offset.x;
        m[2][1] = -offset.y;
        m[2][3] = -1.0;
        m[3][2] = view.near_m;
    } else {
        m[3][0] = offset.x;
        m[3][1] = offset.y;
        m[2][2] = 1.0 / (view.far_m - view.near_m);
        m[3][2] = view.far_m / (view.far_m - view.near_m);
        m[3][3] = 1.0;
    }
    return m;
}

} // namespace ssrlab
