// What a cell's four pixels hold in the layers behind the first one (layers_behind.layered.glsl): their ranges, and the bins that they fill.
uvec2 range_behind(bool of_pixels, ivec2 first) { return nothing; }
uint  bins_behind(bool of_pixels, ivec2 first, uvec2 cell) { return 0u; }
