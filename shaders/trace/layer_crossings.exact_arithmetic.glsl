// layer_crossings.glsl for arithmetic = exact.
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
