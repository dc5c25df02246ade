// The number type of the trace: float, or double for the twin (real.real_is_double.glsl).
#define real float
#define real2 vec2
#define real3 vec3

// How much of a ray's depth half of the last place of t = 1 moves. Nothing in double precision, which is what float is held to.
const real t_rounding = 1.0 / (1 << 24);
