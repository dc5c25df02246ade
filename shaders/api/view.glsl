// The camera of the G-buffer (core/view.h) and its mappings between view space and pixels.
#include "api/real.glsl"
#include "layout/shared.h"

layout(constant_id = CONSTANT_ORTHOGRAPHIC) const int orthographic = 0;
layout(constant_id = CONSTANT_MAX_DISTANCE_M) const real max_distance_m = 1; // where rays end
layout(constant_id = CONSTANT_RAY_OFFSET_M) const real ray_offset_m = 0;     // how far along its direction a ray starts

layout(set = 0, binding = 0, scalar) uniform View
{
    ivec2 size_px;   // first: it lies in the same place whether the rest is float or double
    real2 focal_px;  // perspective: pixels per unit of slope; orthographic: pixels per metre
    real2 centre_px; // where the view axis meets the image
    real2 focal_low_px, centre_low_px; // what rounding took from the two
    real  near_m;
    real  far_m; // orthographic only
};

real depth_to_distance(real depth) { return orthographic == 0 ? near_m / depth : far_m - depth * (far_m - near_m); }

// Slope of the view ray through a pixel position (orthographic: its offset in metres); x right, y up.
real2 px_to_slope(real2 position_px) { return (position_px - centre_px) / focal_px * real2(1, -1); }

real3 px_to_vs(real3 px_depth)
{
    real  distance_m = depth_to_distance(px_depth.z);
    real2 slope      = px_to_slope(px_depth.xy);
    return real3(orthographic == 0 ? slope * distance_m : slope, -distance_m);
}

// Direction in view space between two points of the screen, not normalised; the second may lie at infinity.
real3 px_to_direction_vs(real3 from_px_depth, real3 to_px_depth)
{
    real2 from = px_to_slope(from_px_depth.xy), to = px_to_slope(to_px_depth.xy);
    real  rise = to_px_depth.z - from_px_depth.z;
    if (orthographic != 0) return real3(to - from, rise * (far_m - near_m));
    // P = slope / depth * near: P1 - P0 times both depths.
    return real3(to * from_px_depth.z - from * to_px_depth.z, rise);
}

uint pack_pixel(ivec2 pixel, int number) { return uint(pixel.x) | uint(pixel.y) << PIXEL_BITS | uint(number) << (2 * PIXEL_BITS); }

ivec2 unpack_pixel(uint packed) { return ivec2(packed, packed >> PIXEL_BITS) & (MAX_IMAGE_PX - 1); }

// How a ray ended, in whichever layer.
int unpack_status(uint packed) { return number_to_status(int(packed >> (2 * PIXEL_BITS))); }

int unpack_layer(uint packed) { return number_to_layer(int(packed >> (2 * PIXEL_BITS))); }
