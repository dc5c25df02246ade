"""A stranger's hour: every file and every command of a page, in their order, as they stand there."""
import glob
import os
import re
import subprocess

from support import HANGS_S, PROGRAM, SOURCE, Case, main, read


class Test(Case):
    def follow(self, page):
        """Writes the page's files and runs its commands in one folder; returns what they printed."""
        blocks = re.findall(r"^```(\w+)\n(.*?)^```", read("docs", page), re.S | re.M)
        self.assertGreater(len(blocks), 1)
        environment = dict(self.environment, PATH=os.path.dirname(PROGRAM) + ":/usr/bin:/bin", SSRLAB_SOURCE=SOURCE, MPLBACKEND="Agg")
        printed = ""
        for language, text in blocks:
            if language == "sh":
                self.last_command = text
                done = subprocess.run(["/bin/bash", "-euo", "pipefail", "-c", text], cwd=self.folder, env=environment, capture_output=True,
                                      text=True, timeout=HANGS_S)
                self.assertEqual(done.returncode, 0, f"{page}: {text}{done.stdout}{done.stderr}")
                for stem, ending in re.findall(r"-o (\S+)(\.\w+)", text):
                    first = stem + ("_0000" if "--frames" in text else "") + ending  # a sequence is numbered
                    self.assertTrue(os.path.exists(self.path(first)), f"{page}: {text}")
                printed += done.stdout
                continue
            first, rest = text.split("\n", 1)
            name, appended = re.fullmatch(r"(?:#|//) (\S+\.\w+)(, appended)?", first).groups()
            before = ""
            if appended:
                before = self.text(name)
            self.write(name, before + rest)
        return printed

    def rows_of(self, name, count):
        rows = self.rows(f"results/{name}")
        self.assertEqual([row["outcome"] for row in rows], ["ok"] * count)
        return rows

    def test_first_verdict(self):
        printed = self.follow("tutorials/first_verdict.md")
        self.assertIn("## Verdict", printed)
        rows = self.rows_of("first", 6)
        hits = {row["technique"]: row["hit_share"] for row in rows}
        self.assertEqual(hits["hiz"], hits["dda"])
        self.assertEqual(hits["hiz_packets"], hits["dda"])
        linear = [float(row["screen_recall_1px"]) for row in rows if row["technique"] == "linear"]
        self.assertLess(max(linear), 0.99)

    def test_own_scene(self):
        self.follow("tutorials/own_scene.md")
        rows = self.rows_of("statue_sweep", 4)
        self.assertEqual({row["surface"] for row in rows}, {"box", "plane_solid"})

    def test_own_frame(self):
        self.follow("tutorials/own_frame.md")
        for row in self.rows_of("frame", 5):
            self.assertTrue(row["no_scene_truth"])
            self.assertTrue(row["screen_same_pixel"])
            self.assertTrue(row["picture_rmse"])

    def test_own_technique(self):
        self.follow("tutorials/own_technique.md")
        rows = self.rows_of("mine", 5)
        self.assertEqual({row["stride_px"] for row in rows if row["technique"] == "strides"}, {"1", "2", "4", "8"})

    def test_the_tutorial_s_technique_is_the_one_that_new_technique_writes(self):
        trace, = re.findall(r"// mine/strides/trace.glsl\n(.*?)```", read("docs/tutorials/own_technique.md"), re.S)
        self.ssrlab("new-technique", "mine/strides")
        self.assertEqual(self.text("mine/strides/trace.glsl").split("\n", 1)[1], trace)

    def test_write_a_reprojection(self):
        self.follow("how-to/write_a_reprojection.md")
        self.assertEqual(len(glob.glob(self.path("orbit_*.png"))), 8)
        self.rows_of("check", 12)
        errors = {row["reprojection"]: (row["reprojection_error_median_px"], row["reprojection_error_p95_px"])
                  for row in self.rows("results/check", "sequence_summary.csv")}
        self.assertEqual(set(errors), {"shifted", "surface", "plane"})
        self.assertEqual(errors["shifted"], errors["surface"])
        self.assertNotEqual(errors["shifted"], errors["plane"])
        self.assertIn("reprojection_error", self.text("results/check/report.html"))

    def test_paper_figure(self):
        self.follow("tutorials/paper_figure.md")
        self.assertEqual(self.bytes("figure.pdf")[:4], b"%PDF")


if __name__ == "__main__":
    main()
