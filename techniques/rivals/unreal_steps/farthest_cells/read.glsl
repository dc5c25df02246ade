// The farthest depth of the cell that holds a pixel, 0 if one of its pixels has no surface; counted.
real fetch_farthest(ivec2 pixel)
{
    count_fetch(STRUCTURE_farthest_cells);
    return real(load_farthest(tile_index(pixel, 4)));
}
