"""A structure outside the source tree and a technique that reads it: those of docs/how-to/write_a_structure.md."""
import os
import shutil

from support import SOURCE, Case, main

SWEEP = """scenes = ["builtin:stairs"]
sizes  = ["64x36"]
[techniques.tile_walk]
[techniques.dda]
[techniques.hiz]
depth_pyramid.kind = ["occupancy", "nearest"]
[measure]
min_repeats = 1
max_repeats = 1
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        for folder in ("tile_fronts", "tile_walk"):
            shutil.copytree(os.path.join(SOURCE, "tests/techniques", folder), self.path(f"mine/{folder}"))

    def test_it_is_listed_and_shown(self):
        self.ssrlab("--techniques", "mine", "list", says=["tile_walk", "reads a pixel only"])
        self.ssrlab("--techniques", "mine", "show", "tile_walk", says=["structure: tile_fronts", "max_steps"])

    def test_it_renders_without_a_validation_message(self):
        self.ssrlab("--techniques", "mine", "--validation", "render", "builtin:stairs", "-t", "tile_walk", "--size", "65x37",
                    "-o", "a.png")

    def test_it_holds_on_the_hard_cases(self):
        self.ssrlab("--techniques", "mine", "check", "tile_walk")

    def test_its_structure_is_in_the_sweep(self):
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 4)
        own = next(row for row in rows if row["technique"] == "tile_walk")
        self.assertGreater(float(own["tile_fronts.ms_median"]), 0)
        self.assertGreater(float(own["tile_fronts.fetches_mean"]), 0)
        self.assertEqual(own["screen_same_pixel"], next(row for row in rows if row["technique"] == "dda")["screen_same_pixel"])
        walk = next(row for row in rows if row["technique"] == "dda")
        self.assertLess(float(own["depth_fetches_mean"]), float(walk["depth_fetches_mean"]))
        self.assertEqual({row["depth_pyramid.kind"] for row in rows if row["technique"] == "hiz"}, {"occupancy", "nearest"})

    def misspell(self, name, right, wrong):
        with open(self.path(f"mine/{name}"), encoding="utf-8") as file:
            text = file.read()
        self.assertIn(right, text)
        self.write(f"mine/{name}", text.replace(right, wrong))

    def test_mistakes_name_the_file_and_line(self):
        self.misspell("tile_fronts/build.comp", "load_cell(pixel", "load_clel(pixel")
        self.refused("--techniques", "mine", "render", "builtin:stairs", "-t", "tile_walk", "--size", "64x36", "-o", "a.png", code=2,
                     says=["mine/tile_fronts/build.comp:16", "load_clel"])
        self.misspell("tile_walk/technique.toml", '["tile_fronts"]', '["tile_front"]')
        self.refused("--techniques", "mine", "list", code=2,
                     says=["mine/tile_walk/technique.toml:3", "unknown structure 'tile_front'", "did you mean 'tile_fronts'"])

    def test_a_parameter_with_the_name_of_another_technique_s_changes_nothing(self):
        """A parameter means to the framework what the manifest says, whatever its name."""
        hiz = os.path.join(SOURCE, "techniques", "hiz")
        with open(os.path.join(hiz, "technique.toml"), encoding="utf-8") as file:
            manifest = file.read()
        with open(os.path.join(hiz, "trace.glsl"), encoding="utf-8") as file:
            self.write("mine/own/trace.glsl", file.read())
        names = ("top_level", "pyramid", "beams", "kind", "stride_px", "plan")
        self.write("mine/own/technique.toml", manifest + "".join(f'{name} = {{ default = 1, min = 0, max = 9, doc = "Mine." }}\n' for name in names))
        spec = self.write("s.toml", SWEEP.replace("tile_walk", "own"))
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        own, hiz = (next(row for row in self.rows() if row["technique"] == name) for name in ("own", "hiz"))
        for column in ("hit_share", "recall_1px", "steps_mean", "fetches_mean"):
            self.assertEqual(own[column], hiz[column], column)


if __name__ == "__main__":
    main()
