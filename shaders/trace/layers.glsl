// The hit contract in the layers behind the first one; with LAYERS > 1.

// Of two contacts in one pixel the one that the ray meets first; at the same t the one in front.
Contact first_of(Ray ray, Contact front, Contact behind)
{
    if (!front.found || !behind.found) return behind.found ? behind : front;
    real t_front = contact_t(ray, surface_of(ray, front), front.t_in, front.t_out);
    return contact_t(ray, surface_of(ray, behind), behind.t_in, behind.t_out) < t_front ? behind : front;
}

// front: what the ray meets in the first layer.
Contact first_of_layers(Ray ray, Contact front)
{
    if (front.sampled && front.found) return front; // all layers are met at the same t
    Contact first = front;
    [[unroll]] for (int layer = 1; layer < LAYERS; ++layer)
    {
        Contact behind = front;
        behind.layer   = layer;
        behind.words   = fetch_layer(front.pixel, layer);
        PixelSurface surface = surface_of(ray, behind);
        behind.found   = ends_at(ray, surface, meets(ray, surface, front.t_in, front.t_out), front.t_in);
        first          = first_of(ray, first, behind);
    }
    return first;
}

// Between two crossings.
#ifdef EXACT_ARITHMETIC
Contact first_of_layers(Ray ray, Grid grid, Contact front, crossing t_in, crossing t_out)
{
    Contact first = front;
    [[unroll]] for (int layer = 1; layer < LAYERS; ++layer)
    {
        Contact behind = front;
        behind.layer   = layer;
        behind.words   = fetch_layer(front.pixel, layer);
        PixelSurface surface = surface_of(ray, behind);
        behind.found   = ends_at(ray, surface, meets(ray, grid, surface, t_in, t_out), front.t_in);
        first          = first_of(ray, first, behind);
    }
    return first;
}
#else
Contact first_of_layers(Ray ray, Grid grid, Contact front, real t_in, real t_out) { return first_of_layers(ray, front); }
#endif
