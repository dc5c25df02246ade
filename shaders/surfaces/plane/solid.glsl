// Nothing is solid behind the plane.
const bool has_solids = false;

// The depth where the solid behind the pixel's surface in a layer ends; nearer than everything where there is none.
float load_solid(ivec2 pixel, int layer) { return 1e30; }
