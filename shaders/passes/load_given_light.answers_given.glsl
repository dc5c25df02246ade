layout(set = 0, binding = 67, scalar) readonly buffer RayLights { GivenLight ray_lights[]; };

GivenLight given_light(uint index) { return ray_lights[index]; }
