// Whether a surface was seen in the frame before. After previous_frame.glsl and pass/parameters.

// Normal of the plane that a pixel is a piece of. 1 / distance = a + b x + c y over the slopes x and y, so with P = distance (x, y, -1) the plane is
// (b, c, -a) P = 1; orthographic: distance = a + b x + c y.
vec3 plane_normal_vs(ivec2 pixel, float depth)
{
    vec2 gradient = unpacked_gradient(imageLoad(gradient_image, pixel).x) * focal_px * vec2(1, -1);
    vec3 shading  = normalize(imageLoad(normal_image, pixel).xyz);
    if (any(isnan(gradient))) return shading;
    vec2 slope = px_to_slope(vec2(pixel) + 0.5);
    if (orthographic != 0) return normalize(vec3(-gradient * (far_m - near_m), 1));
    return normalize(vec3(gradient, dot(gradient, slope) - depth));
}

// Does the previous frame show at this position the surface that the pixel shows now?
bool shows_surface(ivec2 pixel, uint object, vec2 px)
{
    float depth  = load_depth(pixel);
    vec3  on_pvs = carried_pvs(px_to_vs(vec3(vec2(pixel) + 0.5, depth)), object), normal = turned_pvs(plane_normal_vs(pixel, depth), object);
    vec2  slope  = previous_px_to_slope(px);
    float offset = dot(normal, on_pvs);
    float expected_m = orthographic == 0 ? offset / dot(normal, vec3(slope, -1)) : (dot(normal.xy, slope) - offset) / normal.z;
    float stored     = previous_depth(px);
    return stored > 0.0 && abs(previous_depth_to_distance(stored) - expected_m) <= reject_depth * expected_m;
}
