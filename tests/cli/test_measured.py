"""What is timed: a frame is its passes and its G-buffer, a sample is that of one frame, and what skipping saves is what a frame without it takes more."""
import statistics

from support import Case, main

SPEC = """
scenes = ["builtin:stairs"]
sizes  = ["96x54"]
[techniques.hiz]
[techniques.linear]
steps = [8, 64]
[measure]
min_repeats = 6
max_repeats = 6
truth       = false
pictures    = false
"""


class Test(Case):
    def raw(self, folder):
        """{run id: {round: {pass: (ms, cpu_ms)}}}; cpu_ms as text."""
        runs = {}
        for one in self.rows(folder, "samples.csv"):
            runs.setdefault(one["run_id"], {}).setdefault(one["round"], {})[one["pass"]] = (float(one["ms"]), one["cpu_ms"])
        return runs

    def run_spec(self, folder, more=""):
        self.ssrlab("run", self.write(f"{folder}.toml", SPEC + more), "-o", folder)
        return self.rows(folder), self.raw(folder)

    def test_a_frame_is_its_passes_and_its_gbuffer(self):
        rows, samples = self.run_spec("out")
        self.assertEqual(len(rows), 3)
        for row in rows:
            gbuffer_ms, rounds = float(row["gbuffer_ms_median"]), samples[row["run_id"]]
            self.assertGreater(gbuffer_ms, 0)
            self.assertEqual(len(rounds), 6)
            for passes in rounds.values():
                frame_ms, cpu_ms = passes.pop("frame")
                # The column has six digits.
                self.assertAlmostEqual(frame_ms, gbuffer_ms + sum(ms for ms, _ in passes.values()), delta=1e-5 * gbuffer_ms)
                self.assertGreaterEqual(float(cpu_ms), 0)
                self.assertEqual({cpu for _, cpu in passes.values()}, {""}, "a frame's alone")
            of_pass = {one["pass"]: float(one["ms_median"]) for one in self.rows("out", "passes.csv") if one["run_id"] == row["run_id"] and one["ran"] == "true"}
            self.assertEqual(set(of_pass), set(passes))
            self.assertEqual(len(of_pass), int(row["passes_ran"]))
            for name, ms in of_pass.items():
                self.assertAlmostEqual(ms, statistics.median(one[name][0] for one in rounds.values()), delta=1e-5 * ms)
            self.assertEqual(float(row["trace_ms_median"]), of_pass["trace"])
            # Every pass is in one of the parts.
            parts = ("rays_ms_median", "structures_ms_median", "trace_ms_median", "shade_ms_median")
            before = of_pass.get("layers", 0) + of_pass.get("solid_backs", 0)
            self.assertAlmostEqual(before + sum(float(row[part]) for part in parts), sum(of_pass.values()), delta=1e-4 * sum(of_pass.values()))

    def test_times_are_of_one_frame_of_a_submit(self):
        """Undivided, sixteen frames would take sixteen times as long as one; what else the machine does is far from a factor of four."""
        (one, samples), (many, of_many) = self.run_spec("one", "frames_per_submit = 1\nsaved_time = false\n"), self.run_spec("many", "frames_per_submit = 16\nsaved_time = false\n")
        self.assertEqual({row["frames_per_submit"] for row in many}, {"16"})
        for first, second in zip(one, many):
            self.assertLess(float(second["frame_ms_median"]), 4 * float(first["frame_ms_median"]))

            def cpu_ms(runs, run):
                return statistics.median(float(passes["frame"][1]) for passes in runs[run].values())
            self.assertLess(cpu_ms(of_many, second["run_id"]), 4 * cpu_ms(samples, first["run_id"]))
        self.assertEqual({row["saved_ms"] for row in one}, {""})
        self.assertGreater(sum(float(passes["frame"][1]) for rounds in of_many.values() for passes in rounds.values()), 0)

    def test_saved_time_is_that_of_the_frame_that_skips_nothing(self):
        """Nothing in builtin:matte reflects: but for its G-buffer the planned frame is all but empty, and the other one traces and blurs every pixel."""
        self.ssrlab("run", self.write("matte.toml", SPEC.replace("stairs", "matte")), "-o", "matte")
        for row in self.rows("matte"):
            planned_ms = float(row["frame_ms_median"]) - float(row["gbuffer_ms_median"])
            self.assertGreater(float(row["saved_ms"]), 4 * planned_ms, row)


if __name__ == "__main__":
    main()
