// How far the lobe of a rough pixel spreads what its rays met. After passes/reflector.glsl and passes/blocks.glsl, with block_pixel_image
// and ray_end_image. Pixels farther apart do not see the same things: what one sees past a leg, the other may see the leg before.
// The pixel that was traced in place of this one; negative: none.
ivec2 traced_pixel(ivec2 pixel)
{
    if (block_px == 1) return pixel;
    uint found = imageLoad(block_pixel_image, pixel / block_px).x;
    return found == NO_PIXEL ? ivec2(-1) : unpack_pixel(found);
}

float pixel_width_m(Reflector reflector, ivec2 pixel)
{
    return distance(px_to_vs(vec3(vec2(pixel) + vec2(1.5, 0.5), load_depth(pixel))), reflector.position_vs);
}

// The standard deviation, in pixels, for the nearest thing that a pixel's rays met. 1.3 alpha: where the lobe has fallen to a half, for GGX.
float spread_px(Reflector reflector, ivec2 pixel, float pixel_m)
{
    const float least = 1e-3; // not a quotient of nothing
    ivec2 traced = traced_pixel(pixel);
    if (traced.x < 0) return least;
    float nearest_m = 1e30;
    for (int ray = 0; ray < rays_per_pixel; ++ray)
    {
        vec4 end = imageLoad(ray_end_image, traced + ivec2(0, ray * size_px.y));
        if (end.w > 0.0) nearest_m = min(nearest_m, distance(end.xyz, reflector.position_vs));
    }
    return max(reuse_spread * 1.3 * reflector.alpha * nearest_m / pixel_m, least);
}

const float spread_reach = 3.0; // standard deviations beyond which no pixel counts

// Of a pixel so many standard deviations away.
float spread_weight(float away) { return away > spread_reach ? 0.0 : exp(-0.5 * away * away); }
