"""A structure outside the source tree and a technique that reads it: those of docs/how-to/write_a_structure.md."""
import os
import shutil

from support import SOURCE, Case, main, read

SWEEP = """scenes = ["builtin:stairs"]
sizes  = ["161x91"]
[techniques.tile_walk]
[techniques.dda]
[techniques.hiz]
depth_pyramid.kind = ["occupancy", "nearest"]
[measure]
min_repeats = 1
max_repeats = 1
"""
# The same rays end in the same way, in the same pixel.
SAME_ANSWERS = ["rays", "hit_share", "left_screen_share", "past_max_distance_share", "out_of_steps_share", "screen_same_pixel", "recall_1px",
                "precision_1px", "picture_rmse", "hidden_too_recall_1px", "wrong_rays"]


class Test(Case):
    def setUp(self):
        super().setUp()
        for folder in ("tile_fronts", "tile_walk"):
            shutil.copytree(os.path.join(SOURCE, "tests/techniques", folder), self.path(f"mine/{folder}"))

    def change(self, name, before, after):
        text = self.text(f"mine/{name}")
        self.assertIn(before, text)
        self.write(f"mine/{name}", text.replace(before, after))

    def swept(self, spec, count):
        """Rows by technique, after the sweep; the walk by tiles answers as dda does and reads less."""
        self.ssrlab("run", self.write("s.toml", spec), "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, count)
        for walk in (row for row in rows if row["technique"] == "dda"):
            for own in (row for row in rows if row["technique"] == "tile_walk" and row["surface"] == walk["surface"]):
                for column in SAME_ANSWERS:
                    self.assertEqual(own[column], walk[column], f"{walk['surface']}, {column}")
                self.assertLess(float(own["depth_fetches_mean"]), float(walk["depth_fetches_mean"]))
                self.assertGreater(float(own["tile_fronts.ms_median"]), 0)
                self.assertGreater(float(own["tile_fronts.fetches_mean"]), 0)
        return rows

    def test_it_is_listed_and_shown(self):
        self.ssrlab("--techniques", "mine", "list", says=["tile_walk", "reads a pixel only"])
        self.ssrlab("--techniques", "mine", "show", "tile_walk", says=["structure: tile_fronts", "max_steps"])

    def test_it_renders_without_a_validation_message(self):
        self.ssrlab("--techniques", "mine", "--validation", "render", "builtin:stairs", "-t", "tile_walk", "--size", "65x37",
                    "-o", "a.png")

    def test_it_holds_on_the_hard_cases(self):
        self.ssrlab("--techniques", "mine", "check", "tile_walk", says=["rows hold"])

    def test_its_structure_is_in_the_sweep(self):
        rows = self.swept(SWEEP, 4)
        self.assertEqual({row["depth_pyramid.kind"] for row in rows if row["technique"] == "hiz"}, {"occupancy", "nearest"})

    def test_it_has_a_parameter_of_its_own(self):
        self.change("tile_fronts/structure.toml", "[buffers]", '[parameters]\nnearer_by = { default = 1.0, min = 1.0, max = 4.0, doc = "More skips less." }\n[buffers]')
        self.change("tile_fronts/build.comp", '#include "structure/buffers"', '#include "structure/parameters"\n#include "structure/buffers"')
        self.change("tile_fronts/build.comp", "(first, 8), front)", "(first, 8), front * tile_fronts_nearer_by)")
        self.ssrlab("--techniques", "mine", "show", "tile_walk", says=["tile_fronts.nearer_by", "1 … 4"])
        rows = self.swept(SWEEP.replace("[techniques.tile_walk]", '[techniques.tile_walk]\n"tile_fronts.nearer_by" = [1.0, 2.0]'), 5)
        reads = {row["tile_fronts.nearer_by"]: float(row["depth_fetches_mean"]) for row in rows if row["technique"] in ("tile_walk", "dda")}
        self.assertEqual(sorted(reads), ["", "1", "2"])
        self.assertLess(reads["1"], reads["2"])

    def test_it_holds_every_layer(self):
        # The board hides the shelf in whole tiles, where nothing of the first layer is as far away.
        spec = SWEEP.split("[techniques.hiz]")[0] + "[measure]\nmin_repeats = 1\nmax_repeats = 1\n"
        self.swept(spec.replace("builtin:stairs", "builtin:hidden_shelf").replace("161x91", "483x273").replace(
            "[techniques.tile_walk]", '[trace]\nlayers = 3\nsurface = ["box", "plane"]\n[techniques.tile_walk]'), 4)

    def test_mistakes_name_the_file_and_line(self):
        self.change("tile_fronts/build.comp", "load_cell(pixel", "load_clel(pixel")
        self.refused("--techniques", "mine", "render", "builtin:stairs", "-t", "tile_walk", "--size", "64x36", "-o", "a.png", code=2,
                     says=["mine/tile_fronts/build.comp:16", "load_clel"])
        self.change("tile_walk/technique.toml", '["tile_fronts"]', '["tile_front"]')
        self.refused("--techniques", "mine", "list", code=2,
                     says=["mine/tile_walk/technique.toml:3", "unknown structure 'tile_front'", "did you mean 'tile_fronts'"])

    def test_a_parameter_with_the_name_of_another_technique_s_changes_nothing(self):
        """A parameter means to the framework what the manifest says, whatever its name."""
        self.write("mine/own/trace.glsl", read("techniques/hiz/trace.glsl"))
        names = ("top_level", "pyramid", "beams", "kind", "stride_px", "plan")
        self.write("mine/own/technique.toml", read("techniques/hiz/technique.toml") +
                   "".join(f'{name} = {{ default = 1, min = 0, max = 9, doc = "Mine." }}\n' for name in names))
        spec = self.write("s.toml", SWEEP.replace("tile_walk", "own"))
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        own, hiz = (next(row for row in self.rows() if row["technique"] == name) for name in ("own", "hiz"))
        for column in ("hit_share", "recall_1px", "steps_mean", "fetches_mean"):
            self.assertEqual(own[column], hiz[column], column)


if __name__ == "__main__":
    main()
