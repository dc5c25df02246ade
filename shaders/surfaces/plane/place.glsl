// Where the plane of a pixel lies in a buffer: rows of whole groups of four. After size_px.
int plane_place(ivec2 pixel) { return pixel.y * ((size_px.x + 3) & ~3) + pixel.x; }
