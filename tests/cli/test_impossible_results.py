"""Techniques whose answers cannot be: their rows are invalid, and the command in the message shows the ray."""
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
[techniques.dda]
"""
MEASURE = "[measure]\nmin_repeats = 1\nmax_repeats = 1\n"
PLACES = "TRACE_HIT, ray.start_pixel + ivec2(0, -1)"
# Name: what it returns, and what is said of it.
IMPOSSIBLE = {
    "off_the_image": ("TraceResult(TRACE_HIT, ivec2(-5, 99999), real(0.5), 1)", "hit pixel (-5, 99999) is off the image of 64x36"),
    "one_pixel_off": ("TraceResult(TRACE_HIT, ivec2(64, 10), real(0.5), 1)", "hit pixel (64, 10) is off the image of 64x36"),
    "one_bad_ray": ("ray.start_pixel == ivec2(32, 30) ? TraceResult(TRACE_HIT, ivec2(-1, 0), real(0.5), 1) : miss(ray, 1)",
                    "hit pixel (-1, 0) is off the image of 64x36"),
    "no_number": (f"TraceResult({PLACES}, sqrt(ray.origin.z - real(2)), 1)", "t of a hit is not a number"),
    "beyond_the_segment": (f"TraceResult({PLACES}, real(7), 1)", "t = 7"),
    "steps_below_zero": ("miss(ray, -1)", "4294967295 steps"),
    "more_than_declared": ("miss(ray, 9)", "9 steps, but the technique declares at most 8"),
    "unknown_status": ("TraceResult(200, ivec2(0), real(0), 1)", "status 200 is none of 1 … 6"),
    "status_below_zero": ("TraceResult(-1, ivec2(0), real(0), 1)", "status -1"),
    "not_answered": ("TraceResult(TRACE_NOT_TRACED, ivec2(0), real(0), 1)", "status 0"),
    "uninitialised": ("result", ""),  # another shader may find other words in what was never written
}


class Test(Case):
    def sweep_of(self, returned, code):
        """{technique: row}, dda among them."""
        for name, text in returned.items():
            self.write(f"mine/{name}/technique.toml", MANIFEST)
            self.write(f"mine/{name}/trace.glsl", f"TraceResult trace(Ray ray)\n{{\n    TraceResult result;\n    return {text};\n}}\n")
        spec = SWEEP + "".join(f"[techniques.{name}]\n" for name in returned) + MEASURE
        self.ssrlab("run", self.write("s.toml", spec), "-o", "out", "--techniques", "mine", code=code)
        return {row["technique"]: row for row in self.rows()}

    def test_rows_are_invalid_and_say_why(self):
        rows = self.sweep_of({name: text for name, (text, _) in IMPOSSIBLE.items()}, code=1)
        self.assertEqual(rows.pop("dda")["outcome"], "ok")
        self.assertEqual(set(rows), set(IMPOSSIBLE))
        for name, row in rows.items():
            self.assertEqual(row["outcome"], "invalid", row)
            self.assertRegex(row["message"], r"^\d+ of \d+ rays have an answer that cannot be; the first is the ray of pixel \(\d+, \d+\): ")
            self.assertIn(IMPOSSIBLE[name][1], row["message"])
            for column in ("recall_1px", "steps_mean", "trace_ms_median", "picture"):
                self.assertEqual(row[column], "", column)

    def test_each_command_refuses_it(self):
        text, says = IMPOSSIBLE["beyond_the_segment"]
        message = self.sweep_of({"odd": text}, code=1)["odd"]["message"]
        command = re.search(r"; ssrlab (trace .*)$", message).group(1).split()
        self.assertIn("thickness_m=0.25", command)
        self.refused(*command, code=1, says=["rays have an answer that cannot be", says])
        alone = ["builtin:mirror_floor_wall", "--techniques", "mine", "--size", "64x36", "-t", "odd", "-p", "thickness_m=0.25"]
        self.refused("render", *alone, "-o", "odd.png", code=1, says=["rays have an answer that cannot be", says])
        pixel = ",".join(re.search(r"the first is the ray of pixel \((\d+), (\d+)\)", message).groups())
        self.ssrlab("ray", *alone, "--pixel", pixel, says=["impossible: " + says])

    def test_a_miss_may_leave_its_pixel_undefined(self):
        rows = self.sweep_of({"odd": "TraceResult(ray.end_status, ivec2(-5, 99999), real(7), 1)"}, code=0)
        self.assert_complete(list(rows.values()), 2)


if __name__ == "__main__":
    main()
