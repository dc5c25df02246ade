// What a layer knows of its neighbours; with one layer, nothing.
bool  is_far_side(ivec2 pixel, int layer) { return false; }
uvec2 load_far_side(ivec2 pixel, int layer) { return uvec2(0); }
