// The hit contract in the layers behind the first one. After the surface model and ends_at(); with LAYERS > 1.

// Does the ray end in one of them, between two t?
bool touches_layers(Ray ray, ivec2 pixel, real t_in, real t_out)
{
    bool ends = false;
    [[unroll]] for (int layer = 1; layer < LAYERS; ++layer)
    {
        PixelSurface surface = surface_at(ray, pixel, layer, fetch_layer(pixel, layer));
        ends = ends_at(ray, surface, meets(ray, surface, t_in, t_out), t_in) || ends;
    }
    return ends;
}

#ifdef EXACT_ARITHMETIC
// Between two crossings.
bool touches_layers(Ray ray, Grid grid, ivec2 pixel, crossing t_in, crossing t_out)
{
    bool ends = false;
    [[unroll]] for (int layer = 1; layer < LAYERS; ++layer)
    {
        PixelSurface surface = surface_at(ray, pixel, layer, fetch_layer(pixel, layer));
        ends = ends_at(ray, surface, meets(ray, grid, surface, t_in, t_out), crossing_to_t(grid, t_in)) || ends;
    }
    return ends;
}
#else
bool touches_layers(Ray ray, Grid grid, ivec2 pixel, real t_in, real t_out) { return touches_layers(ray, pixel, t_in, t_out); }
#endif

// By one sample?
bool samples_layers(Ray ray, ivec2 pixel, real t)
{
    bool ends = false;
    [[unroll]] for (int layer = 1; layer < LAYERS; ++layer)
    {
        PixelSurface surface = sampled_surface_at(ray, pixel, layer, fetch_layer(pixel, layer));
        ends = ends_at(ray, surface, meets(ray, surface, t, t), t) || ends;
    }
    return ends;
}

// The layer in which a ray ends first; of two at the same t the one in front. LAYERS: in none.
int first_layer(Ray ray, ivec2 pixel, real t_in, real t_out)
{
    int  first   = LAYERS;
    real first_t = real(2);
    [[unroll]] for (int layer = 0; layer < LAYERS; ++layer)
    {
        PixelSurface surface = surface_at(ray, pixel, layer, load_pixel(pixel, layer));
        real         t       = contact_t(ray, surface, t_in, t_out);
        bool         earlier = ends_at(ray, surface, meets(ray, surface, t_in, t_out), t_in) && t < first_t;
        first   = earlier ? layer : first;
        first_t = earlier ? t : first_t;
    }
    return first;
}

// That of a ray which is known to end in this pixel. Where it was asked in whole numbers, rounding may hide the touch: then it is within this reach.
int met_layer(Ray ray, ivec2 pixel, real t_in, real t_out)
{
    const real reach = real(1) / real(1 << 20);
    int layer = first_layer(ray, pixel, t_in, t_out);
    if (layer == LAYERS) layer = first_layer(ray, pixel, t_in - reach, t_out + reach);
    return layer < LAYERS ? layer : 0;
}

// The same by one sample.
int sampled_layer(Ray ray, ivec2 pixel, real t)
{
    int first = LAYERS;
    [[unroll]] for (int layer = LAYERS - 1; layer >= 0; --layer)
    {
        PixelSurface surface = sampled_surface_at(ray, pixel, layer, load_pixel(pixel, layer));
        first = ends_at(ray, surface, meets(ray, surface, t, t), t) ? layer : first;
    }
    return first < LAYERS ? first : 0;
}

// What is stored of the layer in which the ray ends; counted.
uvec2 fetch_met(ivec2 pixel, int layer)
{
    uvec2 words = fetch_pixel(pixel);
    return layer == 0 ? words : load_layer(pixel, layer);
}
