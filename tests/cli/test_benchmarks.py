"""The benchmark program, the bench's sweeps and verdicts, and growth drawn from a sweep."""
import argparse
import json
import math
import os
import subprocess
from pathlib import Path

import OpenImageIO as oiio
from support import PROGRAM, SOURCE, Case, load_script, main, read

SCENE = "builtin:stairs"
PLOT = (os.path.join(SOURCE, "experiments", "plot"), "growth")


class Test(Case):
    def run_command(self, *command, code=0):
        self.last_command = " ".join(command)
        done = subprocess.run(command, capture_output=True, text=True, env=self.environment, check=False)
        self.assertEqual(done.returncode, code, f"repeat: {self.last_command}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def test_the_program_times_passes_and_judges(self):
        file = self.path("passes.json")
        self.run_command(os.path.join(os.path.dirname(PROGRAM), "benchmarks"), f"--scene={SCENE}",
                         "--benchmark_filter=/360p/(copy_depth|pyramid/occupancy|trace|scattered/list|screen_truth|scene_truth|judge)/iterations",
                         "--benchmark_repetitions=2", f"--benchmark_out={file}", "--benchmark_out_format=json")
        rows = {}
        report = json.loads(read(file))
        self.assertRegex(report["context"]["commit"], r"^[0-9a-f]{40}( with changes)?$|^not known$")
        for row in report["benchmarks"]:
            if row["run_type"] == "iteration":
                rows.setdefault(row["name"].split("/iterations:")[0].removeprefix(SCENE + "/360p/"), []).append(row)
        self.assertEqual(sorted(rows), ["copy_depth", "judge", "pyramid/occupancy", "scattered/list", "scene_truth", "screen_truth", "trace"])
        for name, repetitions in rows.items():
            self.assertEqual(len(repetitions), 2, name)
            self.assertNotIn("error_message", repetitions[0], name)
        judged = rows["judge"][0]
        self.assertGreater(judged["rays"], 1000)
        self.assertEqual((judged["differs_from_walk"], judged["missed"]), (0, 0))
        self.assertGreater(judged["visits_bound"], 1)
        self.assertGreater(rows["screen_truth"][0]["cells_per_s_a_core"], 0)
        self.assertGreater(rows["scene_truth"][0]["rays_per_s_a_core"], 0)

    def test_ratios_are_of_pairs_in_a_sweep(self):
        bench = load_script("experiments", "bench")
        bench.SIZES = {"1080p": ("161x91", list(bench.CONTENDERS))}
        options = argparse.Namespace(build=Path(PROGRAM).parent.parent, device="", quiet=True)
        sweep = bench.sweep(options, Path(self.folder), SCENE, "1080p", 6, truth=True)
        self.assertEqual(list(sweep.rows), list(bench.CONTENDERS))
        for contender, (technique, _) in bench.CONTENDERS.items():
            self.assertEqual(sweep.rows[contender]["technique"], technique)
            self.assertEqual(len(sweep.times_ms(contender)), 6, contender)
        self.assertEqual(len(sweep.times_ms("tracer", ["depth_pyramid"])), 6)
        self.assertEqual(sweep.number("tracer", "screen_recall_1px"), 1)
        self.assertLess(sweep.number("tracer", "fetches_mean"), 0.5 * sweep.number("walk", "fetches_mean"))
        self.assertGreater(sweep.number("nearest only", "steps_mean"), sweep.number("tracer", "steps_mean"))
        rounds = {tuple(samples.index) for samples in sweep.samples.values()}
        self.assertEqual(len(rounds), 1, "every contender in every round")
        ratio, low, high, pairs = bench.paired_ratio(sweep.times_ms("walk"), sweep.times_ms("tracer"))
        self.assertEqual(pairs, 6)
        self.assertGreater(low, 0)
        self.assertTrue(low <= ratio <= high, (low, ratio, high))

    def test_growth_is_drawn_from_a_sweep(self):
        file = self.write("growth.toml", f'scenes = ["{SCENE}"]\nsizes = ["40x20", "80x40", "160x80"]\n[passes]\npass_set = "shading"\n'
                          "[techniques.dda]\n[techniques.hiz]\n[measure]\nmin_repeats = 1\nbudget_s = 0\ntruth = false\npictures = false\n")
        self.ssrlab("run", file, "-o", self.path("out"))
        picture = self.path("growth.png")
        self.run_command(*PLOT, self.path("out"), "--scene", SCENE, "-o", picture)
        self.assertGreater(oiio.ImageBuf(picture).spec().width, 1000)
        self.assertIn("no row of interior", self.run_command(*PLOT, self.path("out"), "--scene", "interior", "-o", picture, code=1))
        self.assertIn("no results.csv", self.run_command(*PLOT, self.folder, "-o", picture, code=1))

    def test_wrong_usage(self):
        program = os.path.join(os.path.dirname(PROGRAM), "benchmarks")
        self.assertIn("--scene=", self.run_command(program, "--seen=interior", code=2))
        self.assertIn("nowhere", self.run_command(program, "--scene=nowhere", "--benchmark_filter=360p/copy_depth", code=2))
        self.assertIn("did you mean 'hiz'", self.run_command(program, "--technique=hix", code=2))

    def test_a_target_is_decided_by_the_whole_interval(self):
        bench = load_script("experiments", "bench")
        for low, high, target, at_most, verdict in ((11, 13, 10, False, "holds"), (11, 13, 12, False, "undecided"), (11, 13, 14, False, "FAILS"),
                                                    (0.4, 0.5, 0.5, True, "holds"), (0.4, 0.5, 0.45, True, "undecided"), (0.4, 0.5, 0.3, True, "FAILS")):
            self.assertEqual(bench.verdict(low, high, target, at_most), verdict, (low, high, target, at_most))
        for value, verdict in ((3, "holds"), (1.5, "is all"), (1.4, "FAILS")):
            self.assertEqual(bench.verdict(value, value, 2.3, False, most=1.5), verdict, value)

    def test_a_ratio_of_medians_has_an_interval(self):
        bench = load_script("experiments", "bench")
        ratio, low, high = bench.ratio_of_medians([10, 11, 12, 13, 14, 90], [2, 2, 2, 2, 2, 2])
        self.assertEqual(ratio, 6.25)
        self.assertLess(low, 6.25)
        self.assertGreater(high, 6.25)
        ratio, low, high = bench.ratio_of_medians([4, 4, 4], [2, 2, 2])
        self.assertEqual(ratio, 2)
        self.assertTrue(math.isnan(low) and math.isnan(high), "three repeats have no interval")


if __name__ == "__main__":
    main()
