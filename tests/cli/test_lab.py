"""The tracing lab alone: an example program that links nothing above it."""
import os
import re
import subprocess
import unittest

from support import HANGS_S, PROGRAM, Case, read

EXAMPLE = os.path.join(os.path.dirname(PROGRAM), "trace_depth")


class Test(Case):
    def traced(self, technique, code=0):
        done = subprocess.run([EXAMPLE, self.path("seen.exr"), technique], capture_output=True, text=True, timeout=HANGS_S,
                              env=self.environment)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_an_example_of_forty_lines_traces_the_depth_of_an_exr(self):
        self.ssrlab("gbuffer", "builtin:pole_field", "--size", "97x61", "-o", self.path("seen.exr"))
        walk = self.traced("dda")
        lines = walk.splitlines()
        self.assertGreater(len(lines), 5)
        for line in lines:
            self.assertRegex(line, r"^x [0-9.]+ (hit|left_screen) at \d+,\d+$")
        self.assertRegex(walk, r"x 48.5 hit at 48,")  # a pole
        # Where nothing is hit the pixel is not defined.
        hits = [re.sub(r"(left_screen) .*", r"\1", line) for line in lines]
        self.assertEqual([re.sub(r"(left_screen) .*", r"\1", line) for line in self.traced("hiz").splitlines()], hits)
        self.assertIn("did you mean 'hiz'", self.traced("hi", code=1))
        self.assertLessEqual(len(read("tests/examples/trace_depth.cpp").splitlines()), 40)


if __name__ == "__main__":
    unittest.main()
