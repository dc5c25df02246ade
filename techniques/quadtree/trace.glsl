// Walks the cells of the plane quadtree. A node that the ray may touch is opened, at the quarter where it may touch
// first. Else the ray goes on to the next cell, and climbs as long as the border that it crosses bounds the parent, too.
#include "api/test_pixel.glsl"

TraceResult trace(Ray ray)
{
    Grid      grid     = make_grid(ray);
    int       top      = quadtree_top(), level = min(start_level, top), visited = 0;
    crossing2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    crossing  t_in     = exit_t(grid, t_border);
    ivec2     cell     = cross_borders(grid, ray.start_pixel, t_border, t_in) >> level;
    Contact   contact  = no_contact();
    while (!contact.found && t_in < grid.t_end && visited < max_steps)
    {
        ivec2 pixel      = cell << level;
        t_border         = border_t(ray, grid, (cell + grid.forward) << level);
        crossing t_out   = exit_t(grid, t_border), t_touch = t_in;
        bool     opens   = level > 0 && touches_node(ray, grid, pixel, level, t_in, t_out, t_touch);
        if (level == 0) contact = test_pixel(ray, grid, pixel, t_in, t_out);
        if (opens)
        {
            // Of the four quarters, the one that holds the ray at t_touch; it is entered where the last border before is crossed.
            --level;
            crossing2 t_middle = border_t(ray, grid, (2 * cell + 1) << level);
            bvec2     beyond   = lessThanEqual(t_middle, crossing2(t_touch));
            cell               = 2 * cell + ivec2(equal(ivec2(beyond), grid.forward));
            t_in               = max(t_in, max(beyond.x ? t_middle.x : t_in, beyond.y ? t_middle.y : t_in));
        }
        else
        {
            ivec2 next    = cross_borders(grid, cell, t_border, t_out);
            ivec2 borders = mix(ivec2(1), next + 1 - grid.forward, notEqual(next, cell)); // that are crossed; 1: none, which lets it climb nowhere
            int   up      = clamp(max(findLSB(borders.x), findLSB(borders.y)), 0, min(climb, top - level));
            cell          = next >> up;
            level += up;
            t_in           = t_out;
        }
        ++visited;
    }
    if (contact.found) return hit(ray, contact, visited);
    return t_in < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
