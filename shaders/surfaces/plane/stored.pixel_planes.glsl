// Planes as the G-buffer stores them, for what needs = ["gradient"]. After api/camera.glsl.

// Change of depth from one pixel to the next along x and y; NaN where the pixel has no usable plane.
vec2 unpack_gradient(uint words) { return uintBitsToFloat(uvec2(words & 0xFFFF0000u, words << 16)); }

bool has_plane(vec2 gradient) { return (floatBitsToUint(gradient.x) & 0x7FFFFFFFu) <= 0x7F800000u; }

// How far the back lies below the plane: 1/1024 of the distance.
real plane_tolerance(real depth) { return (orthographic == 0 ? depth : far_m / (far_m - near_m) - depth) / real(1024); }
