// The hit test, for techniques that walk from pixel to pixel.
#include "api/trace_api.glsl"

// What is stored of a pixel, for surface_at(); counted.
uvec2 fetch_pixel(ivec2 pixel)
{
    count_depth_fetch();
    record_visit(pixel, 0);
    return load_cell(pixel, 0);
}

// The hit test: where does the ray end in this pixel, between two crossings?
Contact test_pixel(Ray ray, Grid grid, ivec2 pixel, crossing t_in, crossing t_out)
{
    Contact      contact = Contact(false, pixel, 0, fetch_pixel(pixel), crossing_to_t(grid, t_in), crossing_to_t(grid, t_out), false);
    PixelSurface surface = surface_of(ray, contact);
    contact.found        = ends_at(ray, surface, meets(ray, grid, surface, t_in, t_out), contact.t_in);
    return first_of_layers(ray, grid, contact, t_in, t_out);
}
