// The depth where the solid behind a pixel's surface ends; 0 or less without one.
layout(set = 0, binding = 13, r32f) uniform readonly image2D solid_image;

float load_solid_image(ivec2 pixel, int layer) { return imageLoad(solid_image, pixel).x; }
