// Mappings between view space and pixels.
#include "api/camera.glsl"
#include "layout/packed_pixel.glsl"

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
