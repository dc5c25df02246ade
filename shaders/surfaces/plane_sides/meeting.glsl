// A pixel as a plane that a ray meets from outside. Where the next layer is the far side of a solid, the solid fills what lies between the two planes.
// shaders/surfaces/README.md says what each function answers.
#include "surfaces/plane/stored.glsl"
#include "surfaces/plane_sides/far_side.glsl"

struct PixelSurface
{
    real start, rate;         // the ray's height above the plane is start + t * rate
    real far_start, far_rate; // the same of the far side, if there is one
    bool solid, far_side;     // it has a far side; it is one
    real back;                // the height where the slab of a sample ends; above everything where it is none
};

// The height above the plane that is stored in two words: at t = 0, and its rate.
real2 height_over(Ray ray, ivec2 pixel, real depth, vec2 stored)
{
    real2 gradient    = has_plane(stored) ? real2(stored) : real2(0);
    real2 from_centre = ray.origin.xy - (real2(pixel) + real(0.5));
    precise real start = (ray.origin.z - depth) - (gradient.x * from_centre.x + gradient.y * from_centre.y);
    precise real rate  = ray.delta.z - (gradient.x * ray.delta.x + gradient.y * ray.delta.y);
    return real2(start, rate);
}

PixelSurface surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words)
{
    uvec2 behind = load_far_side(pixel, layer);
    float far    = uintBitsToFloat(behind.x);
    real2 height = height_over(ray, pixel, real(depth_in(words, pixel)), unpack_gradient(words.y));
    real2 over   = height_over(ray, pixel, real(far), unpack_gradient(behind.y));
    return PixelSurface(height.x, height.y, over.x, over.y, far > 0.0, is_far_side(pixel, layer), real(1e30));
}

// One sample sees no crossing: it needs a thickness, the run's.
PixelSurface sampled_surface_at(Ray ray, ivec2 pixel, int layer, uvec2 words)
{
    PixelSurface surface = surface_at(ray, pixel, layer, words);
    real         depth   = real(depth_in(words, pixel));
    surface.back         = slab_back(depth) - depth;
    return surface;
}

real height_at(real start, real rate, real t)
{
    precise real height = start + t * rate;
    return height;
}

// Heights above the plane and above the far side where the ray enters the pixel and where it leaves it.
bool comes_from_outside(PixelSurface surface, real a, real b, real far_a, real far_b)
{
    if (a > real(0)) return b <= real(0) && !surface.far_side && (!surface.solid || far_b * a >= far_a * b); // down, before the far side
    if (b > real(0)) return !surface.solid;
    return surface.solid && far_a >= real(0) && far_b >= real(0); // it came in through a side that fills no pixel
}

bool meets(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    real a = height_at(surface.start, surface.rate, t_in), b = height_at(surface.start, surface.rate, t_out);
    real far_a = height_at(surface.far_start, surface.far_rate, t_in), far_b = height_at(surface.far_start, surface.far_rate, t_out);
    return a <= real(0) && a >= surface.back || comes_from_outside(surface, a, b, far_a, far_b);
}

// It comes from below.
bool from_behind(Ray ray, PixelSurface surface, real t_in)
{
    real height = height_at(surface.start, surface.rate, t_in);
    return height <= real(0) && height < surface.back;
}

real contact_t(Ray ray, PixelSurface surface, real t_in, real t_out)
{
    bool above = height_at(surface.start, surface.rate, t_in) > real(0);
    precise real t = -surface.start / surface.rate;
    return above != (height_at(surface.start, surface.rate, t_out) > real(0)) ? clamp(t, t_in, t_out) : t_in;
}
