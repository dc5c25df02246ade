// Surfaces without planes need no gradients.
uint host_gradient(ivec2 pixel) { return 0; }
