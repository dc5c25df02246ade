#include "viewer/camera_motion.h"

#include <algorithm>
#include <cmath>

namespace ssrlab {
namespace {

constexpr double pole_margin_deg = 1;

glm::dvec3 turned(glm::dvec3 v, glm::dvec3 unit_axis, double angle_rad) // Rodrigues' formula
{
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return v * c + glm::cross(unit_axis, v) * s + unit_axis * glm::dot(unit_axis, v) * (1 - c);
}

/// An arm that points away from the pivot, turned about the camera's up direction, then raised toward it.
glm::dvec3 turned_arm(const Camera& camera, glm::dvec3 arm, double right_deg, double up_deg)
{
    const glm::dvec3 up        = glm::normalize(camera.up_ws);
    const double     elevation = glm::degrees(std::asin(std::clamp(glm::dot(glm::normalize(arm), up), -1.0, 1.0)));
    const double     most      = 90 - pole_margin_deg;
    const double     raise = std::abs(elevation) > most ? 0 : std::clamp(elevation + up_deg, -most, most) - elevation;
    const glm::dvec3 side  = glm::normalize(glm::cross(arm, up));
    return turned(turned(arm, side, glm::radians(raise)), up, glm::radians(right_deg));
}

} // namespace

void orbit(Camera& camera, double right_deg, double up_deg)
{
    camera.position_ws =
        camera.target_ws + turned_arm(camera, camera.position_ws - camera.target_ws, right_deg, up_deg);
}

void look(Camera& camera, double right_deg, double up_deg)
{
    camera.target_ws =
        camera.position_ws + turned_arm(camera, camera.target_ws - camera.position_ws, -right_deg, up_deg);
}

void fly(Camera& camera, double right_m, double up_m, double forward_m)
{
    const glm::dvec3 forward = glm::normalize(camera.target_ws - camera.position_ws);
    const glm::dvec3 right   = glm::normalize(glm::cross(forward, camera.up_ws));
    const glm::dvec3 way     = right * right_m + glm::cross(right, forward) * up_m + forward * forward_m;
    camera.position_ws += way;
    camera.target_ws += way;
}

void approach(Camera& camera, double factor)
{
    if (camera.projection == Projection::orthographic)
        camera.height_m *= factor;
    else
        camera.position_ws = camera.target_ws + (camera.position_ws - camera.target_ws) * factor;
}

void set_target_distance(Camera& camera, double distance_m)
{
    camera.target_ws = camera.position_ws + glm::normalize(camera.target_ws - camera.position_ws) * distance_m;
}

} // namespace ssrlab
