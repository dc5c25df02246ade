// The same in a layer: 0, 1, ...; not counted.
real3 fetch_normal(ivec2 pixel, int layer) { return fetch_normal(pixel); }
