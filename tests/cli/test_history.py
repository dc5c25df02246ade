"""Frames of a sequence with their history."""
import os
import subprocess

from PIL import Image
from support import SOURCE, Case, main

SWEEP = """
scenes = ["builtin:moving_boxes"]
views  = ["truck"]
sizes  = ["96x54"]
frames = [0, 1, 2, 4]
[trace]
thickness_m = 0.2
[passes]
reprojection   = ["surface", "plane"]
history_weight = [0, 0.9]
[techniques.hiz]
[measure]
min_repeats = 2
max_repeats = 2
budget_s    = 0
double_twin = false
"""
# A slide past a box, a jump, and a slide back.
CUT = """
[[part]]
shape    = "plane"
size_m   = [9, 0, 9]
material = { metallic = 1, roughness = 0 }
[[part]]
shape    = "box"
position = [0, 0, -1]
material = { base_colour = [1, 0.2, 0.1] }
move_m   = [0.1, 0, 0]
[[view]]
name     = "a"
position = [-1, 1, 3]
target   = [-1, 0, -2]
[[view]]
name     = "b"
position = [1, 1, 3]
target   = [1, 0, -2]
[[view]]
name     = "c"
position = [0, 2, 3]
target   = [0, 0, -1]
[[view]]
name     = "d"
position = [1, 2, 3]
target   = [1, 0, -1]
[[path]]
name            = "shot"
views           = ["a", "b", "c", "d"]
cuts            = ["c"]
frames_per_view = 3
"""
# Not of times, and not of names of files that hold the run's id.
MEASURED = ("rays", "picture_rmse", "ghosting_rmse", "reprojection_error_median_px", "reprojection_error_p95_px",
            "reprojection_found_share", "history_share", "clamped_share")
ORBIT = ["builtin:moving_boxes", "-t", "hiz", "--view", "orbit", "--size", "96x54"]


class Test(Case):
    def test_frames_in_a_row_have_one_and_repeat_bit_by_bit(self):
        self.ssrlab("render", *ORBIT, "--frames", "4", "-o", "a.exr")
        self.ssrlab("render", *ORBIT, "--frames", "4", "-o", "b.exr")
        self.ssrlab("render", *ORBIT, "--frames", "4", "-p", "history_weight=0", "-o", "c.exr")
        self.ssrlab("render", *ORBIT, "--frame", "3", "-o", "alone.exr")
        for frame in range(4):
            self.assertEqual(self.bytes(f"a_{frame:04}.exr"), self.bytes(f"b_{frame:04}.exr"), frame)
        self.assertNotEqual(self.bytes("a_0003.exr"), self.bytes("c_0003.exr"))
        self.assertNotEqual(self.bytes("a_0003.exr"), self.bytes("alone.exr"))

    def measured(self, folder):
        """By run: what must be the same in every repetition, pictures included."""
        return {row["run_id"]: [row[name] for name in MEASURED] + [self.bytes(f"{folder}/{row['picture']}")] for row in self.rows(folder)}

    def test_a_sweep_carries_it_from_frame_to_frame(self):
        spec = self.write("sweep.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out")
        rows = self.rows()
        for row in rows:
            history = row["frame"] != "0" and row["history_weight"] != "0"
            for name in MEASURED[3:]:
                self.assertEqual(row[name] != "", history, (name, row["frame"]))
            self.assertEqual(row["ghosting_rmse"] != "", row["frame"] != "0")
        by = {(row["reprojection"], row["history_weight"], row["frame"]): row for row in rows}
        # A floor's motion is not that of what it reflects; the exact construction follows it.
        self.assertGreater(float(by["surface", "0.9", "4"]["reprojection_error_median_px"]), 0.2)
        self.assertLess(float(by["plane", "0.9", "4"]["reprojection_error_median_px"]), 0.05)
        self.assertGreater(float(by["plane", "0.9", "4"]["history_share"]), 0.3)
        self.assertEqual(by["surface", "0", "4"]["picture_rmse"], by["plane", "0", "4"]["picture_rmse"])
        self.assertNotEqual(by["surface", "0.9", "4"]["picture_rmse"], by["plane", "0.9", "4"]["picture_rmse"])
        # Again, alone from the middle, and after a kill in the middle: the same bits.
        whole = self.measured("out")
        self.ssrlab("run", spec, "-o", "again")
        self.assertEqual(self.measured("again"), whole)
        last = by["plane", "0.9", "4"]["run_id"]
        self.ssrlab("run", spec, "-o", "alone", "--only", last)
        self.assertEqual(self.measured("alone"), {last: whole[last]})
        self.keep_lines("out/results.csv", 10)
        self.ssrlab("run", spec, "-o", "out", "--resume")
        self.assertEqual(self.measured("out"), whole)
        summary = {(row["reprojection"], row["history_weight"]): row for row in self.rows(table="sequence_summary.csv")}
        self.assertEqual(len(summary), 4)
        self.assertLess(float(summary["plane", "0.9"]["reprojection_error_p95_px"]),
                        float(summary["surface", "0.9"]["reprojection_error_p95_px"]))

    def test_the_accumulated_picture_converges(self):
        """Jitter alone: the error against the mean over all phases falls from frame to frame."""
        self.ssrlab("run", self.write("still.toml", SWEEP.replace("builtin:moving_boxes", "builtin:stairs").replace(
            '["truck"]', '["default"]').replace("[0, 1, 2, 4]", "[0, 7]\njitter_phases = 8").replace(
                '["surface", "plane"]', '"plane"\nhistory_clamping = "off"')), "-o", "out")
        error = {(row["history_weight"], row["frame"]): float(row["converged_rmse"]) for row in self.rows()}
        self.assertEqual(error["0", "0"], error["0.9", "0"])
        self.assertLess(error["0.9", "7"], error["0", "7"])
        self.assertLess(error["0.9", "7"], error["0.9", "0"])

    def test_a_cut_leaks_nothing(self):
        scene = self.write("cut.toml", CUT)
        shot = [scene, "-t", "hiz", "--view", "shot", "--size", "96x54"]
        self.ssrlab("render", *shot, "--frames", "6", "-o", "a.exr")
        for frame, same in ((0, True), (3, False), (4, True), (5, False)):
            self.ssrlab("render", *shot, "--frame", str(frame), "-o", "alone.exr")
            self.assertEqual(self.bytes(f"a_{frame:04}.exr") == self.bytes("alone.exr"), same, frame)
        # A sweep's frames, too: without weight there is no history.
        spec = SWEEP.replace("builtin:moving_boxes", scene).replace("truck", "shot").replace("[0, 1, 2, 4]", "6")
        self.ssrlab("run", self.write("cut_sweep.toml", spec.replace('["surface", "plane"]', '"plane"')), "-o", "out")
        pictures = {(row["history_weight"], row["frame"]): self.bytes("out/" + row["picture"]) for row in self.rows()}
        for frame in range(6):
            same = pictures["0", str(frame)] == pictures["0.9", str(frame)]
            self.assertEqual(same, frame in (0, 4), frame)
        run = next(row["run_id"] for row in self.rows() if row["frame"] == "4" and row["history_weight"] == "0.9")
        why = {one["pass"]: one["reason"] for one in self.rows(table="passes.csv") if one["run_id"] == run}
        self.assertIn("a cut: nothing came before this frame", why["history"])

    def test_frames_become_an_animation(self):
        for strategy in ("surface", "plane"):
            self.ssrlab("render", *ORBIT, "--frames", "3", "-p", f"reprojection={strategy}", "-o", f"{strategy}.png")
        animate = [os.path.join(SOURCE, "experiments", "animate"), self.path("surface.png"), self.path("plane.png")]
        for ending in ("webp", "png"):
            subprocess.run([*animate, "-o", self.path(f"both.{ending}")], check=True, stdout=subprocess.DEVNULL)
            with Image.open(self.path(f"both.{ending}")) as shown:
                self.assertEqual((shown.n_frames, shown.width), (3, 2 * 96))
        nothing = subprocess.run([animate[0], self.path("none.png"), "-o", self.path("x.webp")], capture_output=True, text=True)
        self.assertNotEqual(nothing.returncode, 0)
        self.assertIn("none_0000.png", nothing.stderr)

    def test_the_plan_says_what_changed(self):
        moves = "moving camera, 2 of 4 objects move, no jitter"
        self.ssrlab("plan", *ORBIT, "--frame", "3", "--repeats", "1", says=["history              run", moves, "bit-identical"])
        still = self.ssrlab("plan", "builtin:stairs", "--frame", "3", "--repeats", "1", "--size", "96x54",
                            says=["still camera, 0 of 10 objects move, no jitter: the frame before once more", "bit-identical"])
        self.assertRegex(still, r"reprojection +skipped")
        self.ssrlab("plan", "builtin:stairs", "--repeats", "1", "--size", "96x54", says=["a single frame: no history"])


if __name__ == "__main__":
    main()
