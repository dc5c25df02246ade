"""run --shard and merge: an experiment in parts, side by side, and one results folder of them."""
import json
import os
import shutil

from support import HANGS_S, SWEEP, SWEEP_ROWS, Case, main

MOVING = """
scenes = ["builtin:moving_boxes"]
views  = ["truck", "pan"]
sizes  = ["64x36"]
frames = 3
[techniques.hiz]
[measure]
min_repeats = 1
max_repeats = 1
budget_s    = 0
"""
# Of two runs of one frame, whatever the machine did.
SAME = ("run_id", "scene", "technique", "rays", "screen_same_pixel", "depth_fetches_mean", "picture_rmse", "picture")


class Test(Case):
    def run_shards(self, spec, count):
        """All at once, as processes of one machine or jobs of several."""
        running = [self.start("run", spec, "--shard", f"{i}/{count}", "-o", f"part_{i}") for i in range(1, count + 1)]
        for process in running:
            out, err = process.communicate(timeout=HANGS_S)
            self.assertEqual(process.returncode, 0, out + err + "\nrepeat: " + self.last_command)
        return [f"part_{i}" for i in range(1, count + 1)]

    def test_merged_parts_are_the_whole(self):
        spec  = self.write("s.toml", SWEEP)
        parts = self.run_shards(spec, 2)
        self.assertEqual([len(self.rows(part)) for part in parts], [2 * SWEEP_ROWS // 3, SWEEP_ROWS // 3])
        self.ssrlab("merge", *parts, "-o", "out", says=[f"{SWEEP_ROWS} rows of 2 folders"])
        self.ssrlab("run", spec, "-o", "whole")
        whole, merged = ({row["run_id"]: row for row in self.rows(folder)} for folder in ("whole", "out"))
        self.assertEqual(sorted(whole), sorted(merged))
        for run_id, row in whole.items():
            for column in SAME:
                self.assertEqual(row[column], merged[run_id][column], column)
            self.assertTrue(os.path.exists(self.path("out/" + merged[run_id]["picture"])))
        self.assert_complete(list(merged.values()), SWEEP_ROWS)
        passes = [[{name: one[name] for name in ("run_id", "pass", "ran", "reason")} for one in self.rows(folder, "passes.csv")] for folder in ("whole", "out")]
        self.assertEqual(*(sorted(one, key=lambda line: (line["run_id"], line["pass"])) for one in passes))
        self.assertEqual(json.loads(self.text("out/environment.json"))["merged_from"], parts)
        # As if one program had written it.
        self.ssrlab("run", spec, "-o", "out", "--resume", says=[f"{SWEEP_ROWS} rows, 0 written now"])
        self.ssrlab("plot", "out")

    def test_resuming_does_what_a_lost_part_lacks(self):
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "--shard", "3/3", "-o", "third")
        self.ssrlab("merge", "third", "-o", "out")
        self.ssrlab("run", spec, "-o", "out", "--resume", says=[f"{SWEEP_ROWS} rows, {2 * SWEEP_ROWS // 3} written now"])
        self.assert_complete(self.rows("out"), SWEEP_ROWS)

    def test_a_path_of_the_camera_stays_in_one_part(self):
        spec  = self.write("s.toml", MOVING)
        parts = self.run_shards(spec, 3)
        self.assertEqual([len(self.rows(part)) for part in parts], [3, 3, 0])
        self.assertEqual([{row["view"] for row in self.rows(part)} for part in parts], [{"truck"}, {"pan"}, set()])
        self.ssrlab("merge", *parts, "-o", "out", says=["6 rows of 3 folders"])
        self.assertEqual(len(self.text("out/sequence_summary.csv").splitlines()), 1 + 2)

    def test_what_does_not_belong_together_is_refused(self):
        spec  = self.write("s.toml", SWEEP)
        other = self.write("t.toml", SWEEP.replace("8, 16", "9, 16"))
        self.ssrlab("run", spec, "--shard", "3/3", "-o", "third")
        self.ssrlab("run", other, "--shard", "2/3", "-o", "other")
        self.ssrlab("merge", "third", "other", "-o", "out", code=2, says=["other: not of the same experiment as third", "specification"])
        self.ssrlab("merge", "third", "nowhere", "-o", "out", code=2, says=["nowhere/results.csv: no such file"])
        shutil.copytree(self.path("third"), self.path("twice"))
        self.ssrlab("merge", "third", "twice", "-o", "out", code=2, says=["twice/results.csv", "is in third, too"])
        self.assertFalse(os.path.exists(self.path("out")))
        self.ssrlab("merge", "third", "-o", "third", code=2, says=["third/results.csv: already there"])
        for wrong in ("0/3", "4/3", "1", "a/b", "1/3x", "-1/3"):
            self.ssrlab("run", spec, f"--shard={wrong}", "-o", "new", code=2, says=[f"--shard must be I/N with 1 <= I <= N, got '{wrong}'"])
        self.assertFalse(os.path.exists(self.path("new")))


if __name__ == "__main__":
    main()
