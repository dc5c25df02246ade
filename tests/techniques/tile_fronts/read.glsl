// The nearest depth of the tile that holds a pixel; counted.
real fetch_tile_front(ivec2 pixel)
{
    count_fetch(STRUCTURE_tile_fronts);
    return real(load_fronts(tile_index(pixel, 8)));
}
