#include "patch.glsl"

struct Plane
{
    real2 gradient; // a pixel
    real  depth;    // at the centre of the patch's first pixel
    real  occluder; // the least key of what stands before the plane (surface/held.glsl, back_key), or 0
};

// Of the patch with these coordinates; counted for the structure that asks.
Plane load_plane(ivec2 place)
{
    vec4 plane = load_planes(place.y * (((size_px.x - 1) >> PATCH_BITS) + 1) + place.x);
    return Plane(real2(plane.xy), real(plane.z), real(plane.w));
}
