"""Answers beyond the frame from the command line: the table, the file in long form, the picture, and what is refused."""
import json
import os
import re

from support import Case, main

SPEC = """
scenes = ["builtin:corridor"]
sizes = ["96x54"]
[trace]
surface = "plane_infinite"
behind = "stop"
[techniques.hiz]
[sources]
lists = ["frame,wider:margin=0.5,world", "world"]
[measure]
min_repeats = 1
max_repeats = 1
warmup_s = 0
image_errors = false
double_twin = false
pictures = false
saved_time = false
"""
SOURCES = ("sources", "builtin:corridor", "--size", "96x54", "-p", "surface=plane_infinite", "-p", "behind=stop")


class Test(Case):
    def test_writes_a_row_for_each_source_of_each_list(self):
        self.ssrlab(*SOURCES, "--sources", "frame,wider:margin=0.5,world", "--sources", "world", "-o", "sources.csv", says=["frame", "wider", "world"])
        rows = self.rows("", "sources.csv")
        self.assertEqual([row["source"] for row in rows], ["frame", "wider:margin=0.5", "world", "world"])
        self.assertEqual([row["place"] for row in rows], ["0", "1", "2", "0"])
        frame, wider, world, alone = rows
        self.assertEqual(int(frame["handed"]), int(frame["all_rays"]))
        self.assertEqual(int(wider["handed"]), int(frame["handed"]) - int(frame["certain_points"]) - int(frame["certain_nothing"]))
        self.assertLessEqual(int(world["handed"]), int(wider["handed"]))
        self.assertEqual(alone["handed"], frame["handed"])
        self.assertLess(int(world["node_visits"]), int(alone["node_visits"]))
        self.assertGreater(float(alone["all_f1"]), 0.999)
        self.assertGreater(float(world["all_f1"]), float(frame["all_f1"]))
        for row in rows:
            classes = sum(int(row[name]) for name in row if name.startswith("handed_"))
            self.assertEqual(classes, int(row["meeting"]))
        # A second command appends.
        self.ssrlab(*SOURCES, "--sources", "frame", "-o", "sources.csv")
        self.assertEqual(len(self.rows("", "sources.csv")), 5)

    def test_appends_to_no_file_of_other_columns(self):
        self.write("other.csv", "scene,view\na,b\n")
        self.refused(*SOURCES, "--sources", "frame", "-o", "other.csv", code=2, says=["other.csv: its columns are not those"])

    def test_is_shown_with_its_parameters(self):
        self.assertIn("probe", self.ssrlab("list"))
        self.ssrlab("show", "views", says=["--sources", "place", "rays | scene"])
        self.assertEqual([one["name"] for one in json.loads(self.ssrlab("show", "cube", "--json"))["parameters"]], ["size_px"])

    def measured_by_auto(self, *command):
        """The lists that auto measured, the one that it took first: (text, ms, F1 in %)."""
        told = self.ssrlab(*command, says=["auto, budget"])
        line = next(line for line in told.splitlines() if "auto, budget" in line)
        lists = [(text, float(ms), float(f1)) for text, ms, f1 in re.findall(r"([a-z,]+) \(([\d.]+) ms, F1 ([\d.]+) %\)", line)]
        self.assertGreaterEqual(len(lists), 9)
        return lists, "which no list keeps" in line

    def test_auto_takes_the_best_list_within_the_budget(self):
        lists, over = self.measured_by_auto(*SOURCES, "--sources", "auto:budget_ms=0.001", "-o", "auto.csv")
        self.assertTrue(over)
        self.assertEqual(lists[0][1], min(ms for _, ms, _ in lists))
        rows = self.rows("", "auto.csv")
        self.assertEqual(",".join(row["source"] for row in rows), lists[0][0])
        self.assertGreater(float(rows[0]["choosing_ms"]), 0)
        lists, over = self.measured_by_auto("render", "builtin:corridor", "-t", "hiz", "--size", "96x54", "--sources", "auto:share=1000", "-o", "auto.png")
        self.assertFalse(over)
        self.assertGreaterEqual(lists[0][2] + 0.2, max(f1 for *_, f1 in lists)) # both are rounded
        self.assertTrue(os.path.exists(self.path("auto.png")))

    def test_a_sweep_writes_what_the_command_writes(self):
        """Every number but times, with results.csv in accord; lost lines are measured again, and merging keeps them."""
        spec = self.write("s.toml", SPEC)
        self.ssrlab("run", spec, "-o", "out")
        rows, asked = self.rows("out"), self.rows("out", "sources.csv")
        self.assert_complete(rows, 2)
        lists = [row["sources"] for row in rows]
        self.assertEqual(sorted(lists), ["frame,wider:margin=0.5,world", "world"])
        self.ssrlab(*SOURCES, *(word for one in lists for word in ("--sources", one)), "-o", "sources.csv")
        said = self.rows("", "sources.csv")
        self.assertEqual([row["run_id"] for row in asked], [row["run_id"] for row in rows for _ in row["sources"].split(",")])
        same = [name for name in asked[0] if name != "run_id" and not name.endswith("_ms")]
        self.assertGreater(len(same), 25)
        self.assertEqual([[row[name] for name in same] for row in asked], [[row[name] for name in same] for row in said])
        for row in rows:
            own = [one for one in asked if one["run_id"] == row["run_id"]]
            self.assertEqual([row[name] for name in ("all_recall", "all_precision", "all_f1")], [own[-1][name] for name in ("all_recall", "all_precision", "all_f1")])
            self.assertEqual(int(row["sources_asked"]), len(own))
            spent = sum(float(one[name]) for one in own for name in ("draw_ms", "trace_ms", "shade_ms"))
            self.assertAlmostEqual(float(row["sources_ms"]) / spent, 1, 4)
        self.ssrlab("plot", "out")
        self.assertTrue(os.path.exists(self.path("out/report.html")))
        self.ssrlab("merge", "out", "-o", "merged")
        self.assertEqual(self.rows("merged", "sources.csv"), asked)
        os.truncate(self.path("out/sources.csv"), os.path.getsize(self.path("out/sources.csv")) - 40)
        self.ssrlab("run", spec, "-o", "out", "--resume", says=["2 rows, 1 written now"])
        again = self.rows("out", "sources.csv")
        self.assertEqual(sorted((row["run_id"], row["place"], row["all_f1"]) for row in again), sorted((row["run_id"], row["place"], row["all_f1"]) for row in asked))

    def test_shows_which_source_answered(self):
        self.ssrlab("render", *SOURCES[1:], "-t", "hiz", "--show", "sources", "--sources", "frame,world", "-o", "shown.png")
        self.assertGreater(os.path.getsize(self.path("shown.png")), 500)

    def test_draws_with_the_answers(self):
        def flip(*options):
            said = self.ssrlab("render", *SOURCES[1:], "-t", "hiz", "--errors", "-o", "drawn.png", *options, says=["picture_flip", "picture_visible_rmse"])
            return float(said.split("picture_flip ")[1].split()[0])
        alone = flip()
        self.assertEqual(flip("--sources", "frame"), alone)
        self.assertLess(flip("--sources", "frame,world"), alone)
        self.refused("render", *SOURCES[1:], "-t", "hiz", "--errors", "--truth", "-o", "drawn.png", code=2, says=["--errors"])

    def test_refuses_what_is_no_list(self):
        self.refused(*SOURCES, "--sources", "frame,wurld", code=2, says=["--sources frame,wurld", "unknown source 'wurld'", "world"])
        self.refused(*SOURCES, "--sources", "layers:count=9", code=2, says=["count", "9"])
        self.refused(*SOURCES, "--hand-on", "some", code=2, says=["--hand-on", "lost or uncertain", "some"])
        self.refused(*SOURCES, "-o", "sources.txt", code=2, says=[".csv"])


if __name__ == "__main__":
    main()
