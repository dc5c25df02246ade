// Parts of the built-in scenes, and the scenes of effect_scenes.cpp and textured_scenes.cpp.
#pragma once

#include "scene/model.h"

namespace ssrlab {

inline constexpr double floor_y_m = -1;

Light  sun(glm::vec3 direction_ws, float irradiance);
Camera camera(const char* name, glm::dvec3 position_ws, double pitch_down_deg, const char* hard_for);
Camera look(const char* name, glm::dvec3 position_ws, glm::dvec3 target_ws, double fov_y_deg, const char* hard_for);

/// Returns a scene with the lights, the mirror floor's material (index 0) and the three cameras of the analytic scenes.
Model start_scene();
/// Returns a scene with lights and these cameras, without materials.
Model start_scene(std::vector<Camera> cameras);
/// Returns a sky whose sun stands where the light of start_scene(cameras) comes from.
void add_sky(Model& model);

void     add(Model& model, const char* name, uint32_t material, Mesh mesh);
uint32_t add_material(Model& model, const char* name, glm::vec3 base_colour);
uint32_t add_metal(Model& model, const char* name, glm::vec3 base_colour, float roughness);
uint32_t add_checker(Model& model, const char* name, glm::vec3 colour_a, glm::vec3 colour_b);
void     add_floor(Model& model, double half_width_m, double near_z_m, double far_z_m);
/// Facing the camera, from the floor up, with squares of one metre.
void add_wall(Model& model, double half_width_m, double z_m, double top_y_m);
/// Boxes, a ball and posts to look at and to reflect, spread over x = -3 .. 3 around `z_m`.
void add_things(Model& model, double z_m);
/// Two upright mirrors, 4.4 m apart, that see each other; the right one is turned by 2 degrees.
void add_facing_mirrors(Model& model, double near_z_m, double far_z_m, double height_m);

Model puddle();
Model gloss_steps();
Model facing_mirrors();
Model hidden_shelf();
Model everything();
Model small_mirror();
Model matte();

} // namespace ssrlab
