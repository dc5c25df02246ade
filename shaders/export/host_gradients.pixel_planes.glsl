// The gradients of the host's planes.
layout(set = 0, binding = 2, scalar) readonly buffer HostGradients { uint host_gradients[]; }; // row by row

// How depth changes from one pixel to the next along x (upper 16 bits) and y (lower 16 bits): the upper halves of two floats; all bits set: no plane.
uint host_gradient(ivec2 pixel) { return host_gradients[pixel.y * size_px.x + pixel.x]; }
