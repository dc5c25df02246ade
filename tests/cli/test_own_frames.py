"""A frame of another renderer as SCENE: exported, described, rendered, swept."""
import os

import numpy
import OpenImageIO as oiio
from support import Case, main

SPEC = """scenes = ["frame.exr"]
sizes  = ["96x54"]
[trace]
max_distance_m = 20
[techniques.hiz]
[techniques.linear]
steps = 16
[measure]
min_repeats = 1
max_repeats = 1
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        self.ssrlab("gbuffer", "builtin:stairs", "--size", "96x54", "-o", "frame.exr")

    def test_is_swept_without_scene_truth(self):
        self.ssrlab("run", self.write("s.toml", SPEC.replace('sizes  = ["96x54"]\n', "")), "-o", "out")  # a frame has its own size
        for row in self.rows():
            self.assertEqual((row["outcome"], row["width"], row["height"]), ("ok", "96", "54"))
            self.assertEqual(row["no_scene_truth"], "a frame of another renderer has no triangles")
            self.assertEqual((row["recall_1px"], row["picture_rmse"], row["gbuffer_ms_median"]), ("", "", ""))
        self.ssrlab("run", self.write("d.toml", SPEC.replace("frame.exr", "builtin:stairs")), "-o", "drawn")
        of_screen = [[(name, row[name]) for name in row if name.startswith("screen_") or name == "fetches_mean"]
                     for row in self.rows() + self.rows("drawn")]
        self.assertEqual(of_screen[:2], of_screen[2:])
        self.assertTrue(all(value for name, value in of_screen[0] if "displacement" not in name), of_screen[0])

    def test_a_given_picture_is_the_reference(self):
        self.ssrlab("render", "frame.exr", "-t", "hiz", "-p", "max_distance_m=20", "-o", "true.exr")
        self.write("frame.exr.toml", 'reference = "true.exr"\n')
        self.ssrlab("run", self.write("s.toml", SPEC), "-o", "out")
        error = {row["technique"]: float(row["picture_rmse"]) for row in self.rows()}
        self.assertEqual(error["hiz"], 0)
        self.assertGreater(error["linear"], 0)

    def test_what_no_frame_has_is_refused_before_the_runs(self):
        for old, new, line, says in (("96x54", "100x100", 2, ["'frame.exr' is a frame of 96x54 pixels", "got 100x100"]),
                                     ("[trace]", "frames = [3]\n[trace]", 3, ["one frame of another renderer"]),
                                     ("[trace]", "jitter_phases = 4\n[trace]", 3, ["no further frames and no jitter"]),
                                     ("[trace]", "[trace]\nlayers = [1, 2]", 4, ["layers = 2: 'frame.exr'", "expected 1"]),
                                     ("[trace]", "[passes]\nhidden_layer = [false, true]\n[trace]", 4, ["hidden_layer = true: 'frame.exr'", "expected false"]),
                                     ("steps = 16", "steps = 16\nlayers = [1, 2]", 6, ["layers = 2"])):
            for options in (["--dry-run"], ["-o", "out"]):
                with self.subTest(new=new):
                    self.refused("run", self.write("s.toml", SPEC.replace(old, new)), *options, code=2, says=[f"s.toml:{line}: ", *says])
        for command in (["render", "-o", "a.png"], ["plan"]):
            for asked, says in (("layers=2", ["layers = 2: 'frame.exr'", "expected 1"]), ("hidden_layer=true", ["hidden_layer = true: 'frame.exr'", "expected false"])):
                with self.subTest(command=command, asked=asked):
                    self.refused(command[0], "frame.exr", "-t", "hiz", "-p", asked, *command[1:], code=2, says=says)

    def drop(self, channel, name):
        """The frame without a channel, as another renderer writes it."""
        frame = oiio.ImageBuf(self.path("frame.exr"))
        kept  = tuple(one for one in frame.spec().channelnames if one != channel)
        self.assertEqual(len(kept), frame.nchannels - 1)
        self.assertTrue(oiio.ImageBufAlgo.channels(frame, kept).write(self.path(name)))

    def pixels(self, scene, surface, says=()):
        picture = f"{surface}_{scene}"  # OpenImageIO keeps what it has read of a file by that name
        printed = self.ssrlab("render", scene, "-t", "hiz", "-p", "max_distance_m=20", "-p", f"surface={surface}", "-o", picture, says=says)
        return oiio.ImageBuf(self.path(picture)).get_pixels(oiio.FLOAT), printed

    def test_what_the_surface_model_asks_in_vain_is_said(self):
        self.ssrlab("gbuffer", "builtin:sphere_over_mirror", "--size", "96x54", "-o", "frame.exr")
        self.drop("solid_back", "thin.exr")
        lacks   = "no channel solid_back: surface = plane_solid takes every surface of this frame as thin"
        warning = "warning: thin.exr: " + lacks
        thin, _ = self.pixels("thin.exr", "plane_solid", [warning])
        for scene, surface in (("thin.exr", "plane"), ("frame.exr", "plane_solid")):
            same, printed = self.pixels(scene, surface)
            self.assertNotIn("solid_back", printed)
            self.assertEqual(numpy.array_equal(thin, same), surface == "plane")
        self.ssrlab("trace", "thin.exr", "-t", "hiz", "-o", "h.exr", says=[warning])
        self.ssrlab("ray", "thin.exr", "-t", "hiz", "--pixel", "48,48", says=[warning])
        self.ssrlab("judge", "thin.exr", "h.exr", says=[warning])
        swept = SPEC.replace("frame.exr", "thin.exr").replace("[trace]", '[trace]\nsurface = ["plane", "plane_solid"]')
        printed = self.ssrlab("run", self.write("s.toml", swept), "-o", "out")
        self.assertEqual(printed.count(warning), 1)
        self.assertEqual({(row["surface"], row["frame_lacks"]) for row in self.rows()}, {("plane", ""), ("plane_solid", "solid_back")})
        self.ssrlab("plot", "out")
        for report in ("out/report.html", "out/report.md"):
            self.assertEqual(self.text(report).count("thin.exr has " + lacks), 1)
        self.ssrlab("run", self.write("f.toml", SPEC), "-o", "whole")
        self.assertEqual({row["frame_lacks"] for row in self.rows("whole")}, {""})

    def test_what_is_missing_is_said(self):
        self.write("frame.exr.toml", '# of elsewhere\nreference = "missing.exr"\n')
        for command in (["render", "frame.exr", "-t", "hiz", "-o", "again.png"], ["run", self.write("s.toml", SPEC), "-o", "out"]):
            self.refused(*command, code=2, says=["frame.exr.toml:2: frame: 'reference' must be a picture that is there, not missing.exr"])
        os.remove(self.path("frame.exr.toml"))
        self.ssrlab("render", "frame.exr", "-t", "hiz", "-o", "picture.exr")
        self.refused("render", "picture.exr", "-t", "hiz", "-o", "again.png", code=2,
                     says=["picture.exr: nothing says how the camera looks", "picture.exr.toml", "docs/reference/frame_files.md"])
        self.refused("render", "frame.exr", "-t", "hiz", "--size", "64x36", "-o", "again.png", code=2,
                     says=["frame of 96x54 pixels: it cannot be drawn at 64x36"])
        self.refused("trace", "none.exr", "-t", "hiz", "-o", "again.exr", code=2, says=["none.exr: no such file"])


if __name__ == "__main__":
    main()
