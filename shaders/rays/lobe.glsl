// The GGX lobe of a rough surface, whose half vectors are drawn from the normals that are visible to the eye. After api/hash.glsl.
// J. Dupuy, A. Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"; E. Heitz 2014, "Understanding the Masking-Shadowing Function
// in Microfacet-Based BRDFs".
#include "rays/lobe_threshold.glsl"

float smith_lambda(float cosine, float alpha)
{
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)) - 1.0);
}

// The density with which a direction is drawn from the whole lobe. It stands for narrower lobes, too: their higher density would take weight
// from the rays that fit a pixel best.
float lobe_density(vec3 normal, vec3 to_eye, vec3 to_light, float alpha)
{
    float n_v = max(dot(normal, to_eye), 1e-4), n_h = dot(normal, normalize(to_eye + to_light));
    float spread = n_h * n_h * (alpha * alpha - 1.0) + 1.0;
    return alpha * alpha / (3.14159265 * spread * spread * 4.0 * n_v) / (1.0 + smith_lambda(n_v, alpha));
}

// What lobe_value() needs of a surface, whatever the light's direction.
struct Lobe
{
    vec3  normal, to_eye;
    float alpha2, n_v, eye_side, scale;
};

Lobe lobe_of(vec3 normal, vec3 to_eye, float alpha)
{
    float alpha2 = alpha * alpha, n_v = max(dot(normal, to_eye), 1e-4);
    return Lobe(normal, to_eye, alpha2, n_v, sqrt(n_v * n_v * (1.0 - alpha2) + alpha2), alpha2 / 6.2831853);
}

// The BRDF times its cosine, without Fresnel's factor. 0 or less where the light comes from below.
float lobe_value(Lobe lobe, vec3 to_light)
{
    vec3  both = lobe.to_eye + to_light; // not of length 1: D's denominator is multiplied by its squared length
    float n_l = dot(lobe.normal, to_light), n_h = dot(lobe.normal, both), length2 = dot(both, both);
    float spread = n_h * n_h * (lobe.alpha2 - 1.0) + length2;
    float sides  = lobe.eye_side * n_l + lobe.n_v * sqrt(n_l * n_l * (1.0 - lobe.alpha2) + lobe.alpha2);
    return lobe.scale * n_l * length2 * length2 / (spread * spread * sides);
}

vec3 drawn_half_vector(vec3 normal, vec3 to_eye, float alpha, vec2 random)
{
    vec3 other   = abs(normal.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0);
    vec3 tangent = normalize(cross(other, normal));
    mat3 frame   = mat3(tangent, cross(normal, tangent), normal);
    vec3 view    = to_eye * frame;
    vec3 stretched = normalize(vec3(alpha * view.xy, max(view.z, 1e-4)));
    float z = 1.0 - random.x * (1.0 + stretched.z), sine = sqrt(clamp(1.0 - z * z, 0.0, 1.0)), turn = 6.2831853 * random.y;
    vec3 cap = vec3(sine * cos(turn), sine * sin(turn), z) + stretched;
    return frame * normalize(vec3(alpha * cap.xy, max(cap.z, 0.0)));
}

// Random numbers follow the image's sub-pixel offset: a jittered frame draws others than the one before, so that the mean over the frames has less
// noise. 0 without an offset. In float, so that the double twin draws the same.
uint offset_seed()
{
    uvec2 bits = floatBitsToUint(fract(2.0 * vec2(centre_px)));
    return bits.x ^ bits.y * 747796405u;
}

// Two numbers in [0, 1). The rays of 4 x 4 pixels are one well spread set, since neighbours use each other's: R2 of M. Roberts 2018, "The
// Unreasonable Effectiveness of Quasirandom Sequences", in the order of a Bayer matrix.
vec2 lobe_random(ivec2 pixel, int ray, int rays, int attempt)
{
    int  x = pixel.x & 3, y = pixel.y & 3, mixed = x ^ y;
    int  place = (mixed & 1) << 3 | (y & 1) << 2 | (mixed & 2) | y >> 1;
    uint block = pcg(uint(pixel.x >> 2) + pcg(uint(pixel.y >> 2) + pcg(uint(attempt) + offset_seed())));
    vec2 shift = vec2(block & 0xFFFFu, block >> 16) / 65536.0;
    return fract(shift + float(place * rays + ray + 1) * vec2(0.75487767, 0.56984029));
}
