"""Experiments of several frames: rows, the summary, and runs that begin in the middle of a sequence."""
import os

from support import Case, main

COUNTED = ("rays", "hit_share", "fetches_mean", "flip_share", "disocclusion_share", "surface_motion_error_median_px")
JITTER = """
scenes        = ["builtin:stairs"]
sizes         = ["96x54"]
frames        = [0, 1, 3, 4, 5]
jitter_phases = 5
[trace]
thickness_m    = 0.2
max_distance_m = 20
[techniques.dda]
[techniques.hiz]
[techniques.linear]
steps = [8, 256]
[measure]
min_repeats = 1
max_repeats = 1
budget_s    = 0
truth       = false
pictures    = false
"""
TRUCK = """
scenes = ["builtin:moving_boxes"]
views  = ["truck", "pan"]
sizes  = ["96x54"]
frames = 4
[techniques.hiz]
[measure]
min_repeats  = 1
max_repeats  = 1
budget_s     = 0
image_errors = false
double_twin  = false
pictures     = false
"""


class Test(Case):
    def summary(self):
        return self.rows(table="sequence_summary.csv")

    def counts(self, folder="out"):
        """What does not depend on time, by run."""
        return {row["run_id"]: [row[name] for name in COUNTED] for row in self.rows(folder)}

    def test_flips_under_jitter(self):
        self.ssrlab("run", self.write("jitter.toml", JITTER), "-o", "out")
        self.assertEqual([row["flip_share"] == "" for row in self.rows() if row["frame"] in "05"], [True] * 4 + [False] * 4)
        flips = {(row["technique"], row["steps"]): float(row["flip_rate"]) for row in self.summary()}
        self.assertEqual(len(flips), 4)
        # Both exact techniques flip on the same rays; a march with few steps on more of them.
        self.assertEqual(flips["dda", ""], flips["hiz", ""])
        self.assertGreater(flips["linear", "8"], flips["linear", "256"])
        self.assertGreater(flips["linear", "256"], 0)
        for row in self.summary():
            self.assertEqual(row["frames"], "5")
            self.assertGreater(float(row["temporal_rms"]), 0)

    def test_a_frame_in_the_middle_is_the_same(self):
        spec = self.write("jitter.toml", JITTER)
        self.ssrlab("run", spec, "-o", "out")
        whole, summary = self.counts(), self.summary()
        middle = next(row["run_id"] for row in self.rows() if row["frame"] == "4" and row["technique"] == "hiz")
        self.ssrlab("run", spec, "-o", "alone", "--only", middle)
        self.assertEqual(self.counts("alone"), {middle: whole[middle]})
        self.assertFalse(os.path.exists(self.path("alone/sequence_summary.csv")), "one frame is no sequence")
        # As if it had been killed after its seventh row.
        self.keep_lines("out/results.csv", 8)
        os.remove(self.path("out/sequence_summary.csv"))
        self.ssrlab("run", spec, "-o", "out", "--resume")
        self.assertEqual(self.counts(), whole)
        for again, before in zip(self.summary(), summary):
            for name in ("sequence_id", "flip_rate", "temporal_rms", "frames"):
                self.assertEqual(again[name], before[name])

    def test_a_surfaces_motion_is_not_that_of_its_reflection(self):
        self.ssrlab("run", self.write("truck.toml", TRUCK), "-o", "out")
        by_view = {row["view"]: row for row in self.summary()}
        # Still boxes and the wall are reflected by a floor that is nearer than they are: it seems to move faster. A camera that only
        # turns moves both alike, but for the boxes that move by themselves.
        self.assertGreater(float(by_view["truck"]["surface_motion_error_median_px"]), 0.2)
        self.assertLess(float(by_view["pan"]["surface_motion_error_median_px"]), 0.01)
        for row in self.rows():
            self.assertEqual(row["surface_motion_error_median_px"] == "", row["frame"] == "0", "nothing comes before frame 0")
            self.assertEqual(row["flip_share"], "", "hits move with the camera: that is no flip")


if __name__ == "__main__":
    main()
