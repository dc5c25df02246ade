// What a rough surface reflects: colours along a cone about the mirror ray, from passes/cone_pyramid.comp. After view.glsl and
// pass/parameters.
// Y. Uludag 2014, "Hi-Z Screen-Space Cone-Traced Reflections", GPU Pro 5.
layout(set = 0, binding = 35, rgba16f) uniform readonly image2D cone_pyramid; // colour, visibility

vec4 cone_cell(ivec2 cell, int level)
{
    ivec2 known = clamp(cell, ivec2(0), (size_px - 1) >> level);
    if (level == 0)
    {
        vec3 light = imageLoad(radiance_image, known).rgb;
        if (hit_shading == hit_shading_lit) light += imageLoad(highlight_image, known).rgb;
        return vec4(light, 1);
    }
    return imageLoad(cone_pyramid, known + ivec2(0, pyramid_root >> level));
}

vec4 cone_bilinear(vec2 place_px, int level)
{
    vec2  place = place_px / float(1 << level) - 0.5, share = fract(place);
    ivec2 from  = ivec2(floor(place));
    vec4  above = mix(cone_cell(from, level), cone_cell(from + ivec2(1, 0), level), share.x);
    vec4  below = mix(cone_cell(from + ivec2(0, 1), level), cone_cell(from + ivec2(1, 1), level), share.x);
    return mix(above, below, share.y);
}

vec4 cone_trilinear(vec2 place_px, float level)
{
    int   top   = pyramid_levels();
    float known = clamp(level, 0.0, float(top));
    int   finer = int(known);
    return mix(cone_bilinear(place_px, finer), cone_bilinear(place_px, min(finer + 1, top)), known - float(finer));
}

// Half the cone's angle: cos(angle) = 0.244 ^ (1 / (s + 1)), with the specular power s = 2 / roughness ^ 4 - 2 (B. Karis 2013, Specular
// BRDF Reference).
float cone_angle(float roughness)
{
    float alpha2 = pow(roughness, 4.0);
    return min(cone_scale * acos(pow(0.244, alpha2 / (2.0 - alpha2))), 1.5707963);
}

// Circles in the cone's triangle on the screen, from the hit back toward the reflector, until what they show makes a whole.
vec3 cone_light(vec2 from_px, vec2 to_px, float roughness, vec3 sharp)
{
    float height = distance(from_px, to_px), sine = sin(cone_angle(roughness));
    vec2  along  = (to_px - from_px) / max(height, 1.0);
    vec3  sum    = vec3(0);
    float missing = 1.0;
    for (int i = 0; i < cone_steps && missing > 0.0; ++i)
    {
        float radius = height * sine / (1.0 + sine); // of the circle inside
        // Half a pixel reaches no neighbour: what is smooth stays as it is, to the last bit.
        if (i == 0 && !(radius >= 0.5)) return sharp;
        vec4  seen  = cone_trilinear(from_px + along * (height - radius), log2(2.0 * radius));
        float share = min(seen.a, missing);
        sum += share * seen.rgb;
        missing -= share;
        height -= 2.0 * radius;
    }
    return missing < 1.0 ? sum / (1.0 - missing) : sharp;
}
