// For techniques that ask for the nearest depth alone.

// The nearest depth of that cell: no pixel of it is nearer. Negative or 0 where there is nothing.
real fetch_front(ivec2 pixel, int level)
{
    uvec2 words = fetch_cell(pixel, level);
    return real(level == 0 ? depth_in(words, pixel) : uintBitsToFloat(words.x));
}
