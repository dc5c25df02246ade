// With one layer, a cell's pixels hold nothing behind the first one.
uvec2 range_behind(bool of_pixels, ivec2 first) { return nothing; }
uint  bins_behind(bool of_pixels, ivec2 first, uvec2 cell) { return 0u; }
