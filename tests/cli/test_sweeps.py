"""run and plot: rows, resuming, interruptions, a full disk."""
import json
import math
import os
import re
import resource
import shutil
import signal
import statistics
import time

from support import HANGS_S, SOURCE, SWEEP, SWEEP_ROWS, Case, main

SEARCH = """
scenes = ["builtin:stairs"]
sizes  = ["160x90"]
[trace]
max_distance_m = 9
[targets]
screen_recall_1px = 0.9
[techniques.linear]
space = "screen"
steps = [2, 400]
[techniques.dda]
[measure]
min_repeats = 2
max_repeats = 2
pictures = false
"""
SMOKE = os.path.join(SOURCE, "experiments", "smoke.toml")


class Test(Case):
    def test_smoke_and_its_plots(self):
        text = self.ssrlab("run", SMOKE, "-o", "out")
        shares = re.search(r"(\d+) % went to frames that were timed, (\d+) % .* counted, (\d+) % to truths", text)
        timed, counted, truths = (int(share) for share in shares.groups())
        self.assertGreater(timed, 0)
        self.assertGreater(counted, 0)
        self.assertLessEqual(timed + counted + truths, 101)
        self.assertEqual(len(re.findall("14 of 14 runs", text)), 1, "the end is said once")
        rows = self.rows()
        self.assert_complete(rows, 14)
        for row in rows:
            self.assertGreater(float(row["trace_ms_median"]), 0)
            self.assertLessEqual(float(row["trace_ms_ci_low"]), float(row["trace_ms_ci_high"]))
            self.assertNotIn("nan", [value.lower() for value in row.values()])
            self.assertTrue(os.path.exists(self.path("out/" + row["picture"])))
            if row["technique"] in ("dda", "hiz", "hiz_packets"):
                self.assertEqual(float(row["screen_same_pixel"]), 1)
        self.ssrlab("plot", "out")
        plots = os.listdir(self.path("out/plots"))
        self.assertTrue(any(name.endswith(".png") for name in plots) and any(name.endswith(".svg") for name in plots))
        for name in ("report.html", "report.md", "summary.csv", "environment.json"):
            self.assertGreater(os.path.getsize(self.path("out/" + name)), 0)
        environment = json.loads(self.text("out/environment.json"))
        # Times of a software device are those of a processor.
        self.assertEqual("processor" in environment["identity"], environment["device_type"] == "Cpu")

    def test_frames_of_a_submit_change_nothing_but_times(self):
        answers = {}
        for frames in (1, 3):
            self.ssrlab("run", self.write("s.toml", SWEEP + f"frames_per_submit = {frames}\npictures = false\n"), "-o", f"out{frames}")
            rows = self.rows(f"out{frames}")
            self.assertEqual({row["frames_per_submit"] for row in rows}, {str(frames)})
            answers[frames] = {row["run_id"]: (row["hit_share"], row["recall_1px"], row["picture_rmse"]) for row in rows}
        self.assertEqual(answers[1], answers[3])
        self.assertTrue(all(answers[1].values()))

    def test_times_follow_from_the_samples(self):
        """Medians and intervals of results.csv, recomputed from samples.csv alone, to the last digit that it prints."""
        spec = self.write("s.toml", SWEEP.replace("min_repeats = 2\nmax_repeats = 4", "min_repeats = 7\nmax_repeats = 9") +
                          "truth = false\npictures = false\n")
        self.ssrlab("run", spec, "-o", "out")
        samples = self.samples()

        def text(value):
            return float(f"{value:.6g}")

        for row in self.rows():
            passes = {name: sorted(ms for _, ms in values) for name, values in samples[row["run_id"]].items()}
            for column, name in (("trace_ms", "trace"), ("frame_ms", "frame")):
                values = passes[name]
                count = len(values)
                rank = sum(1 for k in range(1, count) if 2 * sum(math.comb(count, i) for i in range(k)) <= 0.05 * 2 ** count)
                self.assertEqual(float(row[f"{column}_median"]), text(statistics.median(values)))
                self.assertEqual(float(row[f"{column}_ci_low"]), text(values[rank - 1]))
                self.assertEqual(float(row[f"{column}_ci_high"]), text(values[count - rank]))
            shown = [one for one in self.rows("out", "passes.csv") if one["run_id"] == row["run_id"]]
            self.assertEqual(len({one["pass"] for one in shown}), len(shown))
            self.assertTrue(all(one["reason"] for one in shown), shown)
            for one in shown:
                self.assertEqual(one["ms_median"] and float(one["ms_median"]), text(statistics.median(passes[one["pass"]])) if one["ran"] == "true" else "")
        self.assertEqual(self.text("out/samples.csv").splitlines()[0], "run_id,round,pass,ms,cpu_ms")
        self.assertEqual(json.loads(self.text("out/environment.json"))["samples"], "samples.csv")

    def test_runs_take_turns_in_rounds(self):
        """The runs of a frame share their rounds, from 0; each run is in a round at most once."""
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out")
        samples = self.samples()
        for row in self.rows():
            rounds = [number for number, _ in samples[row["run_id"]]["frame"]]
            self.assertEqual(rounds, list(range(int(row["repeats"]))))

    def test_what_a_torn_file_lost_is_measured_again(self):
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out")
        for name in ("out/results.csv", "out/samples.csv"):
            os.truncate(self.path(name), os.path.getsize(self.path(name)) - 40)
            self.ssrlab("run", spec, "-o", "out", "--resume", says=["1 written now"])
            self.assert_complete(self.rows(), SWEEP_ROWS)
        self.write("out/samples.csv", "run_id,ms\n")
        self.refused("run", spec, "-o", "out", "--resume", code=1, says=["samples.csv: damaged"])

    def test_search_reaches_its_target(self):
        """Between the two neighbours where a line crosses the target lie at most 10 %, every probe is a row like any other,
        and a sweep that was stopped goes on with the same search."""
        spec = self.write("s.toml", SEARCH)
        self.ssrlab("run", spec, "-o", "out")
        rows = self.rows()
        self.assert_complete(rows, len(rows))
        line = sorted((float(row["steps"]), float(row["screen_recall_1px"])) for row in rows if row["technique"] == "linear")
        self.assertGreater(len(line), 2)
        reached = next(i for i, (_, recall) in enumerate(line) if recall >= 0.9)
        self.assertLess(line[reached - 1][1], 0.9)
        self.assertLessEqual(line[reached][0] / line[reached - 1][0], 1.1)
        # All of a frame are timed in the same rounds.
        samples = self.samples()
        self.assertEqual({samples[row["run_id"]]["frame"][0][0] for row in rows}, {0})
        self.ssrlab("run", spec, "-o", "out", "--resume", says=["0 written now"])
        probes = [row["run_id"] for row in rows if row["technique"] == "linear"][-2:]
        with open(self.path("out/results.csv"), encoding="utf-8", newline="") as file:
            kept = [text for text in file if text[:text.index(",")] not in probes]
        with open(self.path("out/results.csv"), "w", encoding="utf-8", newline="") as file:
            file.writelines(kept)
        self.ssrlab("run", spec, "-o", "out", "--resume", says=["2 written now"])
        again = self.rows()
        self.assert_complete(again, len(rows))
        self.assertEqual({row["run_id"] for row in again}, {row["run_id"] for row in rows})

    def test_dry_run_lists_and_writes_nothing(self):
        self.ssrlab("run", SMOKE, "--dry-run", "-o", "out", says=["14 runs"])
        self.assertFalse(os.path.exists(self.path("out")))

    def test_dry_run_tells_runs_apart_by_their_settings(self):
        spec = self.write("s.toml", 'scenes = ["builtin:stairs"]\n[trace]\nbehind = ["hit", "pass"]\nsurface = ["box", "plane"]\n[techniques.dda]\n')
        listing = [line.split()[1:] for line in self.ssrlab("run", spec, "--dry-run").splitlines()[:4]]
        self.assertEqual({tuple(word for word in line if word.startswith(("behind=", "surface="))) for line in listing},
                         {(f"behind={behind}", f"surface={surface}") for behind in ("hit", "pass") for surface in ("box", "plane")})

    def test_only_repeats_one_run(self):
        spec = self.write("s.toml", SWEEP)
        listing = self.ssrlab("run", spec, "--dry-run").splitlines()
        run_id = listing[3].split()[0]
        self.ssrlab("run", spec, "-o", "out", "--only", run_id)
        self.assertEqual([row["run_id"] for row in self.rows()], [run_id])
        self.refused("run", spec, "-o", "other", "--only", "nothing", code=2, says=["nothing", "--dry-run"])

    def test_rows_do_not_depend_on_what_ran_before(self):
        """As after --resume: a run that comes first by itself names the same true picture."""
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out")
        row = self.rows()[2]
        self.ssrlab("run", spec, "-o", "alone", "--only", row["run_id"])
        alone, = self.rows("alone")
        for column in ("picture", "truth_picture", "steps_mean", "picture_rmse"):
            self.assertEqual(alone[column], row[column], column)
        self.assertTrue(os.path.exists(self.path("alone/" + row["truth_picture"])))

    def test_results_are_not_overwritten(self):
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out")
        before = self.bytes("out/results.csv")
        self.refused("run", spec, "-o", "out", code=2, says=["already there", "--resume"])
        self.ssrlab("run", spec, "-o", "out", "--resume", says=["0 written now"])
        self.assertEqual(self.bytes("out/results.csv"), before)

    def test_stopped_and_resumed(self):
        """At once: nothing is left running that writes on."""
        spec = self.write("s.toml", SWEEP)
        for which, code in ((signal.SIGKILL, -signal.SIGKILL), (signal.SIGINT, 130)):
            shutil.rmtree(self.path("out"), ignore_errors=True)
            self.assertEqual(self.stop_in_the_middle(self.start("run", spec, "-o", "out"), which), code)
            self.assertLess(self.whole_rows(), SWEEP_ROWS)
            self.ssrlab("run", spec, "-o", "out", "--resume")
            self.assert_complete(self.rows(), SWEEP_ROWS)

    def test_failed_runs_are_tried_again(self):
        self.write("broken.glb", "no JSON")
        spec = self.write("s.toml", SWEEP.replace("scenes = [", 'scenes = ["broken.glb", '))
        failing = SWEEP_ROWS // 3  # a fourth scene
        for written in (SWEEP_ROWS + failing, failing):
            resume = ["--resume"] if written == failing else []
            self.ssrlab("run", spec, "-o", "out", *resume, code=1, says=[f"{written} written now", f"{failing} of them failed"])
            rows = self.rows()
            self.assertEqual(len({row["run_id"] for row in rows}), len(rows))
            self.assertEqual([len([row for row in rows if row["outcome"] == o]) for o in ("ok", "failed")], [SWEEP_ROWS, failing])
            self.assertTrue(all("broken.glb" in row["message"] for row in rows if row["outcome"] == "failed"))

    def test_resume_refuses_another_model(self):
        """Not the recipe changes but a texture that the material file of a model names."""
        self.write("models/tile.obj", "mtllib tile.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl tile\nf 1 2 3\n")
        self.write("models/tile.mtl", "newmtl tile\nmap_Kd tile.png\n")
        self.write("models/tile.png", "no picture: left out with a warning")
        recipe = self.write("scene.toml", '[[part]]\nfile = "models/tile.obj"\n[[view]]\nname = "default"\n'
                            'position = [0, 0, 3]\ntarget = [0, 0, 0]\n')
        spec = self.write("s.toml", f'scenes = ["{recipe}"]\nsizes = ["16x9"]\n[techniques.dda]\n[measure]\nmin_repeats = 1\n'
                          'max_repeats = 1\n')
        self.ssrlab("run", spec, "-o", "out")
        self.assertEqual([row["outcome"] for row in self.rows()], ["no_rays"])
        self.ssrlab("run", spec, "-o", "out", "--resume", says=["0 written now"])
        self.write("models/tile.png", "another")
        self.refused("run", spec, "-o", "out", "--resume", code=2, says=["cannot be resumed", "scene.toml"])

    def test_empty_and_dull_scenes_are_rows(self):
        """Nothing on screen, nothing that reflects, nothing to be reflected, normals that are none: stated outcomes, no NaN."""
        dull = self.write("dull.toml", '[[part]]\nshape = "plane"\nsize_m = [9, 0, 9]\n[[view]]\nname = "default"\n'
                          'position = [0, 1, 4]\ntarget = [0, 0, 0]\n')
        alone = self.write("alone.toml", '[[part]]\nshape = "plane"\nsize_m = [9, 0, 9]\nmaterial = { metallic = 1 }\n[[view]]\n'
                           'name = "default"\nposition = [0, 1, 4]\ntarget = [0, 0, 0]\n')
        self.write("odd.obj", "".join(f"v {x} 0 {z}\n" for x, z in ((-4, 4), (4, 4), (4, -4), (-4, -4))) +
                   "vn nan nan nan\nvn 0 0 0\nvn 1e-40 0 0\nf 1//1 2//2 3//3\nf 1//2 3//2 4//2\n")
        odd = self.write("odd.toml", '[[part]]\nfile = "odd.obj"\nmaterial = { metallic = 1 }\n[[view]]\n'
                         'name = "default"\nposition = [0, 1, 4]\ntarget = [0, 0, 0]\n')
        spec = self.write("s.toml", SWEEP.replace('"builtin:stairs", "builtin:sphere_over_mirror", "builtin:corridor"',
                                                  f'"builtin:void", "{dull}", "{alone}", "{odd}"'))
        self.ssrlab("run", spec, "-o", "out")
        rows = self.rows()
        self.assertEqual(len(rows), 4 * SWEEP_ROWS // 3)
        for row in rows:
            reflects = row["scene"] in (alone, odd)
            self.assertEqual(row["outcome"], "ok" if reflects else "no_rays")
            self.assertEqual(row["rays"] != "0", reflects)
            self.assertEqual(row["truth_sky"], "1" if reflects else "")
            self.assertEqual(row["recall_1px"], "")  # of the visible points: there are none
            self.assertGreater(float(row["frame_ms_median"]), 0)
            self.assertFalse({"nan", "-nan", "inf", "-inf"} & {value.lower() for value in row.values()})
        self.ssrlab("plot", "out")

    def test_resume_refuses_other_threads_another_program_and_another_specification(self):
        spec = self.write("s.toml", SWEEP)
        self.ssrlab("run", spec, "-o", "out")
        environment = json.loads(self.text("out/environment.json"))
        if environment["device_type"] == "Cpu":
            self.refused("run", spec, "-o", "out", "--resume", code=2, says=["cannot be resumed", "threads"], LP_NUM_THREADS="1")
        environment["identity"]["program"] = "0123456789abcdef"
        self.write("out/environment.json", json.dumps(environment))
        self.refused("run", spec, "-o", "out", "--resume", code=2, says=["cannot be resumed", "program"])
        self.write("s.toml", SWEEP.replace("64]", "128]"))
        self.refused("run", spec, "-o", "out", "--resume", code=2, says=["cannot be resumed", "specification"])

    def test_second_writer_is_refused(self):
        # Long enough that the first one still writes after the two seconds for which a second one waits.
        spec = self.write("s.toml", SWEEP.replace("min_repeats = 2\nmax_repeats = 4", "min_repeats = 60\nmax_repeats = 60"))
        first = self.start("run", spec, "-o", "out")
        until = time.monotonic() + HANGS_S
        while self.whole_rows() == 0 and time.monotonic() < until:
            time.sleep(0.01)
        self.refused("run", spec, "-o", "out", "--resume", code=1, says=["another ssrlab is writing here"])
        self.assertIsNone(first.poll(), "the first one went on")
        first.send_signal(signal.SIGINT)
        first.communicate(timeout=HANGS_S)
        rows = self.rows()
        self.assertEqual((len(rows), {row["outcome"] for row in rows}), (self.whole_rows(), {"ok"}))

    def test_full_disk_leaves_whole_rows(self):
        spec = self.write("s.toml", SWEEP + "truth = false\npictures = false\n")

        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (6000, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))

        # Mesa's own cache would meet the limit first.
        self.refused("run", spec, "-o", "out", code=1, says=["rows before it are intact"], limits=small_files,
                     MESA_SHADER_CACHE_DISABLE="true")
        written = len(self.rows())
        self.assertGreater(written, 0)
        self.assertLess(written, SWEEP_ROWS)
        self.assertEqual(written, self.whole_rows())
        self.ssrlab("run", spec, "-o", "out", "--resume")
        self.assert_complete(self.rows(), SWEEP_ROWS)


if __name__ == "__main__":
    main()
