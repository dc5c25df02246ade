"""A frame of another renderer as SCENE: exported, described, rendered, swept."""
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
        spec = SPEC.replace("96x54", "640x360")  # a frame has its own size
        self.ssrlab("run", self.write("s.toml", spec), "-o", "out")
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

    def test_what_is_missing_is_said(self):
        self.ssrlab("render", "frame.exr", "-t", "hiz", "-o", "picture.exr")
        self.refused("render", "picture.exr", "-t", "hiz", "-o", "again.png", code=2,
                     says=["picture.exr: nothing says how the camera looks", "picture.exr.toml", "docs/reference/frame_files.md"])
        self.refused("render", "frame.exr", "-t", "hiz", "--size", "64x36", "-o", "again.png", code=2,
                     says=["frame of 96x54 pixels: it cannot be drawn at 64x36"])
        self.refused("trace", "none.exr", "-t", "hiz", "-o", "again.exr", code=2, says=["none.exr: no such file"])


if __name__ == "__main__":
    main()
