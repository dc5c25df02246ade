// layers.glsl where there are several.
#extension GL_EXT_control_flow_attributes : require
#include "layout/load_layers.glsl"

// As fetch_pixel(), of a layer behind the first: 1, 2, ...; counted.
uvec2 fetch_layer(ivec2 pixel, int layer)
{
    count_depth_fetch();
    return load_layer(pixel, layer);
}

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

#include "trace/layer_crossings.glsl"
