// Follows the rays of a group as one packet through the depth pyramid, before they are traced. Between two t it covers a box on screen and an interval of
// depth that hold all its rays; where no cell under the box has a surface in that interval, none of the rays touches anything. Near its start that
// interval meets the very surface that the rays leave. There they are held against planes instead: how far all of them have risen above the base plane
// of the patch they start from, how far any patch under the box rises above it, and the occluders of a patch that they must pass behind (patch_planes).
#include "api/trace_api.glsl"
#include "api/held.glsl"
#include "surface/order.glsl"
#include "api/group_lanes.glsl"
#include "trace/ray_list.glsl"
#include "structure/parameters"
#include "structure/buffers"

layout(local_size_x = RAY_GROUP_INVOCATIONS) in;

LEAST_OF_GROUP_LANES(real)
LEAST_OF_GROUP_LANES(real3)

const real first_px = 8, finest_step_px = 8, shortest_interval_px = 24; // on screen, along the longest delta
const real widest_px = 64;                                             // where rays of different tiles meet in one group
const real rising_px = 1.5, rising_step_px = 16;                       // while it is held against planes
const int  most_rising_tests = 3, most_patches = 6;
#ifdef IN_FRONT // it has to stay in front of everything: then it has one interval, which begins soon or not at all
const int most_intervals = 1, most_tests = 64, most_blocked_steps = 4;
#else
const int most_intervals = intervals_count, most_tests = ray_packets_most_tests, most_blocked_steps = most_tests;
#endif
// What rounding moves a position by, at the largest image, and a depth, as a share of the nearest: many times more than it can.
const real rounding_px = 1.0 / 16, rounding_depth = 1.0 / (1 << 20);

int top = pyramid_top();

uint fetches = 0; // of this lane

// x_px, y_px, depth
struct Box
{
    real3 low, high;
};

// Instead of min() and max(), which take longer and may answer anything about NaN: where b is NaN, a.
real lesser(real a, real b) { return b < a ? b : a; }
real3 lesser(real3 a, real3 b) { return mix(a, b, lessThan(b, a)); }
real3 greater(real3 a, real3 b) { return mix(a, b, greaterThan(b, a)); }

const Box no_box = Box(real3(1e30), real3(-1e30));

Box unite(Box a, Box b)
{
    return Box(lesser(a.low, b.low), greater(a.high, b.high));
}

Box unite_lanes(Box own) { return Box(least_of_group_lanes(own.low), -least_of_group_lanes(-own.high)); }

// Of all points between the two boxes, at the same t of each ray.
Box box_at(Box start, Box end, real t)
{
    return Box(start.low + t * (end.low - start.low), start.high + t * (end.high - start.high));
}

// The finest level of which a few cells hold the box.
int level_of(Box box)
{
    real2 extent = box.high.xy - box.low.xy;
    return clamp(findMSB(max(int(max(extent.x, extent.y)), 1)), 1, top);
}

ivec2 cell_at(real2 position_px, int level) { return clamp(ivec2(floor(position_px)), ivec2(0), size_px - 1) >> level; }

// The cells from first to last, row by row, that are a lane's; behind the last one they are below them.
#if GROUP_LANES > 1
ivec2 further_cell(ivec2 cell, int places, ivec2 first, ivec2 last)
{
    int width = last.x - first.x + 1, place = cell.x - first.x + places;
    return ivec2(first.x + place % width, cell.y + place / width);
}
ivec2 first_cell(ivec2 first, ivec2 last) { return further_cell(first, group_lane(), first, last); }
ivec2 next_cell(ivec2 cell, ivec2 first, ivec2 last) { return further_cell(cell, GROUP_LANES, first, last); }
ivec2 loaded_cell(bool goes, ivec2 cell, ivec2 first) { return goes ? cell : first; } // a lane that waits loads one that is there
#else
ivec2 loaded_cell(bool goes, ivec2 cell, ivec2 first) { return cell; } // nothing waits
ivec2 first_cell(ivec2 first, ivec2 last) { return first; }
ivec2 next_cell(ivec2 cell, ivec2 first, ivec2 last)
{
    return cell.x == last.x ? ivec2(first.x, cell.y + 1) : ivec2(cell.x + 1, cell.y);
}
#endif

bool touches(Box box, int level, bool asked)
{
    ivec2 first = cell_at(box.low.xy, level), last = cell_at(box.high.xy, level), cell = first_cell(first, last);
    bool  found = false, goes = asked && cell.y <= last.y;
    do
    {
        fetches += uint(goes);
        uvec2 content = load_cell(loaded_cell(goes, cell, first) << level, level);
        bool  behind  = floatBitsToInt(float(box.low.z)) <= int(content.x); // at its farthest, of the nearest front
        #ifdef IN_FRONT
        bool touched = behind;
#else
        bool touched = cell_may_touch(content, float(box.low.z), float(box.high.z));
#endif
        found        = found || (goes && touched);
        cell         = next_cell(cell, first, last);
        goes         = goes && !found && cell.y <= last.y;
    } while (any_in_subgroup(goes));
    return any_group_lane(found);
}

// Does any base plane under the box reach that height, or the box the slab of an occluder? Heights are those above the plane of the gradient `base`
// through 0 at position 0, 0.
bool meets_patch(Box box, real2 base, real height, bool asked)
{
    ivec2 first = cell_at(box.low.xy, PATCH_BITS), last = cell_at(box.high.xy, PATCH_BITS), place = first_cell(first, last);
    bool  found = any(greaterThanEqual(last - first, ivec2(most_patches))), goes = asked && !found && place.y <= last.y;
    do
    {
        fetches += uint(goes);
        Plane plane  = load_plane(loaded_cell(goes, place, first));
        real2 centre = real2(place << PATCH_BITS) + real(0.5);
        real2 steeper = plane.gradient - base;
        real2 rise    = max(steeper, real2(0)) * real((1 << PATCH_BITS) - 1) + (level_fronts ? real2(0) : abs(steeper) * real(held_reach_px));
        bool  rises  = !(plane.depth - dot(base, centre) + rise.x + rise.y < height);
        bool  passes = plane.occluder <= real(0) || passes_behind(plane.occluder, box.high.z);
        found        = found || (goes && (rises || !passes));
        place        = next_cell(place, first, last);
        goes         = goes && !found && place.y <= last.y;
    } while (any_in_subgroup(goes));
    return any_group_lane(found);
}

// One more interval, if it is long enough to be worth a skip.
void keep(int packet, inout int kept, real begin, real end, real length_px)
{
    bool keeps = kept < most_intervals && (end - begin) * length_px >= shortest_interval_px;
    if (keeps && group_lane() == 0) store_intervals(packet * intervals_count + kept, real2(begin, end));
    kept += int(keeps);
}

void main()
{
    int  packet = ray_group();
    uint first  = packet * RAYS_PER_GROUP;
#if GROUP_LANES == 1
    if (first >= ray_count) return;
#endif
    bool exists = first < ray_count;
    uint count  = exists ? min(ray_count - first, RAYS_PER_GROUP) : 0;
    // NaN are left out: rays with them touch nothing.
    Box start = no_box, end = no_box;
    // Of all rays the least height, where they start and where they end.
    fetches += uint(group_lane() == 0);
    real2 base = load_plane(cell_at(packed_ray(exists ? first : 0).origin.xy, PATCH_BITS)).gradient;
    real  height = 1e30, end_height = 1e30;
    for (uint i = group_lane(); i < count; i += GROUP_LANES)
    {
        PackedRay ray = packed_ray(first + i);
        real3 from = ray.origin, to = ray.origin + ray.delta;
        start = unite(start, Box(from, from));
        end   = unite(end, Box(to, to));
        height     = lesser(height, from.z - dot(base, from.xy));
        end_height = lesser(end_height, to.z - dot(base, to.xy));
    }
    start      = unite_lanes(start);
    end        = unite_lanes(end);
    height     = least_of_group_lanes(height);
    end_height = least_of_group_lanes(end_height);
    real  nearest  = max(start.high.z, end.high.z);
    real3 rounding = real3(rounding_px, rounding_px, nearest * rounding_depth);
    start = Box(start.low - rounding, start.high + rounding);
    end   = Box(end.low - rounding, end.high + rounding);

    real2 delta_px  = max(abs(end.low.xy - start.low.xy), abs(end.high.xy - start.high.xy)), extent = start.high.xy - start.low.xy;
    real  length_px = max(delta_px.x, delta_px.y);
    bool  numbers   = all(lessThanEqual(start.low, start.high)) && all(lessThanEqual(end.low, end.high)); // not with NaN
    bool  usable    = numbers && length_px >= first_px + shortest_interval_px && max(extent.x, extent.y) <= widest_px && top >= 1;

    // A level front counts at its pixel's centre, half a pixel away at most.
    real tilt = abs(base.x) + abs(base.y), largest = nearest + tilt * real(max(size_px.x, size_px.y));
    real clearance = tilt * (real(level_fronts ? 0.5 : 0.0) + 2 * rounding_px) + largest * 4 * rounding_depth, rise = end_height - height;
    real begin = rising_px / length_px, t = begin, rising_step = rising_step_px / length_px;
    bool rises = usable && rise > real(0);
    int  rising_tests = 0;
    bool tested = rises && t + rising_step < real(1);
    while (any_in_subgroup(tested))
    {
        Box box = unite(box_at(start, end, t), box_at(start, end, t + rising_step));
        tested  = !meets_patch(box, base, height + t * rise - clearance, tested) && tested;
        t       = tested ? t + rising_step : t;
        ++rising_tests;
        tested = tested && rising_tests < most_rising_tests && t + rising_step < real(1);
    }

    begin       = !usable ? real(1) : t > begin ? begin : first_px / length_px;
    t           = usable ? max(t, begin) : real(1);
    real finest = finest_step_px / length_px, step_t = 2 * finest;
    int  kept = 0, tests = 0, blocked_steps = 0;
    bool goes = t < real(1);
    while (any_in_subgroup(goes))
    {
        real t_next  = min(real(1), t + step_t);
        Box  box     = unite(box_at(start, end, t), box_at(start, end, t_next));
        int  level   = level_of(box);
        bool touched = touches(box, level, goes);
        if (goes)
        {
            bool ends = touched && step_t <= finest;
            if (ends) keep(packet, kept, begin, t, length_px);
            t      = touched && !ends ? t : t_next;
            begin  = ends ? t_next : begin;
            step_t = !touched ? step_t * 2 : ends ? step_t : step_t / 2;
            blocked_steps += int(ends);
            ++tests;
            goes = t < real(1) && kept < most_intervals && tests < most_tests && blocked_steps < most_blocked_steps;
        }
    }
    fetches = sum_of_group_lanes(fetches);
    if (!exists || group_lane() > 0) return;
    keep(packet, kept, begin, t, length_px);
    for (int i = kept; i < intervals_count; ++i) store_intervals(packet * intervals_count + i, real2(2));
    store_group_fetches(packet, fetches);
}
