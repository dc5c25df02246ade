// The nearest and the farthest depth that a pixel holds in all layers. depth, gradient: of the first one.
vec2 held_depths(ivec2 pixel, float depth, uint gradient) { return held_depths(pixel, 0, depth, gradient); }
