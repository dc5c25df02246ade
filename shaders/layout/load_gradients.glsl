// The gradients of four pixels in a row, x a multiple of four. Without planes they have none.
uvec4 load_gradients(ivec2 pixel) { return uvec4(0); }
