// Index of the cell that holds a pixel at a level. At level 0, two pixels share one cell.
SHARED_FUNCTION int pixel_to_cell_index(int x_px, int y_px, int level, int root, int rows)
{
    return strip_index(x_px >> (level > 1 ? level : 1), (root | y_px) >> level, rows);
}
