// Rays in world space and what each meets (framework/world/world.h has the same structs).
#define NO_TRIANGLE 0xFFFFFFFFu
#define WALK_UNFINISHED 0xFFFFFFFEu

struct WorldRay
{
    vec3  origin_ws;
    float t_min;
    vec3  direction_ws;
    float t_max;
    float roughness; // of what it left: highlights are blurred by it
};

// Where what a ray met reflects: the ray that goes on, and the weight of what it finds (0: none does).
struct NextRay // framework/frame/world_light.h
{
    WorldRay ray;
    vec3     weight;
};

struct WorldHit
{
    float t;
    uint  triangle; // NO_TRIANGLE: none; WALK_UNFINISHED: not known
    vec2  barycentric;
};

// Of a list: the launch that covers it, and its length (framework/world/world.h).
struct ListLaunch
{
    uint groups_x, groups_y, groups_z;
    uint count;
};
