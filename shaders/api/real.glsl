// The number type of the trace: float, or double for the twin (-D REAL_IS_DOUBLE).
#ifdef REAL_IS_DOUBLE
#define real double
#define real2 dvec2
#define real3 dvec3
#define real4 dvec4
#else
#define real float
#define real2 vec2
#define real3 vec3
#define real4 vec4
#endif
