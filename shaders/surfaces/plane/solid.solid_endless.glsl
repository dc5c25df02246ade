// Everything behind the surface is solid.
float load_solid(ivec2 pixel, int layer) { return -1e30; }
