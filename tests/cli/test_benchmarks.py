"""The benchmark program, the bench's verdicts, and growth drawn from the measurements."""
import importlib.machinery
import importlib.util
import json
import os
import subprocess

import OpenImageIO as oiio
from support import PROGRAM, SOURCE, Case, main

SCENE = "builtin:stairs"
PLOT = os.path.join(SOURCE, "experiments", "plot_benchmarks.py")


def load_bench():
    loader = importlib.machinery.SourceFileLoader("bench", os.path.join(SOURCE, "experiments", "bench"))
    bench = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", loader))
    loader.exec_module(bench)
    return bench


class Test(Case):
    def run_command(self, *command, code=0):
        self.last_command = " ".join(command)
        done = subprocess.run(command, capture_output=True, text=True, env=self.environment, check=False)
        self.assertEqual(done.returncode, code, f"repeat: {self.last_command}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def measure(self, names):
        """{name: [row of each repetition]}, and the file."""
        file = self.path("timed.json")
        self.run_command(os.path.join(os.path.dirname(PROGRAM), "benchmarks"), f"--scene={SCENE}", f"--benchmark_filter=/({names})/iterations",
                         "--benchmark_repetitions=2", f"--benchmark_out={file}", "--benchmark_out_format=json")
        rows = {}
        with open(file, encoding="utf-8") as text:
            for row in json.load(text)["benchmarks"]:
                if row["run_type"] == "iteration":
                    rows.setdefault(row["name"].split("/iterations:")[0].removeprefix(SCENE + "/"), []).append(row)
        return rows, file

    def test_measures_judges_and_draws(self):
        rows, file = self.measure("360p/(copy_depth|pyramid/occupancy|trace/hiz|trace/dda|screen_truth|scene_truth|judge)|720p/trace/hiz")
        for name, repetitions in rows.items():
            self.assertEqual(len(repetitions), 2, name)
            self.assertNotIn("error_message", repetitions[0], name)
        judged, hiz, dda = rows["360p/judge"][0], rows["360p/trace/hiz"][0], rows["360p/trace/dda"][0]
        self.assertGreater(judged["rays"], 1000)
        self.assertEqual((judged["differs_from_walk"], judged["missed"]), (0, 0))
        self.assertEqual(hiz["recall"], 1)
        self.assertLess(hiz["fetches_per_ray"], 0.5 * dda["fetches_per_ray"])
        self.assertGreater(rows["360p/screen_truth"][0]["cells_per_s_a_core"], 0)
        self.assertGreater(rows["360p/scene_truth"][0]["rays_per_s_a_core"], 0)

        picture = self.path("growth.png")
        self.run_command(PLOT, file, "--scene", SCENE, "-o", picture)
        self.assertGreater(oiio.ImageBuf(picture).spec().width, 1000)
        self.assertIn("no trace of interior", self.run_command(PLOT, file, "--scene", "interior", "-o", picture, code=1))

        lines = self.run_command(PLOT, file, "--reference", file).splitlines()[1:]
        self.assertEqual(sorted(line.split()[0] for line in lines),
                         [f"{SCENE}/360p/{name}" for name in ("pyramid/occupancy", "scene_truth", "screen_truth", "trace/hiz")])
        for line in lines:
            self.assertEqual((line.split()[3], line.split()[6]), ("1.00", "1.00"), line)

    def test_wrong_usage(self):
        program = os.path.join(os.path.dirname(PROGRAM), "benchmarks")
        self.assertIn("--scene=", self.run_command(program, "--seen=interior", code=2))
        self.assertIn("nowhere", self.run_command(program, "--scene=nowhere", "--benchmark_filter=360p/copy_depth", code=2))

    def test_a_target_is_decided_by_the_whole_interval(self):
        bench = load_bench()
        for low, high, target, at_most, verdict in ((11, 13, 10, False, "holds"), (11, 13, 12, False, "undecided"), (11, 13, 14, False, "FAILS"),
                                                    (0.4, 0.5, 0.5, True, "holds"), (0.4, 0.5, 0.45, True, "undecided"), (0.4, 0.5, 0.3, True, "FAILS")):
            self.assertEqual(bench.verdict(low, high, target, at_most), verdict, (low, high, target, at_most))
        for value, verdict in ((3, "holds"), (1.5, "is all"), (1.4, "FAILS")):
            self.assertEqual(bench.verdict(value, value, 2.3, False, most=1.5), verdict, value)

    def test_a_ratio_is_one_of_medians(self):
        bench = load_bench()
        self.assertEqual(bench.ratio_with_interval([[4, 4, 4]], [[1, 1, 1], [1, 1, 1]]), (2, 2, 2))
        ratio, low, high = bench.ratio_with_interval([[10, 11, 12, 13, 90]], [[2, 2, 2, 2, 2]])
        self.assertEqual(ratio, 6)
        self.assertLess(low, 6)
        self.assertGreater(high, 6)


if __name__ == "__main__":
    main()
