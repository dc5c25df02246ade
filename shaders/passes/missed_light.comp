// What missed rays show: the light that the followed rays of the nearest four blocks met. A followed ray weighs more
// the nearer its block is, and the smaller the angle is between the ray and the direction toward what was met. Where
// most of them met nothing, the environment stays. To the passes after this, all these rays found nothing in the frame.
#include "passes/missed_rays.glsl"
#include "passes/given_light.glsl"
#include "layout/store_hit.glsl"

STORED_HITS(9, Hits)
layout(set = 0, binding = 50, scalar) readonly buffer MissedLaunch { ListLaunch launch; };
layout(set = 0, binding = 54, scalar) readonly buffer MissedRays { uint missed_rays[]; };
layout(set = 0, binding = 55, scalar) writeonly buffer MissedLights { GivenLight lights[]; };
layout(set = 0, binding = 56, scalar) readonly buffer MissRanks { uint ranks[]; };
layout(set = 0, binding = 57, scalar) readonly buffer WorldRays { WorldRay followed[]; };
layout(set = 0, binding = 58, scalar) readonly buffer WorldHits { WorldHit met[]; };
layout(set = 0, binding = 51, scalar) readonly buffer FollowedPlaces { uint places[]; };
layout(set = 0, binding = 52, scalar) readonly buffer MetPlaces { uint met_places[]; };
layout(set = 0, binding = 59, scalar) readonly buffer WorldLight { vec3 met_light[]; };

#define nothing_m uintBitsToFloat(0x7F800000u) // infinity
const float alike = 0.0003; // squared angle in radians: one degree makes no difference
// The environment stays unless this many times as much weight met something: thin things are narrower than a block.
const float open_share = 2.0;

GivenLight light_about(ivec2 pixel, WorldRay own)
{
    vec2  place = (vec2(pixel) + 0.5) / float(MISS_BLOCK_PX) - 0.5, part = fract(place);
    vec4  sum   = vec4(0); // light and distance
    float open = 0.0, closed = 0.0;
    const int corners = MISS_BLOCK_PX == 1 ? 1 : 4; // of one pixel, the other blocks have no share
    for (int i = 0; i < corners; ++i)
    {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec2 block  = ivec2(floor(place)) + corner;
        if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block, miss_blocks()))) continue;
        int at = block.y * miss_blocks().x + block.x;
        if (ranks[at] == no_rank) continue;
        uint k = places[at];
        if (met[k].triangle == WALK_UNFINISHED) continue;
        bool  meets   = met[k].triangle != NO_TRIANGLE;
        vec3  to_met  = followed[k].origin_ws + met[k].t * followed[k].direction_ws - own.origin_ws;
        vec3  off     = (meets ? normalize(to_met) : followed[k].direction_ws) - own.direction_ws;
        vec2  shares  = mix(1.0 - part, part, vec2(corner));
        float weight  = shares.x * shares.y / (alike + dot(off, off));
        if (!(weight > 0.0)) continue;
        if (meets) sum += weight * vec4(met_light[met_places[k]], length(to_met));
        closed += meets ? weight : 0.0;
        open += meets ? 0.0 : weight;
    }
    return closed > open_share * open ? GivenLight(sum.rgb / closed, sum.a / closed) : GivenLight(vec3(0), nothing_m);
}

void main()
{
    uint number = work_group() * RAYS_PER_GROUP + gl_LocalInvocationID.x;
    if (number >= launch.count) return;
    uint  index   = missed_rays[number];
    ivec2 pixel   = unpack_pixel(ray_pixel(index));
    lights[index] = light_about(pixel, missed_ray(index));
    STORE_TEXEL(Hits, index, hit_to_texel(pack_pixel(pixel, TRACE_LEFT_SCREEN), 0.0));
}
