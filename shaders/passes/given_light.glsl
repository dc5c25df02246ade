// What a ray brings back that something else than the frame answered.
struct GivenLight // struct RayLight of frame/frame.h
{
    vec3  light;
    float distance_m; // from the reflecting point on; infinity: it meets nothing; below 0: the frame answers
};

#include "passes/load_given_light.glsl"

bool meets_given(GivenLight given) { return given.distance_m >= 0.0 && !isinf(given.distance_m); }
