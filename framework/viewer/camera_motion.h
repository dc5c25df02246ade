// How mouse and keyboard move a camera.
#pragma once

#include "core/view.h"

namespace ssrlab {

/// Moves the camera on a sphere around its target: to the right, and up, but not over the pole.
void orbit(Camera& camera, double right_deg, double up_deg);
/// Turns the camera where it stands.
void look(Camera& camera, double right_deg, double up_deg);
/// Moves camera and target, along the camera's own axes.
void fly(Camera& camera, double right_m, double up_m, double forward_m);
/// Nearer to the target (factor < 1) or farther from it. An orthographic camera shows less or more.
void approach(Camera& camera, double factor);
/// Moves the target along the view axis; the picture stays.
void set_target_distance(Camera& camera, double distance_m);

} // namespace ssrlab
