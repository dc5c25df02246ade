"""A surface model outside the source tree, without rebuilding: that of docs/how-to/write_a_surface_model.md."""
import json
import os

import numpy
import OpenImageIO as oiio
from support import SOURCE, Case, main, read

FILES = ("surface.toml", "meeting.glsl", "held.glsl")
SWEEP = """scenes = ["builtin:sphere_over_mirror"]
sizes  = ["97x61"]
[trace]
surface = ["sloped_slab", "box"]
behind  = "stop"
[techniques.dda]
[techniques.hiz]
[techniques.hiz_packets]
[measure]
min_repeats = 1
max_repeats = 1
"""
# The same rays end in the same way, in the same pixel.
SAME_ANSWERS = ["rays", "hit_share", "stopped_share", "left_screen_share", "past_max_distance_share", "recall_1px", "precision_1px",
                "false_hits", "rmse_reflective"]


class Test(Case):
    def setUp(self):
        super().setUp()
        self.blocks = {}
        for name in FILES:
            self.blocks[name] = read("tests/techniques/sloped_slab", name)
            self.write(f"mine/sloped_slab/{name}", self.blocks[name])

    def hits(self, technique, *parameters, scene="interior"):
        """How each ray ended, as one array: without the counts of work, which differ."""
        self.ssrlab("--techniques", "mine", "trace", scene, "-t", technique, "--size", "161x91", "-o", "h.exr",
                    *[word for pair in ("surface=sloped_slab", *parameters) for word in ("-p", pair)])
        image = oiio.ImageBuf(self.path("h.exr"))
        self.assertFalse(image.has_error, image.geterror())
        names = image.spec().channelnames
        kept = ["status", "layer", "pixel.x", "pixel.y", "hit.x", "hit.y", "hit.z", "hit.t"]
        return image.get_pixels(oiio.FLOAT)[:, :, [names.index(name) for name in kept]]

    def test_is_listed_and_shown(self):
        self.ssrlab("--techniques", "mine", "list", says=["Surface models", "sloped_slab", "plane_solid", "run's thickness behind it."])
        self.ssrlab("--techniques", "mine", "show", "sloped_slab",
                    says=["Sloped slab", "surface=sloped_slab", "besides depth and normal: gradient", "known by its shaders alone"])
        self.ssrlab("--techniques", "mine", "show", "surface", says=["box | ", "sloped_slab", "default plane_solid"])
        listed = json.loads(self.ssrlab("--techniques", "mine", "list", "--json"))
        truths = {one["name"]: one["screen_truth"] for one in listed["surfaces"]}
        self.assertEqual(truths, {"box": True, "box_infinite": True, "box_two_sided": True, "plane": True, "plane_infinite": True, "plane_sides": True,
                                  "plane_solid": True, "sloped_slab": False})
        self.ssrlab("show", "plane_solid", says=["gradient, solid", "screen truth: yes", "Gustafsson"])

    def test_is_swept_and_its_missing_truth_is_said(self):
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 6)
        of = {(row["surface"], row["technique"]): row for row in rows}
        for surface in ("sloped_slab", "box"):
            for technique in ("hiz", "hiz_packets"):
                for column in SAME_ANSWERS:
                    self.assertEqual(of[surface, technique][column], of[surface, "dda"][column], f"{surface} {technique} {column}")
        own, box = of["sloped_slab", "hiz"], of["box", "hiz"]
        self.assertNotEqual(own["precision_1px"], box["precision_1px"])
        self.assertEqual(own["no_screen_truth"], "the surface model sloped_slab is known by its shaders alone")
        self.assertEqual(box["no_screen_truth"], "")
        needs_truth = [name for name in own if name.startswith("screen_")] + [
            "missed_stepped_over", "missed_not_in_depth", "error_scene_to_screen", "error_screen_to_double"]
        for column in needs_truth:
            self.assertEqual(own[column], "", column)
            self.assertTrue(box[column] or column.startswith("screen_displacement"), column)
        for column in ("recall_1px", "precision_1px", "false_hits", "flips_per_million", "rmse_reflective"):
            self.assertNotEqual(own[column], "", column)
        self.assertIn("surface sloped_slab", json.loads(self.text("out/environment.json"))["identity"])

    def test_a_sweep_of_its_thickness_is_plotted(self):
        spec = self.write("s.toml", SWEEP.replace("[techniques.dda]\n", "").replace("[techniques.hiz_packets]\n", "").replace("[trace]\n", "[trace]\nthickness_m = [0.1, 0.3]\n"))
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        self.ssrlab("plot", "out")
        self.assertTrue(os.path.exists(self.path("out/plots/surfaces_precision_recall_builtin_sphere_over_mirror_default_97x61.png")))
        self.assertEqual({row["surface"] for row in self.rows(table="surfaces.csv")}, {"sloped_slab", "box"})

    def test_a_bound_that_is_too_tight_shows(self):
        """Structures skip only what no ray meets (tests/gpu/own_surface.cpp). Bounds that leave out a part of what the pixel holds lose hits."""
        tight = self.blocks["held.glsl"].replace("held.back     = float(slab_back(real(depth))) - margin;", "held.back     = depth;")
        self.assertNotEqual(tight, self.blocks["held.glsl"])
        walk = self.hits("dda", "thickness_m=0.5")
        self.write("mine/sloped_slab/held.glsl", tight)
        self.assertFalse(numpy.array_equal(self.hits("hiz", "thickness_m=0.5"), walk))
        self.ssrlab("--techniques", "mine", "trace", "interior", "-t", "exact", "--size", "161x91", "-o", "h.exr", "-p", "surface=sloped_slab",
                    "-p", "thickness_m=0.5", says=["warning: exact leaves hiz out"], XDG_CACHE_HOME=self.path("cache"))

    def test_is_found_by_the_environment(self):
        self.environment["SSRLAB_TECHNIQUES"] = self.path("mine/sloped_slab")
        self.ssrlab("show", "sloped_slab", says=["Sloped slab"])

    def test_has_no_validation_messages(self):
        self.ssrlab("--techniques", "mine", "--validation", "render", "builtin:stairs", "-t", "hiz", "-p", "surface=sloped_slab",
                    "-p", "layers=2", "--size", "65x37", "-o", "a.png")

    def test_mistakes_name_file_and_line(self):
        render = ["--techniques", "mine", "render", "builtin:stairs", "-t", "hiz", "--size", "64x36", "-o", "a.png", "-p"]
        self.refused(*render, "surface=sloped_slap", code=2, says=["surface", "sloped_slab", "'sloped_slap'"])
        self.refused(*render, "surface=sloped_slab", "-p", "arithmetic=exact", code=2,
                     says=["arithmetic = exact", "sloped_slab", "meeting_exact.glsl"])
        self.write("mine/sloped_slab/meeting.glsl", self.blocks["meeting.glsl"].replace("surface.back;\n}", "surface.bakc;\n}", 1))
        self.refused(*render, "surface=sloped_slab", code=2, says=["mine/sloped_slab/meeting.glsl:31", "bakc"])
        self.write("mine/sloped_slab/meeting.glsl", self.blocks["meeting.glsl"])
        self.write("mine/sloped_slab/surface.toml", self.blocks["surface.toml"].replace('"gradient"', '"gradeint"'))
        self.refused("--techniques", "mine", "list", code=2, says=["surface.toml:3", "gradeint", "gradient"])
        self.write("mine/sloped_slab/surface.toml", self.blocks["surface.toml"].replace("needs", "neads"))
        self.refused("--techniques", "mine", "list", code=2, says=["surface.toml:3", "neads", "needs"])
        self.write("mine/sloped_slab/surface.toml", self.blocks["surface.toml"])
        os.remove(self.path("mine/sloped_slab/held.glsl"))
        self.refused("--techniques", "mine", "list", code=2, says=["sloped_slab/held.glsl: missing"])

    def test_what_it_reads_without_declaring_it_is_said(self):
        """Else it would read what is not there: the pixel beside it for a gradient, nothing for a solid."""
        def refused(technique, *says):
            self.refused("--techniques", "mine", "render", "builtin:stairs", "-t", technique, "--size", "64x36", "-o", "a.png", "-p",
                         "surface=sloped_slab", code=2, says=says)
        self.write("mine/sloped_slab/surface.toml", self.blocks["surface.toml"].replace('needs   = ["gradient"]\n', ""))
        refused("dda", "mine/sloped_slab/meeting.glsl:12: 'unpack_gradient'", '(write needs = ["gradient"] in mine/sloped_slab/surface.toml)')
        level = self.blocks["meeting.glsl"].replace("unpack_gradient(words.y)", "vec2(0)").replace("has_plane(stored)", "true")
        self.write("mine/sloped_slab/meeting.glsl", level)
        refused("hiz", "mine/sloped_slab/held.glsl:6: 'unpack_gradient'", '(write needs = ["gradient"] in mine/sloped_slab/surface.toml)')
        self.write("mine/sloped_slab/surface.toml", self.blocks["surface.toml"])
        solid = self.blocks["meeting.glsl"].replace("slab_back(depth) - depth", "real(load_solid(pixel, layer)) - depth", 1)
        self.write("mine/sloped_slab/meeting.glsl", '#include "surfaces/plane/solid.glsl"\n' + solid)
        refused("dda", "mine/sloped_slab/meeting.glsl:18: 'load_solid'", '(write needs = ["gradient", "solid"] in mine/sloped_slab/surface.toml)')
        # The same for the project's files, compiled for a model that declares nothing.
        self.write("mine/borrowed/surface.toml", 'name = "Borrowed"\nsummary = "Planes without their gradient."\ndefines = ["SOLID_NONE"]\nshaders = "PLANE"\n'
                   .replace("PLANE", os.path.relpath(os.path.join(SOURCE, "shaders/surfaces/plane"), self.path("mine/borrowed"))))
        self.refused("--techniques", "mine", "render", "builtin:stairs", "-t", "dda", "--size", "64x36", "-o", "a.png", "-p", "surface=borrowed", code=2,
                     says=["surfaces/plane/meeting.glsl:", "'unpack_gradient'", '(write needs = ["gradient"] in mine/borrowed/surface.toml)'])

    def test_two_of_one_name_are_refused(self):
        for name, text in self.blocks.items():
            self.write(f"mine/box/{name}", text)
        self.refused("--techniques", "mine", "list", code=2, says=["two surface models are called 'box'", "mine/box"])

    def test_what_needs_a_screen_truth_says_so(self):
        self.refused("--techniques", "mine", "ray", "builtin:stairs", "--size", "97x61", "--pixel", "48,40", "-t", "hiz", "-p",
                     "surface=sloped_slab", code=2, says=["sloped_slab", "no screen truth"])


if __name__ == "__main__":
    main()
