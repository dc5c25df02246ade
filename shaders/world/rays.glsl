// Rays in world space and what each meets (framework/world/world.h has the same structs).
#define NO_TRIANGLE 0xFFFFFFFFu
#define WALK_UNFINISHED 0xFFFFFFFEu

struct WorldRay
{
    vec3  origin_ws;
    float t_min;
    vec3  direction_ws;
    float t_max;
};

struct WorldHit
{
    float t;
    uint  triangle; // NO_TRIANGLE: none; WALK_UNFINISHED: not known
    vec2  barycentric;
};
