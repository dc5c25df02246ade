// Of the cell of a level that holds a pixel, or at level 0 of the two pixels of which it is one. C++ includes it through shared.h.
SHARED_FUNCTION int pixel_to_cell_index(int x_px, int y_px, int level, int root, int rows)
{
    return strip_index(x_px >> (level > 1 ? level : 1), (root | y_px) >> level, rows);
}
