// From a surface toward the camera. After api/view.glsl.
vec3 to_camera_vs(vec3 position_vs) { return orthographic != 0 ? vec3(0, 0, 1) : -normalize(position_vs); }
