// real.glsl for the double twin.
#define real double
#define real2 dvec2
#define real3 dvec3

const real t_rounding = 0;
