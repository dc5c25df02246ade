"""A technique whose answers cannot be: its rows are invalid, and the command in the message shows the ray."""
import re

from support import Case, main

MANIFEST = """name    = "Impossible"
summary = "Answers what cannot be."
bounded_by = ["most"]
[parameters]
most = { default = 8, min = 1, max = 8, doc = "Declared bound." }
"""
SWEEP = """scenes = ["builtin:mirror_floor_wall"]
sizes  = ["64x36"]
[trace]
thickness_m = 0.25
[techniques.odd]
[techniques.dda]
[measure]
min_repeats = 1
max_repeats = 1
"""
PLACES = "TRACE_HIT, ray.start_pixel + ivec2(0, -1)"


class Test(Case):
    def found_invalid(self, body, says, code=1):
        self.write("mine/odd/technique.toml", MANIFEST)
        self.write("mine/odd/trace.glsl", f"TraceResult trace(Ray ray)\n{{\n{body}\n}}\n")
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine", code=code)
        odd, dda = sorted(self.rows(), key=lambda row: row["technique"] == "dda")
        self.assertEqual((odd["outcome"], dda["outcome"]), ("invalid", "ok"), odd["message"])
        self.assertRegex(odd["message"], r"^\d+ of \d+ rays have an answer that cannot be; the first is the ray of pixel \(\d+, \d+\): ")
        self.assertIn(says, odd["message"])
        for column in ("recall_1px", "steps_mean", "trace_ms_median", "picture"):
            self.assertEqual(odd[column], "", column)
        command = re.search(r"; ssrlab (trace .*)$", odd["message"]).group(1).split()
        self.assertIn("thickness_m=0.25", command)
        self.refused(*command, code=1, says=["rays have an answer that cannot be", says])
        if not says: return  # another shader may find other words in what was never written
        alone = ["builtin:mirror_floor_wall", "--techniques", "mine", "--size", "64x36", "-t", "odd", "-p", "thickness_m=0.25"]
        self.refused("render", *alone, "-o", "odd.png", code=1, says=["rays have an answer that cannot be", says])
        pixel = ",".join(re.search(r"the first is the ray of pixel \((\d+), (\d+)\)", odd["message"]).groups())
        self.ssrlab("ray", *alone, "--pixel", pixel, says=["impossible: " + says])

    def test_hit_off_the_image(self):
        self.found_invalid("return hit_at(ray, ivec2(-5, 99999), real(0.5), real(0.5), 1);", "hit pixel (-5, 99999) is off the image of 64x36")

    def test_hit_one_pixel_off_the_image(self):
        self.found_invalid("return hit_at(ray, ivec2(64, 10), real(0.5), real(0.5), 1);", "hit pixel (64, 10) is off the image of 64x36")

    def test_t_that_is_no_number(self):
        self.found_invalid(f"return TraceResult({PLACES}, sqrt(ray.origin.z - real(2)), 1);", "t of a hit is not a number")

    def test_t_beyond_the_segment(self):
        self.found_invalid(f"return TraceResult({PLACES}, real(7), 1);", "t = 7")

    def test_steps_below_zero(self):
        self.found_invalid("return miss(ray, -1);", "4294967295 steps")

    def test_more_steps_than_declared(self):
        self.found_invalid("return miss(ray, 9);", "9 steps, but the technique declares at most 8")

    def test_unknown_status(self):
        self.found_invalid("return TraceResult(200, ivec2(0), real(0), 1);", "status 200 is none of 1 … 6")

    def test_status_below_zero(self):
        self.found_invalid("return TraceResult(-1, ivec2(0), real(0), 1);", "status -1")

    def test_ray_that_is_not_answered(self):
        self.found_invalid("return TraceResult(TRACE_NOT_TRACED, ivec2(0), real(0), 1);", "status 0")

    def test_uninitialised_result(self):
        self.found_invalid("TraceResult result;\n    return result;", "")

    def test_one_bad_ray_is_enough(self):
        self.found_invalid("return ray.start_pixel == ivec2(32, 30) ? hit_at(ray, ivec2(-1, 0), real(0.5), real(0.5), 1) : miss(ray, 1);",
                           "hit pixel (-1, 0) is off the image of 64x36")

    def test_a_miss_may_leave_its_pixel_undefined(self):
        self.write("mine/odd/technique.toml", MANIFEST)
        self.write("mine/odd/trace.glsl", "TraceResult trace(Ray ray)\n{\n    return TraceResult(ray.end_status, ivec2(-5, 99999), real(7), 1);\n}\n")
        self.ssrlab("run", self.write("s.toml", SWEEP), "-o", "out", "--techniques", "mine")
        self.assert_complete(self.rows(), 2)

    def test_invalid_rows_are_tried_again(self):
        self.test_unknown_status()
        self.ssrlab("run", "s.toml", "-o", "out", "--resume", "--techniques", "mine", code=1, says=["1 written now", "1 of them failed"])
        self.assertEqual(sorted(row["outcome"] for row in self.rows()), ["invalid", "ok"])


if __name__ == "__main__":
    main()
