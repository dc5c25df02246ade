// How far rays go through empty cells of the scene's grid, as first_occupied() in framework/world/occupancy.cpp has it,
// but through empty blocks of cells in one step: blocks grow while they are empty and shrink where they are not.
// Places are rounded to floats: the grid calls every cell occupied that geometry comes near to, by more than that rounding.
#include "layout/workgroups.glsl"
#include "world/rays.glsl"

layout(local_size_x = RAYS_PER_GROUP) in;
layout(set = 0, binding = 46, scalar) readonly buffer Occupied { uint occupied[]; }; // a bit a block, x fastest, then y; level after level
layout(set = 0, binding = 47, scalar) readonly buffer WorldRays { WorldRay rays[]; };
layout(set = 0, binding = 48, scalar) writeonly buffer MetDistances { float met_m[]; };
layout(set = 0, binding = 50, scalar) readonly buffer WorldLaunch { ListLaunch launch; };

#define GRID_LEVELS 4 // framework/world/grid_walk.cpp
#define LEVEL_BITS 2  // a block is 4 blocks of the level below wide

layout(push_constant, scalar) uniform Push
{
    vec3  low_ws; // of the grid
    vec3  cells_per_m;
    ivec3 cells;                    // along each axis
    uint  first_words[GRID_LEVELS]; // of each level
};

#define infinity uintBitsToFloat(0x7F800000u)

bool is_occupied(ivec3 cell, int level)
{
    int   shift = LEVEL_BITS * level;
    ivec3 block = cell >> shift, blocks = (cells - 1 >> shift) + 1;
    uint  index = uint((block.z * blocks.y + block.y) * blocks.x + block.x);
    return (occupied[first_words[level] + (index >> 5)] >> (index & 31u) & 1u) != 0;
}

float first_occupied(WorldRay ray)
{
    vec3 origin  = (ray.origin_ws - low_ws) * cells_per_m, rate = ray.direction_ws * cells_per_m, tiny = vec3(1e-30);
    rate         = mix(rate, tiny, lessThan(abs(rate), tiny));
    vec3 inverse = 1.0 / rate;
    vec3  a = -origin * inverse, b = (vec3(cells) - origin) * inverse, low = min(a, b), high = max(a, b);
    float t = max(ray.t_min, max(low.x, max(low.y, low.z))), t_end = min(ray.t_max, min(high.x, min(high.y, high.z)));
    if (!(t <= t_end)) return infinity;
    ivec3 cell  = clamp(ivec3(floor(origin + t * rate)), ivec3(0), cells - 1);
    ivec3 ahead = ivec3(greaterThan(rate, vec3(0)));
    int   level = 0;
    while (true)
    {
        if (is_occupied(cell, level))
        {
            if (level == 0) return t;
            --level;
            continue;
        }
        int   side   = 1 << LEVEL_BITS * level;
        ivec3 first  = cell & -side;
        vec3  border = (vec3(first + ahead * side) - origin) * inverse;
        float next   = min(border.x, min(border.y, border.z));
        if (!(next <= t_end)) return infinity;
        t    = max(t, next);
        cell = clamp(ivec3(floor(origin + t * rate)), first, first + (side - 1));
        ivec3 past = first + ahead * (side + 1) - 1; // where the ray leaves it
        if (border.x == next)
            cell.x = past.x;
        else if (border.y == next)
            cell.y = past.y;
        else
            cell.z = past.z;
        if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, cells))) return infinity;
        level = min(level + 1, GRID_LEVELS - 1);
    }
}

void main()
{
    uint index = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (index < launch.count) met_m[index] = first_occupied(rays[index]);
}
