// Nothing behind the surface is solid.
const bool has_solids = false;

float load_solid(ivec2 pixel, int layer) { return 1e30; }
