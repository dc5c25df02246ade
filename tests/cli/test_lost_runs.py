"""Runs that hang or crash, and a sweep whose world changes under it: a failed row or an error, never a lost sweep."""
import os
import shutil
import signal
import time

from support import HANGS_S, Case, main

MANIFEST = """name    = "Endless"
summary = "Does not end."
[parameters]
end = { default = false, doc = "Whether it ends." }
"""
# A driver may cut a loop after 65,535 iterations: this body makes them long enough.
TRACE = """#define A x ^= x << 13; x ^= x >> 17; x ^= x << 5;
#define B A A A A A A A A
#define C B B B B B B B B
#define D C C C C C C C C
TraceResult trace(Ray ray)
{
    uint x = uint(ray.start_pixel.x) + 1u;
    for (uint i = 0u; !end && i < 4000000000u; ++i) { D D D D D D D D }
    return x == 7u ? out_of_steps(1) : miss(ray, 1);
}
"""
SWEEP = """scenes = ["builtin:mirror_floor_wall"]
sizes  = ["320x180"]
[techniques.endless]
end = [true, false]
[techniques.dda]
[techniques.linear]
steps = [8, 16, 32]
[measure]
min_repeats  = 2
max_repeats  = 2
time_limit_s = 15
"""
LONG = """scenes = ["builtin:mirror_floor_wall"]
sizes  = ["64x36"]
[techniques.linear]
steps = [8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31]
[measure]
min_repeats = 20
max_repeats = 40
"""


class Test(Case):
    def sweep_with_endless(self):
        self.write("mine/endless/technique.toml", MANIFEST)
        self.write("mine/endless/trace.glsl", TRACE)
        return self.write("s.toml", SWEEP)

    def assert_one_lost(self, why):
        rows = self.rows()
        self.assertEqual(len(rows), 6)
        self.assertEqual(len({row["run_id"] for row in rows}), 6)
        failed = [row for row in rows if row["outcome"] != "ok"]
        self.assertEqual([(row["technique"], row["end"], row["outcome"]) for row in failed], [("endless", "false", "failed")])
        self.assertIn(why, failed[0]["message"])

    def test_shader_that_does_not_end_is_a_failed_row(self):
        spec = self.sweep_with_endless()
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine", code=1, says=["6 written now, 1 of them failed"])
        self.assert_one_lost("did not end within 15 s (time_limit_s)")

    def test_time_limit_is_checked(self):
        for value in ("0", "1000", '"long"'):
            self.sweep_with_endless()
            spec = self.write("s.toml", SWEEP.replace("time_limit_s = 15", f"time_limit_s = {value}"))
            self.refused("run", spec, "-o", "out", "--techniques", "mine", code=2, says=["s.toml:11", "time_limit_s"])

    def test_every_signal_that_asks_to_stop(self):
        spec = self.write("s.toml", LONG.replace('"64x36"', '"64x36", "66x36", "68x36"'))
        for which in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            self.assertEqual(self.stop_in_the_middle(self.start("run", spec, "-o", "out"), which), 128 + which, which)
            self.assertLess(self.whole_rows(), 72)
            self.assertEqual([row["outcome"] for row in self.rows()], ["ok"] * self.whole_rows())

    def test_results_are_changed_in_the_middle(self):
        spec = self.write("s.toml", LONG)

        def replace():
            shutil.copy(self.path("out/results.csv"), self.path("copy.csv"))
            os.replace(self.path("copy.csv"), self.path("out/results.csv"))
        for name, change in (("results.csv", lambda: os.rename(self.path("out"), self.path("gone"))), ("results.csv", replace),
                             (".lock", lambda: os.remove(self.path("out/.lock")))):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            process = self.start("run", spec, "-o", "out")
            until = time.monotonic() + HANGS_S
            while self.whole_rows() == 0 and process.poll() is None and time.monotonic() < until:
                time.sleep(0.01)
            change()
            out, err = process.communicate(timeout=HANGS_S)
            self.assertEqual(process.returncode, 1, out + err)
            self.assertIn(f"{name}: was removed or replaced while it was in use", err)
            self.assertNotIn("written now", out)

    def test_closed_streams_print_into_no_file(self):
        spec = self.write("s.toml", LONG.replace("20\n", "1\n").replace("40\n", "1\n"))

        def close_streams():
            for fd in (0, 1, 2):
                os.close(fd)
        self.ssrlab("run", spec, "-o", "out", limits=close_streams)
        self.assert_complete(self.rows(), 24)
        self.assertTrue(self.text("out/.lock").isdigit())

    def test_unusable_caches_are_no_reason_to_stop(self):
        spec = self.write("s.toml", LONG.replace("20\n", "1\n").replace("40\n", "1\n"))
        file = self.write("file", "")
        self.ssrlab("run", spec, "-o", "out", says=["without a cache"], SSRLAB_CACHE=file + "/cache", XDG_CACHE_HOME=file)
        self.assert_complete(self.rows(), 24)


if __name__ == "__main__":
    main()
