"""A structure and a technique that reads it, both outside the source tree, without rebuilding."""
from support import Case, main

STRUCTURE = """name    = "Depths of tiles"
summary = "The nearest and the farthest depth of each tile."
[parameters]
nearer_by = { default = 1.0, min = 1.0, max = 4.0, doc = "How many times as near a tile counts: more skips less." }
[buffers]
fronts = { per = "tile", tile_px = 8, type = "float" }
backs  = { per = "tile", tile_px = 8, type = "float" }
[[passes]]
shader  = "build.comp"
per     = "tile"
tile_px = 8
"""
BUILD = """#include "api/held.glsl"
#include "structure/parameters"
#include "structure/buffers"
layout(local_size_x = 8, local_size_y = 8) in;

void main()
{
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * 8;
    if (any(greaterThanEqual(first, size_px))) return;
    float front = BACKGROUND_DEPTH, back = 1e30;
    for (int i = 0; i < 64; ++i)
    {
        ivec2 pixel = min(first + ivec2(i & 7, i >> 3), size_px - 1);
        uvec2 words = load_cell(pixel, 0);
        float depth = depth_in(words, pixel);
        if (!(depth > 0.0)) continue;
        vec2 held = held_depths(pixel, depth, words.y);
        front     = max(front, held.x);
        back      = min(back, held.y);
    }
    store_fronts(tile_index(first, 8), front * tile_fronts_nearer_by);
    store_backs(tile_index(first, 8), back);
}
"""
READ = """// The nearest and the farthest depth of the tile that holds a pixel; counted.
vec2 fetch_depths(ivec2 pixel)
{
    count_fetch(STRUCTURE_tile_fronts);
    return vec2(load_fronts(tile_index(pixel, 8)), load_backs(tile_index(pixel, 8)));
}
bool touches_tile(vec2 covered, ivec2 pixel)
{
    vec2 depths = fetch_depths(pixel);
    return covered.x <= depths.x && covered.y >= depths.y;
}
"""
TECHNIQUE = """name       = "Tile skip"
summary    = "Skips tiles in front of which or behind which the ray stays, and walks the pixels of the others."
structures = ["tile_fronts"]
exact      = true
bounded_by = ["max_steps"]
[parameters]
max_steps = { default = 60000, min = 0, max = 60000, doc = "Tiles and pixels visited before the ray gives up." }
"""
TRACE = """#include "api/covered_depths.glsl"
#include "api/test_pixel.glsl"

TraceResult trace(Ray ray)
{
    Grid      grid     = make_grid(ray);
    crossing2 t_border = border_t(ray, grid, ray.start_pixel + grid.forward);
    crossing  t_in     = exit_t(grid, t_border);
    ivec2     pixel    = cross_borders(grid, ray.start_pixel, t_border, t_in), tile = pixel >> 3;
    bool      enters   = true; // has it just entered this tile?
    Contact   contact  = no_contact();
    int       visited  = 0;
    while (!contact.found && t_in < grid.t_end && visited < max_steps)
    {
        ++visited;
        int level  = enters ? 3 : 0;
        ivec2 cell = enters ? tile : pixel;
        t_border   = border_t(ray, grid, (cell + grid.forward) << level);
        crossing t_out = exit_t(grid, t_border);
        bool opens = enters && touches_tile(vec2(covered_depths(ray, grid, t_in, t_out)), tile << 3);
        if (!enters) contact = test_pixel(ray, grid, pixel, t_in, t_out);
        if (opens)
        {
            // Of the tile's pixels, the one that holds the ray at t_in: the borders crossed by then name it.
            for (int half_px = 4; half_px > 0; half_px >>= 1)
            {
                bvec2 beyond = lessThanEqual(border_t(ray, grid, cell * 2 * half_px + half_px), crossing2(t_in));
                cell = 2 * cell + ivec2(equal(ivec2(beyond), grid.forward));
            }
            pixel  = cell;
            enters = false;
        }
        else
        {
            ivec2 next = cross_borders(grid, cell, t_border, t_out);
            ivec2 next_tile = enters ? next : next >> 3;
            enters = enters || next_tile != tile;
            tile   = next_tile;
            pixel  = next;
            t_in   = t_out;
        }
    }
    if (contact.found) return hit(ray, contact, visited);
    return t_in < grid.t_end ? out_of_steps(visited) : miss(ray, visited);
}
"""
SWEEP = """scenes = ["builtin:stairs"]
sizes  = ["161x91"]
[techniques.tile_skip]
"tile_fronts.nearer_by" = [1.0, 2.0]
[techniques.dda]
[measure]
min_repeats = 1
max_repeats = 1
"""
# The same rays end in the same way, in the same pixel.
SAME_ANSWERS = ["rays", "hit_share", "left_screen_share", "past_max_distance_share", "out_of_steps_share", "screen_same_pixel", "recall_1px",
                "precision_1px", "picture_rmse"]


class Test(Case):
    def setUp(self):
        super().setUp()
        self.write("mine/tile_fronts/structure.toml", STRUCTURE)
        self.build = self.write("mine/tile_fronts/build.comp", BUILD)
        self.write("mine/tile_fronts/read.glsl", READ)
        self.write("mine/tile_skip/technique.toml", TECHNIQUE)
        self.write("mine/tile_skip/trace.glsl", TRACE)
        self.spec = self.write("s.toml", SWEEP)

    def test_is_shown_with_its_parameters(self):
        self.ssrlab("--techniques", "mine", "show", "tile_skip", says=["Depths of tiles", "tile_fronts.nearer_by", "1 … 4"])

    def test_is_swept_and_recorded(self):
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 3)
        skips = {row["tile_fronts.nearer_by"]: row for row in rows if row["technique"] == "tile_skip"}
        walk = next(row for row in rows if row["technique"] == "dda")
        self.assertEqual(sorted(skips), ["1", "2"])
        self.assertEqual(walk["tile_fronts.nearer_by"], "")
        for row in skips.values():
            for column in SAME_ANSWERS:
                self.assertEqual(row[column], walk[column], column)
            self.assertGreater(float(row["tile_fronts.fetches_mean"]), 0)
            self.assertLess(float(row["depth_fetches_mean"]), float(walk["depth_fetches_mean"]))
            self.assertGreater(float(row["tile_fronts.ms_median"]), 0)
        self.assertLess(float(skips["1"]["depth_fetches_mean"]), float(skips["2"]["depth_fetches_mean"]))

    def test_holds_every_layer(self):
        # The board hides the shelf in whole tiles, where nothing of the first layer is as far away.
        layered = SWEEP.replace("builtin:stairs", "builtin:hidden_shelf").replace("161x91", "483x273").replace("[techniques.tile_skip]", '[trace]\nlayers = 3\nsurface = ["box", "plane"]\n[techniques.tile_skip]', 1)
        self.ssrlab("run", self.write("layers.toml", layered.replace("[1.0, 2.0]", "1.0")), "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 4)
        for surface in ("box", "plane"):
            skips, walk = (next(row for row in rows if (row["technique"], row["surface"]) == (technique, surface)) for technique in ("tile_skip", "dda"))
            for column in (*SAME_ANSWERS, "hidden_too_recall_1px", "wrong_rays"):
                self.assertEqual(skips[column], walk[column], f"{surface}, {column}")
            self.assertLess(float(skips["depth_fetches_mean"]), float(walk["depth_fetches_mean"]))

    def test_holds_the_hard_cases(self):
        self.ssrlab("--techniques", "mine", "check", "tile_skip", says=["rows hold"])

    def test_error_in_its_shader_names_file_and_line(self):
        self.write("mine/tile_fronts/build.comp", BUILD.replace("float front = BACK", "float front = BAKC"))
        self.refused("render", "builtin:stairs", "-t", "tile_skip", "--techniques", "mine", "--size", "64x36", "-o", "a.png", code=2,
                     says=["mine/tile_fronts/build.comp:10", "BAKCGROUND_DEPTH"])


if __name__ == "__main__":
    main()
