"""A technique outside the source tree, without rebuilding."""
import csv

from support import Case, main

MANIFEST = """name    = "Coin toss"
summary = "Looks at one place along the ray."
[parameters]
place = { default = 0.5, min = 0.0, max = 1.0, doc = "Where, as a part of the ray on screen." }
"""
TRACE = """TraceResult trace(Ray ray)
{
    ivec2 pixel = pixel_at(ray, real(place));
    real  depth = depth_at(ray, real(place));
    if (pixel != ray.start_pixel && touches_surface(ray, pixel, depth, depth)) return hit_at(ray, pixel, real(place), 1);
    return miss(ray, 1);
}
"""
SWEEP = """scenes = ["builtin:mirror_floor_wall"]
sizes  = ["64x36"]
[techniques.coin]
place = [0.25, 0.75]
[techniques.dda]
[measure]
min_repeats = 1
max_repeats = 1
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        self.assertLess(len((MANIFEST + TRACE).splitlines()), 25)
        self.manifest = self.write("mine/coin/technique.toml", MANIFEST)
        self.trace = self.write("mine/coin/trace.glsl", TRACE)
        self.spec = self.write("s.toml", SWEEP)

    def test_is_listed_shown_and_rendered(self):
        self.ssrlab("--techniques", "mine", "list", says=["coin", "Looks at one place"])
        self.ssrlab("--techniques", "mine", "show", "coin", says=["place", "0 … 1", "mine/coin"])
        self.ssrlab("list", says=["coin"], SSRLAB_TECHNIQUES=self.path("mine"))
        self.ssrlab("render", "builtin:mirror_floor_wall", "-t", "coin", "-p", "place=0.3", "--techniques", "mine/coin",
                    "--size", "64x36", "-o", "a.png")

    def test_is_swept_and_recorded(self):
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine")
        rows = self.rows()
        self.assert_complete(rows, 3)
        self.assertEqual(sorted(row["place"] for row in rows if row["technique"] == "coin"), ["0.25", "0.75"])
        coin = next(row for row in rows if row["technique"] == "coin")
        self.assertLessEqual(float(coin["fetches_mean"]), 1)
        self.assertNotEqual(coin["screen_same_pixel"], "")

    def test_error_in_its_shader_names_file_and_line(self):
        self.write("mine/coin/trace.glsl", TRACE.replace("ivec2 pixel = pixel_at", "ivec2 pixel = pixle_at"))
        self.refused("render", "builtin:mirror_floor_wall", "-t", "coin", "--techniques", "mine", "--size", "64x36", "-o", "a.png",
                     code=2, says=["mine/coin/trace.glsl:3", "pixle_at"])

    def test_error_in_its_shader_is_a_failed_row(self):
        self.write("mine/coin/trace.glsl", TRACE.replace("ivec2 pixel = pixel_at", "ivec2 pixel = pixle_at"))
        self.ssrlab("run", self.spec, "-o", "out", "--techniques", "mine", code=1)
        with open(self.path("out/results.csv"), encoding="utf-8", newline="") as file:
            outcome = {(row["technique"], row["outcome"], "coin/trace.glsl:3" in row["message"]) for row in csv.DictReader(file)}
        self.assertEqual(outcome, {("coin", "failed", True), ("dda", "ok", False)})

    def test_error_in_its_manifest_names_file_and_line(self):
        self.write("mine/coin/technique.toml", MANIFEST.replace("default = 0.5", "default = 2.0"))
        self.refused("list", "--techniques", "mine", code=2, says=["mine/coin/technique.toml:4", "place"])

    def test_folder_that_does_not_exist(self):
        self.refused("list", "--techniques", "nowhere", code=2, says=["nowhere"])


if __name__ == "__main__":
    main()
