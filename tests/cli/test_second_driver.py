"""SwiftShader, which Debian's chromium brings: a second driver, with small texel buffers and without doubles."""
import os

import numpy
import OpenImageIO

from support import SOURCE, Case, main

DRIVER = "/usr/lib/chromium/vk_swiftshader_icd.json"
SPEC = """scenes = ["builtin:pole_field"]
sizes  = ["64x36"]
[passes]
pass_set = "shading"
[techniques.hiz]
[measure]
min_repeats = 2
max_repeats = 2
budget_s    = 0
"""
SHADING = ("-p", "pass_set=shading") # it compiles for most of a minute what a whole frame needs
EXACT = ("dda", "hiz", "hiz_packets", "hiz_waves", "quadtree")


class Test(Case):
    def setUp(self):
        super().setUp()
        self.assertTrue(os.path.exists(DRIVER), f"no {DRIVER}: install Debian's package chromium")

    def second(self, *arguments, **more):
        return self.ssrlab("--validation", *arguments, VK_ICD_FILENAMES=DRIVER, **more)

    def found(self, name):
        """What trace wrote of each ray but its work, as bits."""
        picture = OpenImageIO.ImageBuf(self.path(name))
        names = picture.spec().channelnames
        kept = [i for i, channel in enumerate(names) if "steps" not in channel and "fetches" not in channel]
        self.assertGreater(len(kept), 3, names)
        return picture.get_pixels(OpenImageIO.FLOAT)[..., kept].astype(numpy.float32).view(numpy.uint32)

    def test_same_frame_same_bits(self):
        self.ssrlab("gbuffer", "builtin:pole_field", "--size", "320x180", "-o", "frame.exr")
        for surface, behind in (("box", "hit"), ("plane", "stop")):
            settings = ("-p", "max_distance_m=20", "-p", f"surface={surface}", "-p", f"behind={behind}")
            self.ssrlab("trace", "frame.exr", "-t", "dda", *settings, "-o", "first.exr")
            first = self.found("first.exr")
            for technique in EXACT:
                self.second("trace", "frame.exr", "-t", technique, *settings, "-o", "second.exr")
                differ = (self.found("second.exr") != first).any(axis=-1).sum()
                self.assertEqual(differ, 0, f"{technique}, {surface}: pixels that differ between the drivers")

    def test_smoke(self):
        self.second("run", os.path.join(SOURCE, "experiments", "smoke.toml"), "-o", "out")
        rows = self.rows()
        self.assertTrue(all(row["outcome"] == "ok" for row in rows), [row["message"] for row in rows])
        self.assertIn("plain buffers", self.text("out/environment.json"))

    def test_without_scene_truth_where_it_draws_another_scene(self):
        spec = self.write("s.toml", SPEC)
        self.ssrlab("run", spec, "-o", "first")
        self.second("run", spec, "-o", "out", says=["builtin:pole_field 64x36: no scene truth: the driver draws another scene"])
        (first,), (second,) = self.rows("first"), self.rows()
        self.assertLess(float(first["depth_off_scene"]), 0.001)
        self.assertGreater(float(second["depth_off_scene"]), 0.05, "it rounds corners to 1/16 pixel")
        self.assertEqual((first["no_scene_truth"], second["outcome"]), ("", "ok"))
        self.assertIn("off every surface", second["no_scene_truth"])
        self.assertTrue(first["recall_1px"] and first["picture_rmse"] and second["screen_same_pixel"])
        for more in ("--side-by-side", "--show=agreement"):
            self.refused("render", "builtin:pole_field", "-t", "hiz", "--size", "64x36", *SHADING, more, "-o", "a.png", code=1,
                         says=["no scene truth: the driver draws another scene"], VK_ICD_FILENAMES=DRIVER)
        self.second("ray", "builtin:pole_field", "-t", "hiz", "--size", "64x36", "--pixel", "32,30",
                    says=["it may be false: the depth that was drawn here is off every surface"])
        self.assertEqual([second[name] for name in ("recall_1px", "truth_visible", "picture_rmse", "truth_picture")], [""] * 4)

    def test_what_it_cannot_do_is_said(self):
        self.refused("trace", "builtin:stairs", "-t", "dda", "-p", "arithmetic=exact", "-o", "a.exr", code=1,
                     says=["arithmetic = exact", "SwiftShader", "shaderInt64"], VK_ICD_FILENAMES=DRIVER)
        self.refused("render", "builtin:stairs", "-t", "dda", "-p", "layers=4", *SHADING, "-o", "a.png", code=1,
                     says=["images are needed", "SwiftShader", "allows 16"], VK_ICD_FILENAMES=DRIVER)
        self.second("check", "dda", "--quick", "--case", "parameters_at_their_maximum", says=["left out", "shaderInt64"])


if __name__ == "__main__":
    main()
