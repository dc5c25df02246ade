// What arrives from infinitely far away; framework/scene/environment.h states the convention. Four fetches instead of a filter:
// hardware filters blend by 8 bits and differ between devices.
vec2 direction_to_uv(vec3 direction_ws)
{
    const float pi = 3.14159265358979;
    float level   = length(direction_ws.xz);
    float azimuth = level > 0.0 ? atan(direction_ws.x, -direction_ws.z) : 0.0;
    return 0.5 + vec2(azimuth / (2.0 * pi), -atan(direction_ws.y, level) / pi);
}

// The map's texel for one that lies at most one past its border. Without %, which CPU drivers compute lane by lane.
ivec2 wrapped(ivec2 texel, ivec2 size)
{
    int x = texel.x < 0 ? texel.x + size.x : texel.x;
    return ivec2(x >= size.x ? x - size.x : x, clamp(texel.y, 0, size.y - 1));
}

vec3 environment_texel(ivec2 texel)
{
    return imageLoad(environment_map, wrapped(texel, imageSize(environment_map))).rgb;
}

vec3 environment_radiance(vec2 uv)
{
    vec2  at_px = uv * vec2(imageSize(environment_map)) - 0.5;
    vec2  low   = floor(at_px);
    vec2  part  = at_px - low;
    ivec2 texel = ivec2(low);
    vec3  a = environment_texel(texel), b = environment_texel(texel + ivec2(1, 0));
    vec3  c = environment_texel(texel + ivec2(0, 1)), d = environment_texel(texel + ivec2(1, 1));
    // Not mix(): between equal values the result is that value, to the last bit.
    vec3 upper = a + (b - a) * part.x, lower = c + (d - c) * part.x;
    return upper + (lower - upper) * part.y;
}
