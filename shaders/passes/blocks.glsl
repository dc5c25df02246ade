// Tracing at a lower resolution: one pixel in a block of block_px x block_px is traced (rays.comp says which).
const int block_px = 1 << trace_resolution; // full, half, quarter
